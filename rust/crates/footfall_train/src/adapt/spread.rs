//! Spread of the steps of a style, beside those of the base's walkers.

use crate::sequence::Sequence;
use footfall_core::{Joint, Side};
use footfall_model::{
    FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, STATES_PER_STEP, StepOffset, StepSpread,
};

/// Number of steps that count for a limb's spread being that of the body, and for the body's being the base's.
const PRIOR_STEPS: f64 = 1.0;

/// Parts of the body with a factor each.
const LIMBS: usize = 3;

/// Least and greatest spread of a style's steps, relative to the base's.
const LIMITS: [f64; 2] = [0.4, 4.0];

/// Least variance of a feature, rad²: what does not move has no spread to compare.
const VARIANCE_FLOOR: f64 = 1e-6;

/// The spread of the corpus' steps, per feature: about the mean of each side's in the recording that they are from. Recordings differ by who
/// walks and how, and one walker's steps by far less.
pub(super) fn step_spread(base: &GaitModel, corpus: &[Sequence]) -> StepSpread {
    let mut own = Variances::default();
    let mut freedom = 0.0;
    for sequence in corpus {
        let (left, right): (Vec<Step>, Vec<Step>) =
            observed(sequence).partition(|step| step.side == Side::Left);
        for steps in [left, right] {
            if steps.len() < 2 {
                continue;
            }
            freedom += (steps.len() - 1) as f64;
            own.add_scatter(&steps);
        }
    }
    if freedom <= 0.0 {
        return StepSpread::default();
    }
    own.scale(1.0 / freedom);
    let base = Variances::of(base);
    let ratio = |own: f64, base: f64| (own + VARIANCE_FLOOR) / (base + VARIANCE_FLOOR);
    let towards =
        |found: f64, prior: f64| (freedom * found + PRIOR_STEPS * prior) / (freedom + PRIOR_STEPS);
    let bounded = |variance: f64| variance.sqrt().clamp(LIMITS[0], LIMITS[1]);
    let (own_limbs, base_limbs) = (own.by_limb(), base.by_limb());
    let total = |limbs: [f64; LIMBS]| limbs.iter().sum::<f64>();
    let overall = towards(ratio(total(own_limbs), total(base_limbs)), 1.0);
    let factors: [f64; LIMBS] = core::array::from_fn(|limb| {
        bounded(towards(ratio(own_limbs[limb], base_limbs[limb]), overall))
    });
    StepSpread {
        features: (0..FEATURE_COUNT)
            .map(|feature| factors[limb_of(feature)])
            .collect(),
        timing: bounded(towards(ratio(own.timing, base.timing), 1.0)),
    }
}

/// The part of the body whose factor a feature has: 0 the legs and the hips above them, 1 the trunk and the head, 2 the arms. The joints of
/// a limb vary together: with factors of their own a foot that the base's steps put down flat would not come down.
fn limb_of(feature: usize) -> usize {
    use Joint::{Chest, Head, Hips, Neck, Spine, UpperChest};
    let joint = Joint::ALL[feature / 3];
    let leg = Side::BOTH.into_iter().any(|side| {
        [side.upper_leg(), side.lower_leg(), side.foot(), side.toes()].contains(&joint)
    });
    match joint {
        Hips => 0,
        _ if leg => 0,
        Spine | Chest | UpperChest | Neck | Head => 1,
        _ => 2,
    }
}

/// Features that are compared between steps.
struct Step {
    side: Side,
    /// Mean of every static feature in every fifth of the step.
    features: Vec<f64>,
    /// Logarithm of the duration.
    log_frames: f64,
}

fn observed(sequence: &Sequence) -> impl Iterator<Item = Step> {
    sequence.steps.iter().map(|step| {
        let frames = step.frames();
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
    /// Amount of the base's components of steps.
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

    /// Sums over the features of each limb.
    fn by_limb(&self) -> [f64; LIMBS] {
        let mut limbs = [0.0; LIMBS];
        for (feature, variance) in self.features.iter().enumerate() {
            limbs[limb_of(feature)] += variance;
        }
        limbs
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
        let bytes = include_bytes!("../../../../../addons/footfall/models/locomotion.footfall");
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
    fn people_who_differ_do_not_make_steps_differ() {
        let people = [walk(|_| 0.3, |_| 10), walk(|_| -0.3, |_| 14)];
        let spread = step_spread(&base(), &people);
        assert!(spread.features.iter().all(|factor| *factor < 0.5));
        assert!(spread.timing < 0.5, "{}", spread.timing);
    }

    #[test]
    fn joints_of_a_limb_share_a_factor() {
        let mut one = walk(|_| 0.0, |_| 10);
        // One foot's angle strays by three times what the base's legs do altogether, one arm's not at all.
        let foot = 3 * Joint::LeftFoot.index();
        for (number, step) in one.steps.iter().enumerate() {
            let sign = if (number / 2).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            for frame in step.first..step.end {
                one.observations[frame * OBSERVATION_COUNT + foot] = 0.9 * sign;
            }
        }
        let spread = step_spread(&base(), &[one]);
        let factor = |joint: Joint| spread.features[3 * joint.index()];
        assert!(factor(Joint::LeftFoot) > 1.0);
        for leg in [Joint::Hips, Joint::RightLowerLeg] {
            assert!((factor(leg) - factor(Joint::LeftFoot)).abs() < 1e-12);
        }
        assert!(factor(Joint::LeftHand) < factor(Joint::LeftFoot));
    }

    #[test]
    fn one_step_says_nothing() {
        let mut one = walk(|_| 0.3, |_| 10);
        one.steps.truncate(2);
        assert_eq!(step_spread(&base(), &[one]), StepSpread::default());
    }
}
