//! Global variance: a trajectory that is likely *and* varies as much as real motion does.
//!
//! Maximum-likelihood trajectories are too smooth. Toda and Tokuda (2007; paper, equations 12 to 15)
//! add the likelihood of the variance over time. Per dimension, with T frames, the trajectory c
//! maximises
//!
//! > ω ln N(W c; m, P⁻¹) + ln N(v(c); μ, σ²), where v(c) = (1/T) Σ (c_t - c̄)²
//!
//! and c̄ is the mean over time. (The paper divides by 54 in equations 12 and 13, its number of
//! dimensions; T is meant.) HTS uses ω = 1/(3T), see [`hts_weight`]; a smaller ω trusts μ more.
//!
//! HTS rescales the trajectory and takes five damped diagonal steps, which barely move. Here the
//! optimum is found exactly. With R = Wᵀ P W, r = Wᵀ P m and the centring matrix J = I - 11ᵀ/T, the
//! gradient vanishes where
//!
//! > (R + κ J) c = r and κ = 2 (v(c) - μ) / (ω T σ²).
//!
//! For a given κ this is a banded system plus rank one (Sherman-Morrison), so the one unknown is the
//! scalar κ. As in trust-region problems, the global maximum is the one solution at which R + κ J is
//! positive definite. There κ - 2 (v(κ) - μ) / (ω T σ²) is increasing and concave in κ, so a
//! bracketed Newton iteration finds it.

mod banded;

use banded::{Banded, Solution};

use crate::error::{ProbError, check_finite, check_len, check_positive};
use crate::mlpg::{MlpgProblem, MlpgWorkspace, Pull, mlpg};

/// Target for the variance over time, and its weight.
#[derive(Debug, Clone, Copy)]
pub struct GlobalVarianceTarget<'a> {
    /// D expected variances over time, μ.
    pub mean: &'a [f64],
    /// D variances of that variance between sequences, σ².
    pub variance: &'a [f64],
    /// ω, the weight of the trajectory's own log likelihood.
    pub trajectory_weight: f64,
}

/// ω = 1/(3T), the weight that HTS gives the trajectory's likelihood.
pub fn hts_weight(n_frames: usize) -> f64 {
    (3.0 * n_frames as f64).recip()
}

/// Optimum per dimension. As a [`Pull`], `strength` and `towards`
/// reproduce the optimum with plain [`mlpg`], and carried to other chunks of the same motion they
/// restore its variance at no cost.
#[derive(Debug, Clone, PartialEq)]
pub struct GlobalVarianceFit {
    /// κ, in units of precision: negative where the variance had to grow.
    pub strength: Vec<f64>,
    /// c̄, the mean over time.
    pub towards: Vec<f64>,
    /// v(c), the variance over time that was reached.
    pub variance: Vec<f64>,
}

impl GlobalVarianceFit {
    /// For [`MlpgProblem::pull`](crate::mlpg::MlpgProblem::pull).
    pub fn pull(&self) -> Pull<'_, f64> {
        Pull {
            strength: &self.strength,
            towards: &self.towards,
        }
    }

    /// Keeps every strength above minus `share` of the smallest static precision of its dimension
    /// (`precisions` is S x 3D). With a share below one, [`mlpg`] cannot fail on any sequence of these states.
    ///
    /// # Errors
    /// [`ProbError::Shape`] when `precisions` is not whole states of 3D values.
    pub fn limit(&mut self, precisions: &[f64], share: f64) -> Result<(), ProbError> {
        let dim = self.strength.len();
        let n_states = precisions.len().checked_div(3 * dim).unwrap_or(0);
        check_len("precisions", precisions.len(), n_states * 3 * dim)?;
        for (d, strength) in self.strength.iter_mut().enumerate() {
            let lowest = (0..n_states)
                .map(|s| precisions[s * 3 * dim + d])
                .fold(f64::INFINITY, f64::min);
            *strength = strength.max(-share * lowest);
        }
        Ok(())
    }
}

/// Mean and variance over time per dimension (D values each) of a T x D trajectory: the statistics
/// behind a [`GlobalVarianceTarget`].
pub fn temporal_moments(trajectory: &[f64], dim: usize) -> (Vec<f64>, Vec<f64>) {
    let mut stats = crate::gaussian::GaussianStats::new(dim);
    for frame in trajectory.chunks_exact(dim.max(1)) {
        stats.add(frame, 1.0);
    }
    (stats.mean().to_vec(), stats.variance())
}

/// Solves for the trajectory (T x D) that maximises the objective above: reads the first
/// `problem.n_fixed` frames, which count in the mean and variance over time, and writes the others.
/// `problem.pull` is ignored.
///
/// If no trajectory reaches the target (a single frame, or means that do not vary at all), the
/// result is the best that the states allow.
///
/// # Errors
/// [`ProbError`] as [`mlpg`], or when the target does not fit or is not positive.
pub fn global_variance(
    problem: &MlpgProblem<'_, f64>,
    target: &GlobalVarianceTarget<'_>,
    trajectory: &mut [f64],
) -> Result<GlobalVarianceFit, ProbError> {
    let dim = problem.dim;
    check_len("global variance mean", target.mean.len(), dim)?;
    check_len("global variance variance", target.variance.len(), dim)?;
    check_positive("global variance mean", target.mean)?;
    check_positive("global variance variance", target.variance)?;
    check_positive("trajectory weight", &[target.trajectory_weight])?;
    // Checks the problem, and is the answer for sequences too short to vary.
    let plain = MlpgProblem {
        pull: None,
        ..*problem
    };
    mlpg(&plain, &mut MlpgWorkspace::new(), trajectory)?;
    check_finite("trajectory", trajectory)?;
    let n_frames = problem.state_of_frame.len();
    if n_frames < 2 || problem.n_fixed == n_frames {
        let (towards, variance) = temporal_moments(trajectory, dim);
        return Ok(GlobalVarianceFit {
            strength: vec![0.0; dim],
            towards,
            variance,
        });
    }
    let mut fit = GlobalVarianceFit {
        strength: vec![0.0; dim],
        towards: vec![0.0; dim],
        variance: vec![0.0; dim],
    };
    for d in 0..dim {
        let slope = 2.0 / (target.trajectory_weight * n_frames as f64 * target.variance[d]);
        let mut banded = Banded::new(&plain, d, trajectory);
        let (strength, solution) = find_strength(&mut banded, slope, target.mean[d])
            .ok_or(ProbError::NotPositiveDefinite { dim: d })?;
        for (frame, value) in trajectory
            .chunks_exact_mut(dim)
            .skip(problem.n_fixed)
            .zip(&banded.trajectory)
        {
            frame[d] = *value;
        }
        fit.strength[d] = strength;
        fit.towards[d] = solution.mean;
        fit.variance[d] = solution.variance;
    }
    Ok(fit)
}

/// The root of κ - slope (v(κ) - μ), where `slope` = 2 / (ω T σ²), in the region where R + κ J is
/// positive definite. Leaves the trajectory at the root in `banded`.
fn find_strength(banded: &mut Banded, slope: f64, target: f64) -> Option<(f64, Solution)> {
    let plain = banded.solve(0.0)?;
    let (mut low, mut high) = if plain.variance >= target {
        (0.0, slope * (plain.variance - target))
    } else {
        // Variances are not negative, and no diagonal entry may be: the root lies above both bounds.
        ((-slope * target).max(banded.lowest_strength()), 0.0)
    };
    let mut strength = 0.0;
    let mut solution = plain;
    for _ in 0..200 {
        let excess = strength - slope * (solution.variance - target);
        if excess >= 0.0 {
            high = strength;
        } else {
            low = strength;
        }
        let tolerance = 1e-14 * (strength.abs() + slope * target);
        if excess.abs() <= tolerance || high - low <= 1e-15 * (high.abs() + low.abs()) {
            break;
        }
        let newton = strength - excess / (1.0 - slope * solution.variance_slope);
        let mut next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        // Left of the region where a maximum can be, bisect back into it.
        let found = loop {
            if let Some(found) = banded.solve(next) {
                break Some(found);
            }
            low = next;
            next = 0.5 * (low + high);
            if next <= low || next >= high {
                break None;
            }
        };
        let Some(found) = found else {
            // What could not be solved left something else behind.
            return banded.solve(strength).map(|solution| (strength, solution));
        };
        strength = next;
        solution = found;
    }
    Some((strength, solution))
}
