//! The normal equations of one dimension, and their solution with κ J added.

use crate::mlpg::MlpgProblem;

/// R and r over the free frames, the fixed ones moved to the right-hand side.
pub(super) struct Banded {
    stride: usize,
    /// R at lags 0, stride and 2 stride.
    diagonal: Vec<f64>,
    near: Vec<f64>,
    far: Vec<f64>,
    rhs: Vec<f64>,
    /// All frames, fixed ones included.
    n_frames: usize,
    fixed: Vec<f64>,
    /// The free frames of the last solution.
    pub(super) trajectory: Vec<f64>,
    /// (R + κ I)⁻¹ applied to r and to ones.
    both: Vec<[f64; 2]>,
    scratch: Vec<[f64; 1]>,
    factors: Vec<Factor>,
}

/// Inverse of a pivot of L D Lᵀ, and the entries of L below it at lags stride and 2 stride.
type Factor = [f64; 3];

/// Solution for one value of κ.
#[derive(Clone, Copy)]
pub(super) struct Solution {
    /// Mean over all frames.
    pub(super) mean: f64,
    /// Variance over all frames.
    pub(super) variance: f64,
    /// Its derivative with respect to κ.
    pub(super) variance_slope: f64,
}

impl Banded {
    /// Dimension `d` of a problem that has been checked.
    pub(super) fn new(problem: &MlpgProblem<'_, f64>, d: usize, trajectory: &[f64]) -> Self {
        let n_frames = problem.state_of_frame.len();
        let (n_fixed, dim) = (problem.n_fixed, problem.dim);
        let stride = problem.windows.stride();
        let mut lags = [
            vec![0.0; n_frames],
            vec![0.0; n_frames],
            vec![0.0; n_frames],
        ];
        let mut rhs = vec![0.0; n_frames];
        let windows = problem
            .windows
            .coefficients()
            .into_iter()
            .zip(problem.windows.reach());
        for (window, (coefficients, reach)) in windows.enumerate() {
            for s in reach..n_frames.saturating_sub(reach) {
                let at = (problem.state_of_frame[s] as usize * 3 + window) * dim + d;
                let (precision, mean) = (problem.precisions[at], problem.means[at]);
                let offsets = (2 - reach)..=(2 + reach);
                for i in offsets.clone().filter(|i| coefficients[*i] != 0.0) {
                    let t = s + i - 2;
                    rhs[t] += coefficients[i] * precision * mean;
                    for lag in 0..3 {
                        let j = i + lag * stride;
                        if offsets.contains(&j) {
                            lags[lag][t] += coefficients[i] * precision * coefficients[j];
                        }
                    }
                }
            }
        }
        let fixed: Vec<f64> = (0..n_fixed).map(|t| trajectory[t * dim + d]).collect();
        for (t, value) in fixed.iter().enumerate() {
            for lag in 1..3 {
                if let Some(rhs) = rhs.get_mut(t + lag * stride) {
                    *rhs -= lags[lag][t] * value;
                }
            }
        }
        let [diagonal, near, far] = lags.map(|mut lag| lag.split_off(n_fixed));
        let n_free = n_frames - n_fixed;
        Self {
            stride,
            diagonal,
            near,
            far,
            rhs: rhs.split_off(n_fixed),
            n_frames,
            fixed,
            trajectory: vec![0.0; n_free],
            both: vec![[0.0; 2]; n_free],
            scratch: vec![[0.0]; n_free],
            factors: vec![[0.0; 3]; n_free],
        }
    }

    /// Below this κ a diagonal entry of R + κ J is negative.
    pub(super) fn lowest_strength(&self) -> f64 {
        let n_frames = self.n_frames as f64;
        -self.diagonal.iter().copied().fold(f64::INFINITY, f64::min) * n_frames / (n_frames - 1.0)
    }

    /// Solves (R + κ J) c = r. `None` where R + κ J is not positive definite.
    ///
    /// J c = c - c̄, so (R + κ I) c = r + κ c̄ 1: two banded solutions x = (..)⁻¹ r and u = (..)⁻¹ 1
    /// give c = x + κ c̄ u, and its mean gives c̄.
    pub(super) fn solve(&mut self, strength: f64) -> Option<Solution> {
        match self.stride {
            1 => self.solve_strided::<1>(strength),
            _ => self.solve_strided::<2>(strength),
        }
    }

    /// As [`solve`](Self::solve), with the windows' stride.
    fn solve_strided<const STRIDE: usize>(&mut self, strength: f64) -> Option<Solution> {
        let n_negative = self.factorise::<STRIDE>(strength)?;
        let n_frames = self.n_frames as f64;
        for (both, rhs) in self.both.iter_mut().zip(&self.rhs) {
            *both = [*rhs, 1.0];
        }
        substitute::<STRIDE, 2>(&self.factors, &mut self.both);
        let [total, ones] = self
            .both
            .iter()
            .fold([0.0; 2], |[total, ones], [x, u]| [total + x, ones + u]);
        let denominator = n_frames - strength * ones;
        // det(R + κ J) = det(R + κ I) denominator / T, and for κ < 0 the rank-one term can lift
        // one negative eigenvalue, no more.
        let is_positive_definite =
            (n_negative == 0 && denominator > 0.0) || (n_negative == 1 && denominator < 0.0);
        if !is_positive_definite {
            return None;
        }
        let mean = (self.fixed.iter().sum::<f64>() + total) / denominator;
        for (c, [x, u]) in self.trajectory.iter_mut().zip(&self.both) {
            *c = x + strength * mean * u;
        }
        let square = |c: &f64| (c - mean) * (c - mean);
        let variance = (self.fixed.iter().map(square).sum::<f64>()
            + self.trajectory.iter().map(square).sum::<f64>())
            / n_frames;
        // dc/dκ = -(R + κ J)⁻¹ J c, by the same two steps.
        for (z, c) in self.scratch.iter_mut().zip(&self.trajectory) {
            *z = [c - mean];
        }
        substitute::<STRIDE, 1>(&self.factors, &mut self.scratch);
        let change = strength * self.scratch.iter().map(|[z]| z).sum::<f64>() / denominator;
        let product: f64 = self
            .scratch
            .iter()
            .zip(&self.both)
            .zip(&self.trajectory)
            .map(|(([z], [_, u]), c)| (z + change * u) * (c - mean))
            .sum();
        let variance_slope = -2.0 * product / n_frames;
        variance_slope.is_finite().then_some(Solution {
            mean,
            variance,
            variance_slope,
        })
    }

    /// L D Lᵀ of R + κ I; the number of negative pivots, `None` when one vanishes.
    fn factorise<const STRIDE: usize>(&mut self, strength: f64) -> Option<usize> {
        let n_frames = self.diagonal.len();
        let mut n_negative = 0;
        // To subtract, by chain, from the next pivot, from the one after, and from the next entry at lag stride.
        let mut carries = [[0.0; 3]; STRIDE];
        for first in (0..n_frames).step_by(STRIDE) {
            for (chain, carry) in carries.iter_mut().enumerate() {
                let t = first + chain;
                if t == n_frames {
                    break;
                }
                let pivot = self.diagonal[t] + strength - carry[0];
                let inverse = pivot.recip();
                if !inverse.is_finite() || !pivot.is_finite() {
                    return None;
                }
                n_negative += usize::from(pivot < 0.0);
                let (near, far) = (self.near[t] - carry[2], self.far[t]);
                let [near_of_l, far_of_l] = [near * inverse, far * inverse];
                self.factors[t] = [inverse, near_of_l, far_of_l];
                *carry = [near * near_of_l + carry[1], far * far_of_l, near * far_of_l];
            }
        }
        Some(n_negative)
    }
}

/// Solves L D Lᵀ x = b in place, for N right-hand sides side by side.
fn substitute<const STRIDE: usize, const N: usize>(factors: &[Factor], x: &mut [[f64; N]]) {
    let firsts = (0..x.len()).step_by(STRIDE);
    // To subtract, by chain, from the next entry and from the one after.
    let mut carries = [[[0.0; N]; 2]; STRIDE];
    for first in firsts.clone() {
        for (chain, [next, later]) in carries.iter_mut().enumerate() {
            let (Some(x), Some([_, near, far])) =
                (x.get_mut(first + chain), factors.get(first + chain))
            else {
                break;
            };
            for n in 0..N {
                x[n] -= next[n];
                next[n] = near * x[n] + later[n];
                later[n] = far * x[n];
            }
        }
    }
    // The entries of the next frame and of the one after.
    let mut afters = [[[0.0; N]; 2]; STRIDE];
    for first in firsts.rev() {
        for (chain, [next, later]) in afters.iter_mut().enumerate() {
            let (Some(x), Some([inverse, near, far])) =
                (x.get_mut(first + chain), factors.get(first + chain))
            else {
                break;
            };
            for n in 0..N {
                x[n] = x[n] * inverse - near * next[n] - far * later[n];
            }
            *later = *next;
            *next = *x;
        }
    }
}
