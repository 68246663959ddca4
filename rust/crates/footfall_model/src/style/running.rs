//! Styles of a run: what a style does to the walk, carried over to running.
//!
//! Styles are learned from walks. Two things of a style are those of the person rather than of the gait: how the body is held, and how far trunk,
//! head and arms swing. Legs run as the model's people do, held as the style holds them.

use crate::gait_model::GaitModel;
use crate::layout::{FEATURE_COUNT, OBSERVATION_COUNT, feature_offset};
use footfall_core::Joint;

/// Share of what the style does to the posture of hips and legs in walking: bent knees of a walk would double those of a run.
const LEG_POSTURE_SHARE: f64 = 0.4;

/// The same of the elbows, which runners bend anyway.
const ELBOW_POSTURE_SHARE: f64 = 0.3;

/// Greatest factor by which trunk and arms swing farther or less.
const SWING_FACTORS: [f64; 2] = [0.5, 1.6];

/// Styled tempo carries over with this exponent, within these factors: runs differ less in cadence than walks.
const TEMPO_EXPONENT: f64 = 0.5;
const TEMPO_FACTORS: [f64; 2] = [0.85, 1.18];

/// Share of a style's change of a joint's posture in walking that applies in a run.
pub fn carried_posture_share(joint: Joint) -> f64 {
    if joint.is_of_lower_body() {
        LEG_POSTURE_SHARE
    } else {
        1.0
    }
}

impl GaitModel {
    /// This run as people run who walk as `styled` instead of as `walk`.
    pub(super) fn in_style_of(&self, walk: &Self, styled: &Self) -> Self {
        let mut run = self.clone();
        let (from, to) = (walk.mean_features(), styled.mean_features());
        let own = self.mean_features();
        let mut shift = [0.0; FEATURE_COUNT];
        let mut factor = [1.0; FEATURE_COUNT];
        for joint in Joint::ALL {
            let share = match joint {
                Joint::LeftLowerArm | Joint::RightLowerArm => ELBOW_POSTURE_SHARE,
                _ => carried_posture_share(joint),
            };
            for dim in feature_offset(joint)..feature_offset(joint) + 3 {
                shift[dim] = share * (to[dim] - from[dim]);
                if !joint.is_of_lower_body() {
                    let variances = [walk, styled].map(|model| model.global_variance.mean[dim]);
                    let swing = (variances[1] / variances[0]).sqrt();
                    factor[dim] = swing.clamp(SWING_FACTORS[0], SWING_FACTORS[1]);
                }
            }
        }
        let states = run.steps.iter_mut().flat_map(|step| &mut step.states);
        for state in states {
            for (index, mean) in state.mean.iter_mut().enumerate() {
                let dim = index % FEATURE_COUNT;
                let (center, shift) = if index < FEATURE_COUNT {
                    (own[dim], shift[dim])
                } else {
                    (0.0, 0.0)
                };
                *mean = center + shift + factor[dim] * (*mean - center);
            }
            for (index, variance) in state.variance.iter_mut().enumerate() {
                *variance *= factor[index % FEATURE_COUNT].powi(2);
            }
        }
        let scaled = |means: &mut [f64]| {
            for (index, mean) in means.iter_mut().enumerate() {
                *mean *= factor[index % OBSERVATION_COUNT % FEATURE_COUNT];
            }
        };
        let variation = run
            .variation
            .walker
            .iter_mut()
            .chain(&mut run.variation.step);
        for offset in variation.flatten().chain(&mut run.speed.slopes) {
            scaled(&mut offset.means);
        }
        for (dim, mean) in run.global_variance.mean.iter_mut().enumerate() {
            *mean *= factor[dim].powi(2);
        }
        let tempo = (styled.cadence_hz() / walk.cadence_hz())
            .powf(TEMPO_EXPONENT)
            .clamp(TEMPO_FACTORS[0], TEMPO_FACTORS[1]);
        for state in run.steps.iter_mut().flat_map(|step| &mut step.states) {
            state.duration_mean /= tempo;
        }
        run
    }
}
