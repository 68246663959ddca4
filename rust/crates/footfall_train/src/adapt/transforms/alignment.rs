//! Alignment of the style's walks to the states as they are transformed so far.

use super::Adapting;
use crate::error::TrainError;
use crate::sequence::Sequence;
use crate::step_hsmm::{STATES, discretised, posterior};
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::regression::{LinearTransform, RegressionStats};

/// Statistics of every state by an alignment.
pub(super) struct Alignment {
    /// Per state and block.
    pub(super) frames: Vec<Vec<RegressionStats>>,
    /// Per state.
    pub(super) durations: Vec<RegressionStats>,
    /// Per state, how often each duration occurs, from one frame on.
    pub(super) histograms: Vec<Vec<f64>>,
    pub(super) log_likelihood: f64,
}

impl Adapting {
    /// The frames of a sequence in deviations from the centre.
    pub(super) fn in_units(&self, sequence: &Sequence) -> Vec<f64> {
        let mut frames = sequence.observations.clone();
        for frame in frames.chunks_exact_mut(OBSERVATION_COUNT) {
            for (dim, value) in frame.iter_mut().enumerate() {
                *value = (*value - self.centre[dim]) / self.deviation[dim];
            }
        }
        frames
    }

    /// Whole walks as chains of states.
    pub(super) fn align(
        &self,
        corpus: &[Sequence],
        frames: &[Vec<f64>],
    ) -> Result<Alignment, TrainError> {
        let durations = discretised(&self.adapted_durations()?, self.max_duration)?;
        let mut alignment = self.empty_alignment();
        for (sequence, frames) in corpus.iter().zip(frames) {
            let log_emissions = self.log_emissions(frames);
            let (chain, posterior) = posterior(&log_emissions, &sequence.steps, &durations)?;
            for (state, segment) in chain.iter().zip(&posterior.segments) {
                for (frame, weight) in segment.frames().zip(&segment.state_probs) {
                    self.add_frame(&mut alignment, state.emission, frames, frame, *weight);
                }
                for (duration, weight) in (1..).zip(&segment.duration_probs) {
                    self.add_duration(&mut alignment, state.duration, duration, *weight);
                }
            }
            alignment.log_likelihood += posterior.log_likelihood;
        }
        Ok(alignment)
    }

    /// Every step shared out among its states as the base shares its own.
    pub(super) fn even_alignment(&self, corpus: &[Sequence], frames: &[Vec<f64>]) -> Alignment {
        let mut alignment = self.empty_alignment();
        let lasts = |state: usize| {
            self.duration_centre + self.duration_deviation * self.durations[state].mean()[0]
        };
        for (sequence, frames) in corpus.iter().zip(frames) {
            for step in &sequence.steps {
                let first_state = step.side.index() * STATES_PER_STEP;
                let states = first_state..first_state + STATES_PER_STEP;
                let length = step.frames();
                let total: f64 = states.clone().map(lasts).sum();
                let (mut elapsed, mut from) = (0.0, 0);
                for (index, state) in states.enumerate() {
                    elapsed += lasts(state) / total * length as f64;
                    // At least a frame for this state and for each that follows.
                    let most = length - (STATES_PER_STEP - 1 - index);
                    let to = (elapsed.round() as usize).clamp(from + 1, most);
                    for frame in from..to {
                        self.add_frame(&mut alignment, state, frames, step.first + frame, 1.0);
                    }
                    self.add_duration(&mut alignment, state, to - from, 1.0);
                    from = to;
                }
            }
        }
        alignment
    }

    fn empty_alignment(&self) -> Alignment {
        let blocks = || {
            self.ranges
                .iter()
                .map(|range| RegressionStats::new(range.len()))
        };
        Alignment {
            frames: (0..STATES).map(|_| blocks().collect()).collect(),
            durations: vec![RegressionStats::new(1); STATES],
            histograms: vec![vec![0.0; self.max_duration]; STATES],
            log_likelihood: 0.0,
        }
    }

    fn add_frame(
        &self,
        alignment: &mut Alignment,
        state: usize,
        frames: &[f64],
        frame: usize,
        weight: f64,
    ) {
        let row = &frames[frame * OBSERVATION_COUNT..(frame + 1) * OBSERVATION_COUNT];
        for (stats, range) in alignment.frames[state].iter_mut().zip(&self.ranges) {
            stats.add(&row[range.clone()], weight);
        }
    }

    fn add_duration(&self, alignment: &mut Alignment, state: usize, frames: usize, weight: f64) {
        let value = (frames as f64 - self.duration_centre) / self.duration_deviation;
        alignment.durations[state].add(&[value], weight);
        alignment.histograms[state][frames - 1] += weight;
    }

    /// T × [`STATES`] log densities of the frames under their mapped Gaussians.
    fn log_emissions(&self, frames: &[f64]) -> Vec<f64> {
        let log_dets: Vec<f64> = self
            .classes
            .iter()
            .map(|class| {
                class
                    .blocks
                    .iter()
                    .map(LinearTransform::log_determinant)
                    .sum()
            })
            .collect();
        let mut out = vec![0.0; frames.len() / OBSERVATION_COUNT * STATES];
        let mut mapped = vec![0.0; OBSERVATION_COUNT];
        for (row, out) in frames
            .chunks_exact(OBSERVATION_COUNT)
            .zip(out.chunks_exact_mut(STATES))
        {
            for (class, log_det) in self.classes.iter().zip(&log_dets) {
                for (transform, range) in class.blocks.iter().zip(&self.ranges) {
                    transform.apply(&row[range.clone()], &mut mapped[range.clone()]);
                }
                for state in &class.members {
                    out[*state] =
                        self.gaussians[*state].log_density(&mapped) + log_det - self.log_unit;
                }
            }
        }
        out
    }
}
