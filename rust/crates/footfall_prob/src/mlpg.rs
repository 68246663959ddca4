//! Maximum-likelihood parameter generation: the smoothest likely trajectory through a state sequence.
//!
//! Given the state of every frame, the trajectory that maximises P(W C | q, λ) (paper, equation 11)
//! solves the normal equations Wᵀ P W c = Wᵀ P m per dimension (Tokuda et al., ICASSP 2000,
//! doi:10.1109/ICASSP.2000.861820). With both window sets the matrix has entries at two lags besides
//! the diagonal, so L D Lᵀ costs a few operations per frame. Dimensions are independent: a cache line
//! of them is solved side by side in vector registers. What frames of one state share is computed
//! once per run of frames, and the ends of the sequence are rows of their own, so the frame loop has no branches.

mod kernel;
mod lanes;

pub use lanes::Real;
use lanes::sealed::Block as _;

use crate::error::{ProbError, check_len};
use crate::windows::Windows;

/// Input of [`mlpg`]. S states, D dimensions, T frames; all matrices row-major.
#[derive(Debug, Clone, Copy)]
pub struct MlpgProblem<'a, R> {
    /// The dynamic features that the states describe.
    pub windows: Windows,
    /// Number of static dimensions D.
    pub dim: usize,
    /// S x 3D: per state the means of statics, Δ and Δ².
    pub means: &'a [R],
    /// S x 3D: the precisions (reciprocal variances) that belong to `means`. Those of the statics
    /// must be above zero.
    pub precisions: &'a [R],
    /// T state indices. Dynamic windows that cross an end of the sequence are left out there.
    pub state_of_frame: &'a [u32],
    /// The first `n_fixed` frames of the trajectory are given and the rest is optimal given them.
    /// To continue a long trajectory, four given frames are enough: nothing further back is coupled.
    pub n_fixed: usize,
    /// A quadratic pull per dimension, or none. With a negative strength it pushes away: this is
    /// how global variance is restored ([`global_variance`](crate::global_variance)).
    pub pull: Option<Pull<'a, R>>,
}

/// Adds `strength[d]` to the diagonal of the normal matrix and `strength[d] * towards[d]` to the
/// right-hand side.
#[derive(Debug, Clone, Copy)]
pub struct Pull<'a, R> {
    /// D values, in units of precision.
    pub strength: &'a [R],
    /// D values, in units of the features.
    pub towards: &'a [R],
}

/// Buffers of [`mlpg`], owned by the caller: nothing is allocated while they suffice.
#[derive(Debug)]
pub struct MlpgWorkspace<R: Real> {
    layout: Layout,
    rows: Vec<[R::Block; 6]>,
    factors: Vec<[R::Block; 3]>,
}

impl<R: Real> Default for MlpgWorkspace<R> {
    fn default() -> Self {
        Self {
            layout: Layout::default(),
            rows: Vec::new(),
            factors: Vec::new(),
        }
    }
}

impl<R: Real> MlpgWorkspace<R> {
    /// Empty buffers, which grow on first use.
    pub fn new() -> Self {
        Self::default()
    }

    /// Buffers that suffice for up to `n_frames` frames.
    pub fn with_capacity(n_frames: usize) -> Self {
        let mut workspace = Self::new();
        workspace.layout.row_of_frame.reserve(n_frames + 4);
        // At worst every frame is a run of its own; one more row stands for frames outside.
        workspace.layout.rows.reserve(n_frames + 1);
        workspace.rows.reserve(n_frames + 1);
        workspace.factors.reserve(n_frames);
        workspace
    }
}

/// Data that all blocks of dimensions share.
#[doc(hidden)]
#[derive(Debug, Default)]
pub struct Layout {
    windows: Windows,
    dim: usize,
    n_frames: usize,
    n_fixed: usize,
    /// Index into `rows` of frames -2 ..= T + 1.
    row_of_frame: Vec<u32>,
    rows: Vec<Row>,
}

/// A run of frames with one state and the same windows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Row {
    state: Option<u32>,
    keeps_delta: bool,
    keeps_delta_delta: bool,
}

/// One block of dimensions.
#[doc(hidden)]
#[derive(Debug)]
pub struct DimBlock<'a, R: Real> {
    means: &'a [R],
    precisions: &'a [R],
    pull_strength: R::Block,
    pull_towards: R::Block,
    first_dim: usize,
    rows: &'a mut [[R::Block; 6]],
    factors: &'a mut [[R::Block; 3]],
    trajectory: &'a mut [R],
    lowest_pivot: R::Block,
}

impl Layout {
    fn prepare<R>(&mut self, problem: &MlpgProblem<'_, R>) {
        let n_frames = problem.state_of_frame.len();
        self.windows = problem.windows;
        self.dim = problem.dim;
        self.n_frames = n_frames;
        self.n_fixed = problem.n_fixed;
        self.rows.clear();
        self.rows.push(Row::NONE);
        self.row_of_frame.clear();
        self.row_of_frame.extend([0, 0]);
        let [_, delta, delta_delta] = problem.windows.reach();
        let mut last = Row::NONE;
        for (t, state) in problem.state_of_frame.iter().enumerate() {
            let fits = |reach: usize| t >= reach && t + reach < n_frames;
            let row = Row {
                state: Some(*state),
                keeps_delta: fits(delta),
                keeps_delta_delta: fits(delta_delta),
            };
            if row != last {
                self.rows.push(row);
                last = row;
            }
            self.row_of_frame.push(self.rows.len() as u32 - 1);
        }
        self.row_of_frame.extend([0, 0]);
    }
}

fn check<R: Real>(problem: &MlpgProblem<'_, R>, trajectory: &[R]) -> Result<(), ProbError> {
    let dim = problem.dim;
    if dim == 0 {
        return Err(ProbError::Empty { what: "dimensions" });
    }
    let n_states = problem.means.len() / (3 * dim);
    check_len("means", problem.means.len(), n_states * 3 * dim)?;
    check_len("precisions", problem.precisions.len(), problem.means.len())?;
    check_len(
        "trajectory",
        trajectory.len(),
        problem.state_of_frame.len() * dim,
    )?;
    if problem.n_fixed > problem.state_of_frame.len() {
        return Err(ProbError::IndexOutOfRange {
            what: "n_fixed",
            index: 0,
            value: problem.n_fixed,
            len: problem.state_of_frame.len(),
        });
    }
    if let Some(pull) = problem.pull {
        check_len("pull strength", pull.strength.len(), dim)?;
        check_len("pull towards", pull.towards.len(), dim)?;
    }
    let outside = problem
        .state_of_frame
        .iter()
        .position(|state| *state as usize >= n_states);
    outside.map_or(Ok(()), |index| {
        Err(ProbError::IndexOutOfRange {
            what: "state_of_frame",
            index,
            value: problem.state_of_frame[index] as usize,
            len: n_states,
        })
    })
}

/// Solves for the trajectory (T x D): reads its first `n_fixed` frames, writes the others.
///
/// ```
/// use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, mlpg};
/// use footfall_prob::windows::Windows;
///
/// // Two states, one dimension: a step from 0 to 1 that must not move fast.
/// let problem = MlpgProblem {
///     windows: Windows::Compact,
///     dim: 1,
///     means: &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
///     precisions: &[1.0, 50.0, 50.0, 1.0, 50.0, 50.0],
///     state_of_frame: &[0, 0, 0, 0, 0, 1, 1, 1, 1, 1],
///     n_fixed: 0,
///     pull: None,
/// };
/// let mut trajectory = [0.0; 10];
/// mlpg(&problem, &mut MlpgWorkspace::new(), &mut trajectory)?;
/// assert!(trajectory.windows(2).all(|pair| pair[0] < pair[1] && pair[1] - pair[0] < 0.2));
/// # Ok::<(), footfall_prob::ProbError>(())
/// ```
///
/// # Errors
/// [`ProbError`] when shapes or indices do not fit, a mean or precision of a visited state is not
/// finite, or the trajectory is not determined (static precision plus pull too low). After the last
/// two the trajectory's contents are unspecified.
pub fn mlpg<R: Real>(
    problem: &MlpgProblem<'_, R>,
    workspace: &mut MlpgWorkspace<R>,
    trajectory: &mut [R],
) -> Result<(), ProbError> {
    mlpg_part(problem, problem.dim, workspace, trajectory)
}

/// As [`mlpg`] for the first `wanted` dimensions at least, which cost less than all; others may stay as they are.
///
/// # Errors
/// As [`mlpg`].
pub fn mlpg_part<R: Real>(
    problem: &MlpgProblem<'_, R>,
    wanted: usize,
    workspace: &mut MlpgWorkspace<R>,
    trajectory: &mut [R],
) -> Result<(), ProbError> {
    mlpg_with(R::solve, problem, wanted, workspace, trajectory)
}

/// [`mlpg_part`] with a given kernel.
fn mlpg_with<R: Real>(
    solve: fn(&Layout, &mut DimBlock<'_, R>),
    problem: &MlpgProblem<'_, R>,
    wanted: usize,
    workspace: &mut MlpgWorkspace<R>,
    trajectory: &mut [R],
) -> Result<(), ProbError> {
    check(problem, trajectory)?;
    let dim = problem.dim;
    let n_frames = problem.state_of_frame.len();
    if problem.n_fixed == n_frames {
        return Ok(());
    }
    let zero = R::Block::splat(R::default());
    workspace.layout.prepare(problem);
    // Every block overwrites what it reads, so old contents may stay.
    workspace
        .rows
        .resize(workspace.layout.rows.len(), [zero; 6]);
    workspace.factors.resize(n_frames, [zero; 3]);
    let lanes = R::Block::LANES;
    for index in 0..wanted.min(dim).div_ceil(lanes) {
        // The last block starts early rather than run half empty, so some dimensions are solved twice.
        let first_dim = (index * lanes).min(dim.saturating_sub(lanes));
        let n_dims = lanes.min(dim - first_dim);
        let pull = |values: Option<&[R]>| values.map_or(zero, |v| R::Block::load(&v[first_dim..]));
        let mut block = DimBlock {
            means: problem.means,
            precisions: problem.precisions,
            pull_strength: pull(problem.pull.map(|p| p.strength)),
            pull_towards: pull(problem.pull.map(|p| p.towards)),
            first_dim,
            rows: &mut workspace.rows,
            factors: &mut workspace.factors,
            trajectory: &mut *trajectory,
            lowest_pivot: R::Block::splat(R::narrow(f64::INFINITY)),
        };
        solve(&workspace.layout, &mut block);
        let lowest = block.lowest_pivot.lanes()[..n_dims]
            .iter()
            .position(|p| p.widen() <= 0.0);
        if let Some(lane) = lowest {
            return Err(ProbError::NotPositiveDefinite {
                dim: first_dim + lane,
            });
        }
    }
    // Whatever is not finite anywhere spreads back to the first frame of its chain.
    let first = &trajectory[problem.n_fixed * dim..];
    let first = &first[..first.len().min(problem.windows.stride() * dim)];
    match first.iter().position(|v| !v.widen().is_finite()) {
        None => Ok(()),
        Some(index) => Err(ProbError::NotFinite {
            what: "trajectory",
            index,
            value: first[index].widen(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload::MlpgWorkload;

    #[test]
    fn fallback_agrees_with_the_dispatched_kernel() {
        let workload = MlpgWorkload::new(60, 10, 11);
        let (precisions, state_of_frame) = (workload.precisions(), workload.state_of_frame());
        for windows in [Windows::Paper, Windows::Compact] {
            let problem = MlpgProblem {
                windows,
                dim: workload.dim,
                means: &workload.means,
                precisions: &precisions,
                state_of_frame: &state_of_frame,
                n_fixed: 3,
                pull: None,
            };
            let mut workspace = MlpgWorkspace::with_capacity(60);
            let capacities = |w: &MlpgWorkspace<f64>| (w.rows.capacity(), w.factors.capacity());
            let before = capacities(&workspace);
            let mut expected = vec![0.1; 60 * workload.dim];
            let mut plain = expected.clone();
            mlpg(&problem, &mut workspace, &mut expected).unwrap();
            mlpg_with(
                kernel::solve::<f64, false>,
                &problem,
                problem.dim,
                &mut workspace,
                &mut plain,
            )
            .unwrap();
            for (a, b) in plain.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-11, "{a} {b}");
            }
            assert_eq!(capacities(&workspace), before, "the workspace grew");
        }
    }
}
