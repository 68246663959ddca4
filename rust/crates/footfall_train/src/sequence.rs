//! Training data: feature sequences with their steps marked.

use footfall_core::{Side, StepPosition};
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT, layout};

/// A walk from its first initial contact to its last, as the trainer sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// Index of the walker. A mirrored walk belongs to a walker of its own.
    pub walker: usize,
    /// T × [`OBSERVATION_COUNT`] observations, frame by frame.
    pub observations: Vec<f64>,
    /// The steps, one after the other without gaps; they cover all T frames.
    pub steps: Vec<LabelledStep>,
}

/// A step of a [`Sequence`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelledStep {
    /// The foot whose initial contact begins the step.
    pub side: Side,
    /// First frame of the step.
    pub first: usize,
    /// The frame after the last: the other foot's initial contact.
    pub end: usize,
    /// When the other foot leaves the ground, as a fraction of the step; negative in a run, where it did so before the step began.
    pub other_terminal: Option<f64>,
    /// Place in the walk.
    pub position: StepPosition,
    /// Speed of the walker over the step, m/s on the canonical body.
    pub speed_mps: f64,
}

impl LabelledStep {
    /// Number of frames.
    pub const fn frames(&self) -> usize {
        self.end - self.first
    }
}

/// Lengths of all steps of a corpus, frames.
pub(crate) fn step_lengths(corpus: &[Sequence]) -> impl Iterator<Item = usize> {
    let steps = corpus.iter().flat_map(|sequence| &sequence.steps);
    steps.map(LabelledStep::frames)
}

impl Sequence {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.observations.len() / OBSERVATION_COUNT
    }

    /// Observations of one of its steps.
    pub(crate) fn rows_of(&self, step: &LabelledStep) -> &[f64] {
        &self.observations[step.first * OBSERVATION_COUNT..step.end * OBSERVATION_COUNT]
    }

    /// Mean speed, m/s.
    pub fn speed_mps(&self) -> f64 {
        let travel: f64 = self
            .steps
            .iter()
            .map(|step| step.speed_mps * step.frames() as f64)
            .sum();
        travel / self.frames() as f64
    }

    /// The same walk with left and right exchanged, of the walker `walker`.
    #[must_use]
    pub fn mirrored(&self, walker: usize) -> Self {
        let mut mirrored = self.clone();
        mirrored.walker = walker;
        layout::mirror(&mut mirrored.observations);
        for step in &mut mirrored.steps {
            step.side = step.side.other();
        }
        mirrored
    }

    /// Variance over time of every static feature (equation 13 of the paper, divided by T).
    pub fn variance(&self) -> Vec<f64> {
        let frames = self.frames() as f64;
        let statics = || {
            self.observations
                .chunks_exact(OBSERVATION_COUNT)
                .map(|observation| &observation[..FEATURE_COUNT])
        };
        let mut mean = vec![0.0; FEATURE_COUNT];
        for frame in statics() {
            for (mean, value) in mean.iter_mut().zip(frame) {
                *mean += value / frames;
            }
        }
        let mut variance = vec![0.0; FEATURE_COUNT];
        for frame in statics() {
            for ((variance, mean), value) in variance.iter_mut().zip(&mean).zip(frame) {
                *variance += (value - mean).powi(2) / frames;
            }
        }
        variance
    }
}
