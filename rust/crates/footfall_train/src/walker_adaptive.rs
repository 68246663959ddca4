//! Walker-adaptive training: each walker's linear transform is estimated and taken out in turn with the average walk.
//!
//! The simplest form of the speaker-adaptive training that Tilmanne et al. 2012 take over (section 5.1.2): one scale and one
//! offset per feature and walker, shared by the feature's time differences. What it takes out comes back as variation between
//! walkers ([`crate::differences`]). The ten or twenty steps of one walker determine no more than a diagonal.

mod average_swing;

use crate::average::{AverageWalk, EmConfig};
use crate::error::TrainError;
use crate::normalise::without_walker;
use crate::progress::Progress;
use crate::sequence::Sequence;
use average_swing::keep_average;
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT};
use footfall_prob::hsmm::HsmmStats;

/// Number of turns that transforms and average walk take.
const ROUNDS: usize = 3;

/// Iterations of the average walk between two rounds: it moves little.
const ROUND_ITERATIONS: usize = 6;

/// Strength with which a scale is held near 1, in frames that stray by one deviation of their state: a feature that one walker hardly
/// moves must not be blown up.
const PRIOR_FRAMES: f64 = 20.0;

/// Statics, Δ and Δ².
const WINDOWS: f64 = (OBSERVATION_COUNT / FEATURE_COUNT) as f64;

/// A walker's features as the average walker's: `scale` × feature + `offset`; differences over time by `scale` alone.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkerTransform {
    /// One factor a feature, all positive.
    pub scale: Vec<f64>,
    /// One offset a feature, radians.
    pub offset: Vec<f64>,
}

impl WalkerTransform {
    /// The transform that changes nothing.
    pub fn identity() -> Self {
        Self {
            scale: vec![1.0; FEATURE_COUNT],
            offset: vec![0.0; FEATURE_COUNT],
        }
    }

    /// The most probable transform of a walker whose states look like `seen`, to the states of an average walk.
    ///
    /// Per feature the maximum of N·3·ln f − ½ Σ γ p (f·o + g − μ)² − ½ λ (f − 1)² over statics, Δ and Δ² (g for the statics
    /// only): g in closed form, f the positive root of a quadratic equation.
    pub fn estimate(walk: &AverageWalk, seen: &HsmmStats) -> Self {
        let mut transform = Self::identity();
        for feature in 0..FEATURE_COUNT {
            let sums = Sums::of(walk, seen, feature);
            let (scale, offset) = sums.solve();
            transform.scale[feature] = scale;
            transform.offset[feature] = offset;
        }
        transform
    }

    /// The transform of a walker who was not trained on.
    ///
    /// # Errors
    /// [`TrainError::Inference`] when a sequence cannot be explained.
    pub(crate) fn of_newcomer(
        walk: &AverageWalk,
        sequences: &[Sequence],
    ) -> Result<Self, TrainError> {
        let mut transform = Self::identity();
        for _ in 0..ROUNDS {
            let aligned: Vec<Sequence> = sequences.iter().map(|s| transform.apply(s)).collect();
            transform = Self::estimate(walk, &walk.expect(&aligned, sequences)?);
        }
        Ok(transform)
    }

    /// The sequence as the average walker's.
    #[must_use]
    pub fn apply(&self, sequence: &Sequence) -> Sequence {
        let mut moved = sequence.clone();
        for observation in moved.observations.chunks_exact_mut(OBSERVATION_COUNT) {
            for (index, value) in observation.iter_mut().enumerate() {
                let feature = index % FEATURE_COUNT;
                *value *= self.scale[feature];
                if index < FEATURE_COUNT {
                    *value += self.offset[feature];
                }
            }
        }
        moved
    }

    /// Gain of the log density of every frame by the transform: ln |det| over statics, Δ and Δ².
    pub fn log_determinant(&self) -> f64 {
        WINDOWS * self.scale.iter().map(|scale| scale.ln()).sum::<f64>()
    }

    /// This transform, then another scale and offset of the average walker's features.
    fn then(&mut self, scale: &[f64], offset: &[f64]) {
        for feature in 0..FEATURE_COUNT {
            self.scale[feature] *= scale[feature];
            self.offset[feature] = self.offset[feature] * scale[feature] + offset[feature];
        }
    }
}

/// The terms of one feature's objective.
#[derive(Default)]
struct Sums {
    frames: f64,
    /// Σ γ p of the statics, of p·o, and of p·μ.
    precision: f64,
    first: f64,
    target: f64,
    /// Σ γ p o² and Σ γ p μ o over all windows.
    square: f64,
    cross: f64,
    prior: f64,
}

impl Sums {
    fn of(walk: &AverageWalk, seen: &HsmmStats, feature: usize) -> Self {
        let mut sums = Self {
            prior: PRIOR_FRAMES * WINDOWS,
            ..Self::default()
        };
        for (gaussian, moments) in walk.gaussians().iter().zip(&seen.emissions) {
            let frames = moments.weight();
            if frames <= 0.0 {
                continue;
            }
            sums.frames += frames;
            let variance = moments.variance();
            for index in (feature..OBSERVATION_COUNT).step_by(FEATURE_COUNT) {
                let weight = frames * gaussian.precision()[index];
                let (mean, target) = (moments.mean()[index], gaussian.mean()[index]);
                if index < FEATURE_COUNT {
                    sums.precision += weight;
                    sums.first += weight * mean;
                    sums.target += weight * target;
                }
                sums.square += weight * (mean * mean + variance[index]);
                sums.cross += weight * mean * target;
            }
        }
        sums
    }

    /// Scale and offset; those that change nothing when nothing was seen.
    fn solve(&self) -> (f64, f64) {
        if self.precision <= 0.0 {
            return (1.0, 0.0);
        }
        let square = self.square - self.first * self.first / self.precision + self.prior;
        let cross = self.cross - self.first * self.target / self.precision + self.prior;
        let root = (cross * cross + 4.0 * WINDOWS * self.frames * square).sqrt();
        let scale = (cross + root) / (2.0 * square);
        (scale, (self.target - scale * self.first) / self.precision)
    }
}

/// An average walk and the walkers that it was trained on as average walkers.
pub(crate) struct WalkerAdaptive {
    pub(crate) walk: AverageWalk,
    /// The corpus with every walker's transform applied.
    pub(crate) aligned: Vec<Sequence>,
    /// Transforms that were applied, walker by walker.
    pub(crate) transforms: Vec<WalkerTransform>,
    /// Log-likelihood of the corpus as recorded (transforms counted) after every round.
    pub(crate) log_likelihoods: Vec<f64>,
}

/// Trains the average walk and the walkers' transforms in turn, beginning with each walker's mean and spread.
pub(crate) fn train(
    corpus: &[Sequence],
    config: &EmConfig,
    progress: &mut dyn Progress,
) -> Result<WalkerAdaptive, TrainError> {
    let mut aligned = without_walker(corpus);
    let mut walk = AverageWalk::train(&aligned, config, progress)?;
    let walkers = corpus.iter().map(|s| s.walker + 1).max().unwrap_or(0);
    let round = EmConfig {
        max_iterations: ROUND_ITERATIONS.min(config.max_iterations),
        ..*config
    };
    let mut log_likelihoods = Vec::new();
    let mut first = walk.log_likelihoods.clone();
    let mut transforms = Vec::with_capacity(walkers);
    for _ in 0..ROUNDS {
        transforms.clear();
        let mut shown = Vec::with_capacity(walkers);
        for walker in 0..walkers {
            let of_walker = |sequences: &[Sequence]| -> Vec<Sequence> {
                let own = sequences.iter().filter(|s| s.walker == walker);
                own.cloned().collect()
            };
            let seen = walk.expect(&of_walker(&aligned), &of_walker(corpus))?;
            transforms.push(WalkerTransform::estimate(&walk, &seen));
            shown.push(seen);
        }
        keep_average(&walk, &shown, &mut transforms);
        aligned = corpus
            .iter()
            .map(|sequence| transforms[sequence.walker].apply(sequence))
            .collect();
        walk = walk.refine(&aligned, &round, progress)?;
        let gained: f64 = corpus
            .iter()
            .map(|s| s.frames() as f64 * transforms[s.walker].log_determinant())
            .sum();
        let last = walk.log_likelihoods.last().copied().unwrap_or_default();
        log_likelihoods.push(last + gained);
    }
    // The reported course of training is that of the first, whole run.
    walk.log_likelihoods = core::mem::take(&mut first);
    Ok(WalkerAdaptive {
        walk,
        aligned,
        transforms,
        log_likelihoods,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::LabelledStep;
    use footfall_core::{Side, StepPosition};

    /// Four steps whose features swing as a wave of the step, by a scale and about an offset, with a little noise.
    fn walk(walker: usize, scale: f64, offset: f64) -> Sequence {
        const STEP: usize = 30;
        let frames = 4 * STEP;
        let value = |frame: usize, feature: usize| {
            let phase = core::f64::consts::PI * frame as f64 / STEP as f64;
            let noise = ((frame * 131 + feature * 71 + walker * 17) as f64 * 12.9898).sin();
            scale * (0.3 * (phase + 0.1 * feature as f64).sin() + 0.01 * noise) + offset
        };
        let mut observations = Vec::new();
        for frame in 0..frames {
            let at = |t: usize| (0..FEATURE_COUNT).map(move |f| value(t, f));
            let (before, after) = (frame.saturating_sub(1), frame + 1);
            observations.extend(at(frame));
            observations.extend(at(after).zip(at(before)).map(|(a, b)| 0.5 * (a - b)));
            let ends = at(after).zip(at(before));
            observations.extend(ends.zip(at(frame)).map(|((a, b), c)| a + b - 2.0 * c));
        }
        let steps = (0..4)
            .map(|step| LabelledStep {
                side: if step % 2 == 0 {
                    Side::Left
                } else {
                    Side::Right
                },
                first: step * STEP,
                end: (step + 1) * STEP,
                other_terminal: Some(0.3),
                position: StepPosition::Inside,
                speed_mps: 1.2,
            })
            .collect();
        Sequence {
            walker,
            observations,
            steps,
        }
    }

    const EM: EmConfig = EmConfig {
        max_iterations: 10,
        min_gain_per_frame: 1e-4,
    };

    /// These walkers differ by a scale and an offset: with both taken out they are one walker.
    #[test]
    fn known_transforms_are_taken_out() {
        let known = [(1.0, 0.0), (1.4, 0.3), (0.7, -0.2), (1.0, 0.5)];
        let corpus: Vec<Sequence> = known
            .iter()
            .enumerate()
            .map(|(walker, (scale, offset))| walk(walker, *scale, *offset))
            .collect();
        let trained = train(&corpus, &EM, &mut ()).unwrap();
        for aligned in &trained.aligned[1..] {
            let pairs = aligned
                .observations
                .iter()
                .zip(&trained.aligned[0].observations);
            let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(
                apart < 0.09,
                "{apart} apart, of a swing of 0.6 and offsets of 0.7"
            );
        }
        let plain = AverageWalk::train(&corpus, &EM, &mut ()).unwrap();
        let spread = |walk: &AverageWalk| -> f64 {
            walk.gaussians()
                .iter()
                .map(|g| g.variance()[..FEATURE_COUNT].iter().sum::<f64>())
                .sum()
        };
        assert!(spread(&trained.walk) < 0.2 * spread(&plain));
        let rising = trained.log_likelihoods.windows(2);
        for pair in rising {
            assert!(pair[1] > pair[0] - 1e-3 * pair[0].abs(), "{pair:?}");
        }
    }

    /// The closed form against the objective written out, at points around it.
    #[test]
    fn the_estimate_is_the_maximum_of_its_objective() {
        let corpus = [walk(0, 1.0, 0.0), walk(0, 1.1, 0.05)];
        let average = AverageWalk::train(&corpus, &EM, &mut ()).unwrap();
        let other = [walk(1, 1.5, -0.2)];
        let seen = average.expect(&other, &other).unwrap();
        let objective = |feature: usize, scale: f64, offset: f64| {
            let mut sum = -0.5 * PRIOR_FRAMES * WINDOWS * (scale - 1.0).powi(2);
            for (gaussian, moments) in average.gaussians().iter().zip(&seen.emissions) {
                let variance = moments.variance();
                for index in (feature..OBSERVATION_COUNT).step_by(FEATURE_COUNT) {
                    let shift = if index < FEATURE_COUNT { offset } else { 0.0 };
                    let distance = scale * moments.mean()[index] + shift - gaussian.mean()[index];
                    let square = distance * distance + scale * scale * variance[index];
                    let fit = scale.ln() - 0.5 * gaussian.precision()[index] * square;
                    sum += moments.weight() * fit;
                }
            }
            sum
        };
        let found = WalkerTransform::estimate(&average, &seen);
        for feature in 0..FEATURE_COUNT {
            let (scale, offset) = (found.scale[feature], found.offset[feature]);
            let best = objective(feature, scale, offset);
            for (ds, d) in [
                (1e-3, 0.0),
                (-1e-3, 0.0),
                (0.0, 1e-3),
                (0.0, -1e-3),
                (1e-3, -1e-3),
            ] {
                let near = objective(feature, scale + ds, offset + d);
                assert!(near < best, "feature {feature}: {near} beats {best}");
            }
        }
    }

    #[test]
    fn nothing_seen_changes_nothing() {
        let average = AverageWalk::train(&[walk(0, 1.0, 0.0)], &EM, &mut ()).unwrap();
        let seen = average.expect(&[], &[]).unwrap();
        assert_eq!(
            WalkerTransform::estimate(&average, &seen),
            WalkerTransform::identity()
        );
    }
}
