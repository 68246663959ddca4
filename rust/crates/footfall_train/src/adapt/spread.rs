//! How much the steps of a style differ from each other, beside those of the base's walkers.

use crate::sequence::Sequence;
use footfall_core::Side;
use footfall_model::{
    FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, STATES_PER_STEP, StepOffset, StepSpread,
};

/// How many steps count for a feature's spread being that of all features, and for that of all being the base's.
const PRIOR_STEPS: f64 = 1.0;

/// A style's steps differ by at least and at most so much as the base's.
const LIMITS: [f64; 2] = [0.4, 4.0];

/// Least variance of a feature, rad²: what does not move has no spread to compare.
const VARIANCE_FLOOR: f64 = 1e-6;

/// The spread of the corpus' steps about the mean of each side's, per feature.
pub(super) fn step_spread(base: &GaitModel, corpus: &[Sequence]) -> StepSpread {
    let mut steps: [Vec<Step>; 2] = [vec![], vec![]];
    for sequence in corpus {
        for step in observed(sequence) {
            steps[step.side.index()].push(step);
        }
    }
    let mut own = Variances::default();
    let mut freedom = 0.0;
    for steps in &steps {
        if steps.len() < 2 {
            continue;
        }
        freedom += (steps.len() - 1) as f64;
        own.add_scatter(steps);
    }
    if freedom <= 0.0 {
        return StepSpread::default();
    }
    own.scale(1.0 / freedom);
    let base = Variances::of(base);
    let ratio = |own: f64, base: f64| (own + VARIANCE_FLOOR) / (base + VARIANCE_FLOOR);
    let pairs = || own.features.iter().zip(&base.features);
    let ratios: Vec<f64> = pairs().map(|(own, base)| ratio(*own, *base)).collect();
    let mut sorted = ratios.clone();
    sorted.sort_by(f64::total_cmp);
    let towards =
        |found: f64, prior: f64| (freedom * found + PRIOR_STEPS * prior) / (freedom + PRIOR_STEPS);
    let overall = towards(sorted[sorted.len() / 2], 1.0);
    let bounded = |variance: f64| variance.sqrt().clamp(LIMITS[0], LIMITS[1]);
    StepSpread {
        features: ratios
            .iter()
            .map(|ratio| bounded(towards(*ratio, overall)))
            .collect(),
        timing: bounded(towards(ratio(own.timing, base.timing), 1.0)),
    }
}

/// What is compared between steps.
struct Step {
    side: Side,
    /// Mean of every static feature in every fifth of the step.
    features: Vec<f64>,
    /// Logarithm of the duration.
    log_frames: f64,
}

fn observed(sequence: &Sequence) -> impl Iterator<Item = Step> {
    sequence.steps.iter().map(|step| {
        let frames = step.end - step.first;
        // Fifths of the step, not its states: where a joint is at a moment of the step also varies by when it moves.
        let cut = |part: usize| step.first + frames * part / STATES_PER_STEP;
        let mut features = vec![0.0; STATES_PER_STEP * FEATURE_COUNT];
        for (part, means) in features.chunks_exact_mut(FEATURE_COUNT).enumerate() {
            let frames = cut(part)..cut(part + 1);
            let share = 1.0 / frames.len().max(1) as f64;
            for frame in frames {
                let row = &sequence.observations[frame * OBSERVATION_COUNT..];
                for (mean, value) in means.iter_mut().zip(row) {
                    *mean += share * value;
                }
            }
        }
        Step {
            side: step.side,
            features,
            log_frames: (frames as f64).ln(),
        }
    })
}

/// Variances between steps, the features' added up over states.
struct Variances {
    features: Vec<f64>,
    timing: f64,
}

impl Default for Variances {
    fn default() -> Self {
        Self {
            features: vec![0.0; FEATURE_COUNT],
            timing: 0.0,
        }
    }
}

impl Variances {
    /// What the base's components of steps amount to.
    fn of(base: &GaitModel) -> Self {
        let mut variances = Self::default();
        for offset in base.variation.step.iter().flatten() {
            variances.add_offset(offset);
        }
        // Both feet have components of their own.
        variances.scale(0.5);
        variances
    }

    fn add_offset(&mut self, offset: &StepOffset) {
        for state in offset.means.chunks_exact(OBSERVATION_COUNT) {
            for (variance, value) in self.features.iter_mut().zip(state) {
                *variance += value * value;
            }
        }
        self.timing += offset.log_durations[0] * offset.log_durations[0];
    }

    /// Adds the squared distances of one side's steps from their mean.
    fn add_scatter(&mut self, steps: &[Step]) {
        let count = steps.len() as f64;
        for index in 0..STATES_PER_STEP * FEATURE_COUNT {
            let mean = steps.iter().map(|step| step.features[index]).sum::<f64>() / count;
            let squares = steps
                .iter()
                .map(|step| (step.features[index] - mean).powi(2));
            self.features[index % FEATURE_COUNT] += squares.sum::<f64>();
        }
        let mean = steps.iter().map(|step| step.log_frames).sum::<f64>() / count;
        let squares = steps.iter().map(|step| (step.log_frames - mean).powi(2));
        self.timing += squares.sum::<f64>();
    }

    fn scale(&mut self, factor: f64) {
        for value in self.features.iter_mut().chain([&mut self.timing]) {
            *value *= factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::LabelledStep;
    use footfall_core::StepPosition;

    /// Twelve steps of one frame a fifth, each shifted as a whole by `shift(step)` and as long as `frames(step)`.
    fn walk(shift: impl Fn(usize) -> f64, frames: impl Fn(usize) -> usize) -> Sequence {
        let mut observations = Vec::new();
        let mut steps = Vec::new();
        for step in 0..12 {
            let first = observations.len() / OBSERVATION_COUNT;
            for _ in 0..frames(step) {
                observations.extend([shift(step); OBSERVATION_COUNT]);
            }
            steps.push(LabelledStep {
                side: Side::BOTH[step % 2],
                first,
                end: observations.len() / OBSERVATION_COUNT,
                other_terminal: None,
                position: StepPosition::Inside,
                speed_mps: 1.0,
            });
        }
        Sequence {
            walker: 0,
            observations,
            steps,
        }
    }

    /// The shipped model with one component: every feature strays by 0.1, durations by a twentieth.
    fn base() -> GaitModel {
        let bytes = include_bytes!("../../../../../addons/footfall/models/walk.footfall");
        let mut base = GaitModel::from_bytes(bytes).unwrap();
        let component = StepOffset {
            means: vec![0.1; STATES_PER_STEP * OBSERVATION_COUNT],
            log_durations: vec![0.05; STATES_PER_STEP],
            other_terminal: 0.0,
        };
        base.variation.step = vec![[component.clone(), component]];
        base
    }

    #[test]
    fn the_spread_is_that_of_the_steps() {
        // Six steps a foot, three up and three down: a variance of 6/5 of the shift squared, divided by five less one.
        let shift = |step: usize| {
            if (step / 2).is_multiple_of(2) {
                0.2
            } else {
                -0.2
            }
        };
        let spread = step_spread(&base(), &[walk(shift, |_| 10)]);
        let variance = 0.2_f64.powi(2) * 6.0 / 5.0;
        let expected = (variance / 0.1_f64.powi(2)).sqrt();
        for factor in &spread.features {
            assert!(
                (factor / expected - 1.0).abs() < 0.1,
                "{factor} for {expected}"
            );
        }
        assert!(
            spread.timing < 0.5,
            "steps of one length: {}",
            spread.timing
        );
        let long = |step: usize| if (step / 2).is_multiple_of(2) { 22 } else { 18 };
        let spread = step_spread(&base(), &[walk(|_| 0.0, long)]);
        assert!(
            (spread.timing / 2.1 - 1.0).abs() < 0.15,
            "{}",
            spread.timing
        );
        assert!(spread.features.iter().all(|factor| *factor < 0.5));
    }

    #[test]
    fn one_step_says_nothing() {
        let mut one = walk(|_| 0.3, |_| 10);
        one.steps.truncate(2);
        assert_eq!(step_spread(&base(), &[one]), StepSpread::default());
    }
}
