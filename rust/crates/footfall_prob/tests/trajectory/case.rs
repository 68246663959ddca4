//! Problems and their solutions by dense linear algebra.

use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, mlpg};
use footfall_prob::windows::Windows;
use footfall_prob::workload::MlpgWorkload;
use nalgebra::{DMatrix, DVector};

pub(crate) const BOTH: [Windows; 2] = [Windows::Paper, Windows::Compact];

/// A workload with the arrays that a problem borrows.
pub(crate) struct Case {
    pub(crate) workload: MlpgWorkload,
    pub(crate) precisions: Vec<f64>,
    pub(crate) state_of_frame: Vec<u32>,
}

impl Case {
    pub(crate) fn new(n_frames: usize, n_states: usize, dim: usize) -> Self {
        let workload = MlpgWorkload::new(n_frames, n_states, dim);
        Self {
            precisions: workload.precisions(),
            state_of_frame: workload.state_of_frame(),
            workload,
        }
    }

    pub(crate) fn problem(&self, windows: Windows) -> MlpgProblem<'_, f64> {
        MlpgProblem {
            windows,
            dim: self.workload.dim,
            means: &self.workload.means,
            precisions: &self.precisions,
            state_of_frame: &self.state_of_frame,
            n_fixed: 0,
            pull: None,
        }
    }

    pub(crate) fn solve(&self, windows: Windows) -> Vec<f64> {
        solve(&self.problem(windows))
    }
}

pub(crate) fn solve(problem: &MlpgProblem<'_, f64>) -> Vec<f64> {
    let mut trajectory = vec![0.0; problem.state_of_frame.len() * problem.dim];
    mlpg(problem, &mut MlpgWorkspace::new(), &mut trajectory).expect("solvable");
    trajectory
}

/// R = Wᵀ P W and r = Wᵀ P m of one dimension, from W itself.
pub(crate) fn normal_equations(
    problem: &MlpgProblem<'_, f64>,
    d: usize,
) -> (DMatrix<f64>, DVector<f64>) {
    let n_frames = problem.state_of_frame.len();
    let mut w = DMatrix::zeros(3 * n_frames, n_frames);
    let mut precision = DVector::zeros(3 * n_frames);
    let mut mean = DVector::zeros(3 * n_frames);
    let (half, quarter) = (0.5, 0.25);
    let offsets: [&[(isize, f64)]; 3] = match problem.windows {
        Windows::Paper => [
            &[(0, 1.0)],
            &[(-1, -half), (1, half)],
            &[(-2, quarter), (0, -half), (2, quarter)],
        ],
        Windows::Compact => [
            &[(0, 1.0)],
            &[(-1, -half), (1, half)],
            &[(-1, 1.0), (0, -2.0), (1, 1.0)],
        ],
    };
    for t in 0..n_frames {
        for (window, offsets) in offsets.iter().enumerate() {
            let inside = |offset: isize| t.checked_add_signed(offset).is_some_and(|s| s < n_frames);
            if offsets.iter().all(|(offset, _)| inside(*offset)) {
                let at = (problem.state_of_frame[t] as usize * 3 + window) * problem.dim + d;
                let row = 3 * t + window;
                precision[row] = problem.precisions[at];
                mean[row] = problem.means[at];
                for (offset, coefficient) in *offsets {
                    w[(row, t.wrapping_add_signed(*offset))] = *coefficient;
                }
            }
        }
    }
    let weighted = DMatrix::from_fn(3 * n_frames, n_frames, |i, j| precision[i] * w[(i, j)]);
    (w.transpose() * &weighted, weighted.transpose() * mean)
}

/// The conditional optimum given the first `n_fixed` frames, by dense Cholesky.
pub(crate) fn dense(problem: &MlpgProblem<'_, f64>, d: usize, fixed: &[f64]) -> Vec<f64> {
    let (mut r, mut b) = normal_equations(problem, d);
    if let Some(pull) = problem.pull {
        for t in 0..b.len() {
            r[(t, t)] += pull.strength[d];
            b[t] += pull.strength[d] * pull.towards[d];
        }
    }
    let (n, f) = (b.len(), fixed.len());
    let given = DVector::from_column_slice(fixed);
    let rhs = b.rows(f, n - f) - r.view((f, 0), (n - f, f)) * &given;
    let free = r
        .view((f, f), (n - f, n - f))
        .into_owned()
        .cholesky()
        .expect("positive definite")
        .solve(&rhs);
    fixed.iter().chain(free.iter()).copied().collect()
}

pub(crate) fn largest_difference(found: &[f64], dim: usize, d: usize, expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len() * dim);
    let pairs = found.chunks(dim).zip(expected);
    // NaN must not slip through a maximum.
    pairs
        .map(|(frame, e)| (frame[d] - e).abs())
        .fold(0.0, |a, b| if b <= a { a } else { b })
}
