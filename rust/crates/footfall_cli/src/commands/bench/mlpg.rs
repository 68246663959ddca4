//! Trajectory generation: ours, jbonsai's, and a dense solve as referee.

use anyhow::{Context as _, Result};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Real, mlpg};
use footfall_prob::windows::Windows;
use footfall_prob::workload::MlpgWorkload;
use jbonsai::mlpg_adjust::MlpgAdjust;
use jbonsai::model::voice::window::Window;
use jbonsai::model::{MeanVari, ModelStream, StreamParameter};
use nalgebra::{DMatrix, DVector};
use std::hint::black_box;

/// Dimensions that the dense solve checks: each costs a 1000 x 1000 factorisation.
const DENSE_DIMENSIONS: usize = 3;

/// One precision of the kernel on the reference data, with its buffers.
struct Kernel<R: Real> {
    windows: Windows,
    dim: usize,
    means: Vec<R>,
    precisions: Vec<R>,
    state_of_frame: Vec<u32>,
    workspace: MlpgWorkspace<R>,
    trajectory: Vec<R>,
}

impl<R: Real> Kernel<R> {
    fn new(windows: Windows, workload: &MlpgWorkload) -> Self {
        let narrow = |values: &[f64]| values.iter().map(|value| R::narrow(*value)).collect();
        Self {
            windows,
            dim: workload.dim,
            means: narrow(&workload.means),
            precisions: narrow(&workload.precisions()),
            state_of_frame: workload.state_of_frame(),
            workspace: MlpgWorkspace::new(),
            trajectory: vec![R::default(); workload.n_frames() * workload.dim],
        }
    }

    fn solve(&mut self) -> Result<()> {
        let problem = MlpgProblem {
            windows: self.windows,
            dim: self.dim,
            means: &self.means,
            precisions: &self.precisions,
            state_of_frame: &self.state_of_frame,
            n_fixed: 0,
            pull: None,
        };
        mlpg(
            black_box(&problem),
            &mut self.workspace,
            black_box(&mut self.trajectory),
        )
        .context("the reference trajectory cannot be solved")
    }
}

/// Our kernel in every variant.
pub(super) struct Ours {
    workload: MlpgWorkload,
    double: Kernel<f64>,
    single: Kernel<f32>,
    compact: Kernel<f64>,
}

impl Ours {
    pub(super) fn new() -> Result<Self> {
        let workload = MlpgWorkload::reference();
        let mut ours = Self {
            double: Kernel::new(Windows::Paper, &workload),
            single: Kernel::new(Windows::Paper, &workload),
            compact: Kernel::new(Windows::Compact, &workload),
            workload,
        };
        ours.solve()?;
        Ok(ours)
    }

    pub(super) fn frames(&self) -> usize {
        self.workload.n_frames()
    }

    pub(super) fn dimensions(&self) -> usize {
        self.workload.dim
    }

    pub(super) fn solve(&mut self) -> Result<()> {
        self.double.solve()
    }

    pub(super) fn solve_single(&mut self) -> Result<()> {
        self.single.solve()
    }

    pub(super) fn solve_compact(&mut self) -> Result<()> {
        self.compact.solve()
    }

    /// Largest difference of any value from a trajectory of rows.
    pub(super) fn max_difference(&self, rows: &[Vec<f64>]) -> f64 {
        self.double
            .trajectory
            .iter()
            .zip(rows.iter().flatten())
            .map(|(ours, theirs)| (ours - theirs).abs())
            .fold(0.0, f64::max)
    }

    /// The same from `(Wᵀ P W) c = Wᵀ P m` with the matrices written out.
    pub(super) fn max_difference_from_dense(&self) -> Result<f64> {
        let (frames, dim) = (self.frames(), self.dimensions());
        let coefficients = Windows::Paper.coefficients();
        let mut worst = 0.0_f64;
        for d in 0..DENSE_DIMENSIONS {
            let mut normal = DMatrix::<f64>::zeros(frames, frames);
            let mut right = DVector::<f64>::zeros(frames);
            for (frame, state) in self.double.state_of_frame.iter().enumerate() {
                for (window, taps) in coefficients.iter().enumerate() {
                    let at = *state as usize * 3 * dim + window * dim + d;
                    let (mean, precision) = (self.double.means[at], self.double.precisions[at]);
                    let Some(taps) = taps_inside(taps, frame, frames) else {
                        continue;
                    };
                    for &(row, left) in &taps {
                        right[row] += left * precision * mean;
                        for &(column, tap) in &taps {
                            normal[(row, column)] += left * precision * tap;
                        }
                    }
                }
            }
            let solved: DVector<f64> = normal
                .cholesky()
                .context("the dense normal matrix is not positive definite")?
                .solve(&right);
            for frame in 0..frames {
                worst = worst.max((solved[frame] - self.double.trajectory[frame * dim + d]).abs());
            }
        }
        Ok(worst)
    }
}

/// Frames and coefficients of a window's taps; `None` where it would reach over an end.
fn taps_inside(taps: &[f64; 5], frame: usize, frames: usize) -> Option<Vec<(usize, f64)>> {
    taps.iter()
        .enumerate()
        .filter(|(_, tap)| **tap != 0.0)
        .map(|(offset, tap)| {
            let at = (frame + offset).checked_sub(2)?;
            (at < frames).then_some((at, *tap))
        })
        .collect()
}

/// jbonsai on the same data.
pub(super) struct Peer {
    workload: MlpgWorkload,
    windows: jbonsai::model::Windows,
}

impl Peer {
    pub(super) fn new() -> Self {
        let windows = [
            vec![1.0],
            vec![-0.5, 0.0, 0.5],
            vec![0.25, 0.0, -0.5, 0.0, 0.25],
        ];
        Self {
            workload: MlpgWorkload::reference(),
            windows: jbonsai::model::Windows::new(windows.map(Window::new).to_vec()),
        }
    }

    fn adjust(&self) -> MlpgAdjust<'_> {
        let width = 3 * self.workload.dim;
        let states = self
            .workload
            .means
            .chunks(width)
            .zip(self.workload.variances.chunks(width))
            .map(|(means, variances)| {
                let pairs = means.iter().zip(variances);
                (
                    pairs
                        .map(|(mean, variance)| MeanVari(*mean, *variance))
                        .collect(),
                    1.0,
                )
            })
            .collect();
        MlpgAdjust::new(
            0.0,
            0.5,
            ModelStream {
                vector_length: self.workload.dim,
                stream: StreamParameter::new(states),
                gv: None,
                windows: &self.windows,
            },
        )
    }

    /// One row a frame.
    pub(super) fn trajectory(&self) -> Vec<Vec<f64>> {
        self.adjust().create(&self.workload.durations)
    }

    /// Times only what generates: the stream is made outside.
    pub(super) fn solver(&self) -> impl Fn() -> Result<()> {
        let adjust = self.adjust();
        move || {
            black_box(adjust.create(black_box(&self.workload.durations)));
            Ok(())
        }
    }
}
