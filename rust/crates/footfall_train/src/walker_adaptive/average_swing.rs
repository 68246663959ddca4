//! Posture and swing of the average walker: those that walkers have on average.

use super::WalkerTransform;
use crate::average::AverageWalk;
use footfall_model::FEATURE_COUNT;
use footfall_prob::gaussian::GaussianStats;
use footfall_prob::hsmm::HsmmStats;

/// Least factor on the swing of a feature that walkers hardly move in common.
const LEAST_SCALE: f64 = 0.1;

/// Moves all transforms alike so that the average walker stands as the walkers do on average, and swings as far as they do along the course of `walk`. Any walker
/// could serve as the common one, and the likelihood does not say which.
///
/// Each walker counts once, however long it was recorded. The spread of a feature is no measure of a swing: much of it is what one walker does alone, and what
/// differs from step to step. Arms of an average walker with that spread swing half as far again to the side as those of the walkers.
///
/// `shown` are the states as recorded, walker by walker, as `walk` explains them.
pub(super) fn keep_average(
    walk: &AverageWalk,
    shown: &[HsmmStats],
    transforms: &mut [WalkerTransform],
) {
    let known: Vec<(&HsmmStats, WalkerTransform)> = shown
        .iter()
        .zip(transforms.iter().cloned())
        .filter(|(shown, _)| shown.emissions.iter().any(|state| state.weight() > 0.0))
        .collect();
    let count = known.len().max(1) as f64;
    let (mut scale, mut offset) = (vec![1.0; FEATURE_COUNT], vec![0.0; FEATURE_COUNT]);
    for feature in 0..FEATURE_COUNT {
        let (mut mean, mut swing, mut moved) = (0.0, 0.0, 0.0);
        for (shown, transform) in &known {
            let course = Course::of(walk, &shown.emissions, feature);
            mean += course.mean / count;
            swing += course.swing / count;
            moved += (transform.scale[feature] * course.mean + transform.offset[feature]) / count;
        }
        // The transforms lead to what `walk` has.
        scale[feature] = swing.max(LEAST_SCALE);
        offset[feature] = mean - scale[feature] * moved;
    }
    for transform in transforms {
        transform.then(&scale, &offset);
    }
}

/// A feature of a walker beside that of the average walk.
struct Course {
    mean: f64,
    /// Swing in units of the average walk's, along its course over the states.
    swing: f64,
}

impl Course {
    fn of(walk: &AverageWalk, shown: &[GaussianStats], feature: usize) -> Self {
        let states = || {
            let pairs = walk.gaussians().iter().zip(shown);
            let seen = pairs.filter(|(_, shown)| shown.weight() > 0.0);
            seen.map(|(average, shown)| {
                let of_average = average.mean()[feature];
                (shown.weight(), of_average, shown.mean()[feature])
            })
        };
        let (mut frames, mut average_mean, mut mean) = (0.0, 0.0, 0.0);
        for (weight, average, own) in states() {
            frames += weight;
            average_mean += weight * average;
            mean += weight * own;
        }
        average_mean /= frames;
        mean /= frames;
        let (mut together, mut square) = (0.0, 0.0);
        for (weight, average, own) in states() {
            together += weight * (average - average_mean) * (own - mean);
            square += weight * (average - average_mean).powi(2);
        }
        let swing = if square > 0.0 { together / square } else { 1.0 };
        Self { mean, swing }
    }
}
