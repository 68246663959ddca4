//! The most probable correction, and how much more probable it makes what was recorded.

use super::reference::{FLEXION_DEG, Gait, covariance_of_placing};
use super::stances::{COUNT, Legs, Parameters};
use crate::walking_evidence::PHASES;
use nalgebra::{DMatrix, DVector, Dyn, OMatrix, SMatrix, SVector, U1};

/// Errors of fits to markers, in leg lengths: mean and standard deviation of how far hip joints have to move up and
/// forwards, by how much legs are too short, and how far the left hip joint is off otherwise than the right one.
const MEAN: [f64; COUNT] = [0.016, -0.025, 0.0, 0.0, 0.0];
const SPREAD: [f64; COUNT] = [0.010, 0.03, 0.004, 0.004, 0.008];
const ITERATIONS: usize = 80;

/// Misplaced hip joints.
struct Fit {
    /// The most probable places.
    parameters: Parameters,
    /// Logarithm of the probability of what was recorded, over all places.
    evidence: f64,
}

/// Knees' distance from normal gait in terms of a way of walking.
struct Likelihood<'a> {
    legs: &'a Legs,
    precision: DMatrix<f64>,
    /// Half of the logarithm of the covariance's determinant.
    half_ln_determinant: f64,
    normal: DVector<f64>,
}

type Slopes = OMatrix<f64, Dyn, Dyn>;

impl<'a> Likelihood<'a> {
    /// Nothing where the covariance has no inverse.
    fn new(legs: &'a Legs, covariance: DMatrix<f64>) -> Option<Self> {
        let factor = covariance.cholesky()?;
        let diagonal = factor.l_dirty().diagonal();
        Some(Self {
            legs,
            half_ln_determinant: diagonal.iter().map(|value| value.ln()).sum(),
            precision: factor.inverse(),
            normal: DVector::from_fn(2 * PHASES, |row, _| FLEXION_DEG[row % PHASES]),
        })
    }

    fn error(&self, parameters: &Parameters) -> (OMatrix<f64, Dyn, U1>, Slopes) {
        let (angles, slopes) = self.legs.knees(parameters);
        (angles - &self.normal, slopes)
    }

    /// Negative logarithm of the joint probability of knees and places but for constants, its gradient and its curvature.
    fn linearise(
        &self,
        parameters: &Parameters,
    ) -> (f64, SVector<f64, COUNT>, SMatrix<f64, COUNT, COUNT>) {
        let (error, slopes) = self.error(parameters);
        let weighed = &self.precision * &error;
        let precision = SVector::from(SPREAD.map(|deviation| 1.0 / (deviation * deviation)));
        let from_mean = parameters.0 - SVector::from(MEAN);
        let pull = precision.component_mul(&from_mean);
        let cost = 0.5 * (error.dot(&weighed) + from_mean.dot(&pull));
        let gradient = slopes.transpose() * weighed;
        let curvature = slopes.transpose() * &self.precision * slopes;
        (
            cost,
            SVector::from_fn(|row, _| gradient[row]) + pull,
            SMatrix::from_fn(|row, column| curvature[(row, column)])
                + SMatrix::from_diagonal(&precision),
        )
    }
}

/// Evidence for hip joints that are where they belong.
pub(super) fn as_recorded(legs: &Legs, gait: Gait) -> Option<f64> {
    let likelihood = Likelihood::new(legs, gait.covariance(legs.strides()))?;
    let (error, _) = likelihood.error(&Parameters::default());
    let squares = error.dot(&(&likelihood.precision * &error));
    Some(-0.5 * squares - likelihood.half_ln_determinant)
}

/// Evidence for misplaced hip joints of a person who walks plainly.
pub(super) fn misplaced(legs: &Legs) -> Option<f64> {
    let covariance = Gait::Plain.covariance(legs.strides());
    most_probable(legs, covariance).map(|fit| fit.evidence)
}

/// The places of misplaced hip joints.
pub(super) fn places(legs: &Legs) -> Option<Parameters> {
    let covariance = covariance_of_placing(legs.strides());
    most_probable(legs, covariance).map(|fit| fit.parameters)
}

/// Levenberg and Marquardt's method, and Laplace's for the evidence.
fn most_probable(legs: &Legs, covariance: DMatrix<f64>) -> Option<Fit> {
    let likelihood = Likelihood::new(legs, covariance)?;
    let mut best = Parameters(SVector::from(MEAN));
    let (mut cost, mut gradient, mut curvature) = likelihood.linearise(&best);
    let mut damping = 1e-3;
    for _ in 0..ITERATIONS {
        let damped = curvature + SMatrix::from_diagonal(&(curvature.diagonal() * damping));
        let step = damped.cholesky()?.solve(&gradient);
        let candidate = Parameters(best.0 - step);
        let (new_cost, new_gradient, new_curvature) = likelihood.linearise(&candidate);
        if new_cost < cost {
            let is_done = cost - new_cost < 1e-9;
            (best, cost) = (candidate, new_cost);
            (gradient, curvature) = (new_gradient, new_curvature);
            damping *= 0.3;
            if is_done {
                break;
            }
        } else {
            damping *= 8.0;
        }
    }
    // Volume of the places that explain the knees beside that of all that fits get wrong.
    let diagonal = curvature.cholesky()?.l_dirty().diagonal();
    let volume = diagonal.iter().zip(SPREAD);
    let half_ln_volume: f64 = volume.map(|(value, spread)| (value * spread).ln()).sum();
    Some(Fit {
        parameters: best,
        evidence: -cost - likelihood.half_ln_determinant - half_ln_volume,
    })
}
