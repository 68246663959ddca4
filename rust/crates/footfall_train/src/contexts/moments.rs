//! Moments of the steps of every context.

use super::tied::Tied;
use super::{CONTEXTS, context};
use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use footfall_core::StepPosition;
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::duration::DurationDist;
use footfall_prob::gaussian::GaussianStats;

/// Moments of every context.
pub(super) struct Moments {
    /// Per state and context, the observations.
    pub(super) outputs: Vec<Vec<GaussianStats>>,
    /// Per context, the five durations of a step in frames.
    pub(super) durations: Vec<GaussianStats>,
    /// Per context, when the other foot leaves and how fast the walk is, m/s.
    pub(super) terminals: Vec<GaussianStats>,
    pub(super) speeds: Vec<GaussianStats>,
}

impl Moments {
    pub(super) fn gather(
        tied: &Tied,
        corpus: &[Sequence],
        max_duration: usize,
    ) -> Result<Self, TrainError> {
        let durations: Vec<DurationDist> = tied
            .durations
            .iter()
            .map(|duration| duration.discretise(max_duration))
            .collect::<Result<_, _>>()?;
        let empty = |dim| vec![GaussianStats::new(dim); CONTEXTS];
        let mut moments = Self {
            outputs: (0..STATES_PER_STEP)
                .map(|_| empty(OBSERVATION_COUNT))
                .collect(),
            durations: empty(STATES_PER_STEP),
            terminals: empty(1),
            speeds: empty(1),
        };
        for sequence in corpus {
            let boundaries = tied.cut(sequence, &durations)?;
            moments.add(sequence, &boundaries);
        }
        Ok(moments)
    }

    pub(super) fn add(&mut self, sequence: &Sequence, boundaries: &[usize]) {
        let speed = steady_speed(sequence);
        for (number, step) in sequence.steps.iter().enumerate() {
            let context = context(step.position, step.side);
            let mut lengths = [0.0; STATES_PER_STEP];
            for (state, length) in lengths.iter_mut().enumerate() {
                let segment = number * STATES_PER_STEP + state;
                let frames = boundaries[segment]..boundaries[segment + 1];
                *length = frames.len() as f64;
                for frame in frames {
                    let row = &sequence.observations[frame * OBSERVATION_COUNT..];
                    self.outputs[state][context].add(&row[..OBSERVATION_COUNT], 1.0);
                }
            }
            self.durations[context].add(&lengths, 1.0);
            self.speeds[context].add(&[speed], 1.0);
            if let Some(terminal) = step.other_terminal {
                self.terminals[context].add(&[terminal], 1.0);
            }
        }
    }
}

/// Speed of the walk between its ends, m/s.
fn steady_speed(sequence: &Sequence) -> f64 {
    let mean = |steps: &mut dyn Iterator<Item = &LabelledStep>| {
        let (sum, count) = steps.fold((0.0, 0.0), |(s, n), step| (s + step.speed_mps, n + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let inside = |step: &&LabelledStep| step.position == StepPosition::Inside;
    mean(&mut sequence.steps.iter().filter(inside))
        .or_else(|| mean(&mut sequence.steps.iter()))
        .unwrap_or_default()
}
