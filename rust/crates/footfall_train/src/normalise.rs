//! Takes out how each walker stands and how far it swings, so that states find the phases of the step.
//!
//! Walkers differ more in posture and amplitude than a step changes either; trained on raw features, states come to
//! stand for groups of walkers. Each walker's features get the mean and spread of all: where walker-adaptive training begins
//! ([`crate::walker_adaptive`]).

use crate::sequence::Sequence;
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT};
use footfall_prob::gaussian::GaussianStats;

/// A spread counts as at least this much, radians: features that hardly move must not be blown up.
const LEAST_SPREAD: f64 = 0.02;

/// The same sequences with every walker's static features at the mean and spread of all; Δ and Δ² follow.
#[must_use]
pub fn without_walker(corpus: &[Sequence]) -> Vec<Sequence> {
    let walkers = corpus.iter().map(|s| s.walker + 1).max().unwrap_or(0);
    let mut moments = vec![GaussianStats::new(FEATURE_COUNT); walkers];
    for sequence in corpus {
        for observation in sequence.observations.chunks_exact(OBSERVATION_COUNT) {
            moments[sequence.walker].add(&observation[..FEATURE_COUNT], 1.0);
        }
    }
    let spreads: Vec<Vec<f64>> = moments.iter().map(spread).collect();
    let known: Vec<usize> = (0..walkers)
        .filter(|w| moments[*w].weight() > 0.0)
        .collect();
    let average = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        let mean =
            |dim| known.iter().map(|walker| of(*walker, dim)).sum::<f64>() / known.len() as f64;
        (0..FEATURE_COUNT).map(mean).collect()
    };
    let common_mean = average(&|walker, dim| moments[walker].mean()[dim]);
    let common_spread = average(&|walker, dim| spreads[walker][dim]);

    let mut moved = corpus.to_vec();
    for sequence in &mut moved {
        let (mean, spread) = (moments[sequence.walker].mean(), &spreads[sequence.walker]);
        for observation in sequence.observations.chunks_exact_mut(OBSERVATION_COUNT) {
            for (index, value) in observation.iter_mut().enumerate() {
                let dim = index % FEATURE_COUNT;
                let scale = common_spread[dim] / spread[dim];
                *value = if index < FEATURE_COUNT {
                    common_mean[dim] + scale * (*value - mean[dim])
                } else {
                    scale * *value
                };
            }
        }
    }
    moved
}

pub(crate) fn spread(moments: &GaussianStats) -> Vec<f64> {
    let floor = |variance: &f64| variance.sqrt().hypot(LEAST_SPREAD);
    moments.variance().iter().map(floor).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walkers_meet_at_their_mean_and_spread() {
        let sequence = |walker: usize, offset: f64, scale: f64| Sequence {
            walker,
            observations: (0..4 * OBSERVATION_COUNT)
                .map(|i| offset + scale * (i / OBSERVATION_COUNT) as f64)
                .collect(),
            steps: vec![],
        };
        let moved = without_walker(&[sequence(0, 0.0, 1.0), sequence(1, 10.0, 3.0)]);
        let at = |s: usize, t: usize, i: usize| moved[s].observations[t * OBSERVATION_COUNT + i];
        for feature in 0..FEATURE_COUNT {
            for frame in 0..4 {
                assert!((at(0, frame, feature) - at(1, frame, feature)).abs() < 2e-3);
            }
            assert!((at(0, 3, feature) - at(0, 0, feature) - 6.0).abs() < 2e-3);
        }
        // Differences over time are scaled like the features, but have no mean to move.
        let ratio = at(1, 2, FEATURE_COUNT) / 16.0;
        assert!((ratio - 2.0 / 3.0).abs() < 1e-3, "{ratio}");
    }
}
