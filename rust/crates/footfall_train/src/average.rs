//! The average walk: expectation-maximisation over whole walks.
//!
//! Step boundaries only initialise the states; after that every walk is one chain of states whose boundaries are
//! re-estimated by explicit-duration forward-backward (Tilmanne et al. 2012, sections 5.1.1 and 5.1.2).

use crate::error::TrainError;
use crate::progress::{Progress, advance};
use crate::sequence::{LabelledStep, Sequence, step_lengths};
use crate::step_hsmm::{DURATION_VARIANCE_FLOOR, STATES, StepHsmm, chain, cut_steps, state_index};
use footfall_core::Side;
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP, StateModel};
use footfall_prob::duration::GaussianDuration;
use footfall_prob::gaussian::{DiagonalGaussian, GaussianStats};
use footfall_prob::hsmm::HsmmStats;

/// Least variance of a feature in a state, as a fraction of its variance over the whole corpus.
const VARIANCE_FLOOR: f64 = 1e-3;

/// Least variance of a feature, for those that never change.
const ABSOLUTE_VARIANCE_FLOOR: f64 = 1e-8;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmConfig {
    /// At most this many iterations.
    pub max_iterations: usize,
    /// Stop when an iteration gains less than this much log-likelihood a frame.
    pub min_gain_per_frame: f64,
}

/// Both step models as the trainer holds them, and how training went.
#[derive(Clone, Debug)]
pub struct AverageWalk {
    hsmm: StepHsmm,
    /// Total log-likelihood of the corpus before each M-step; never falls.
    pub log_likelihoods: Vec<f64>,
}

impl AverageWalk {
    /// Trains on a corpus.
    ///
    /// # Errors
    /// [`TrainError`] when the corpus lacks left or right steps, or a sequence cannot be explained.
    pub fn train(
        corpus: &[Sequence],
        config: &EmConfig,
        progress: &mut dyn Progress,
    ) -> Result<Self, TrainError> {
        let floor = variance_floor(corpus);
        let longest = step_lengths(corpus).max().ok_or(TrainError::NoSteps)?;
        let walk = Self {
            hsmm: StepHsmm::estimate(&even_split(corpus)?, longest, &floor)?,
            log_likelihoods: Vec::new(),
        };
        walk.refine(corpus, config, progress)
    }

    /// Trains on, from here; the log-likelihoods begin anew.
    ///
    /// # Errors
    /// As [`train`](Self::train).
    pub fn refine(
        self,
        corpus: &[Sequence],
        config: &EmConfig,
        progress: &mut dyn Progress,
    ) -> Result<Self, TrainError> {
        let floor = variance_floor(corpus);
        let mut walk = Self {
            log_likelihoods: Vec::new(),
            ..self
        };
        for iteration in 0..config.max_iterations {
            advance(progress, "training", iteration, config.max_iterations)?;
            let stats = walk.expect(corpus, corpus)?;
            let gain = walk
                .log_likelihoods
                .last()
                .map(|previous| (stats.log_likelihood - previous) / stats.n_frames as f64);
            progress.fit(stats.log_likelihood);
            walk.log_likelihoods.push(stats.log_likelihood);
            walk.hsmm = StepHsmm::estimate(&stats, walk.hsmm.max_duration, &floor)?;
            if gain.is_some_and(|gain| gain < config.min_gain_per_frame) {
                break;
            }
        }
        advance(
            progress,
            "training",
            config.max_iterations,
            config.max_iterations,
        )?;
        Ok(walk)
    }

    /// The states of one step, as the model stores them.
    ///
    /// # Errors
    /// [`TrainError::Inference`] when a duration is undetermined, which a trained walk excludes.
    pub fn states(&self, side: Side) -> Result<Vec<StateModel>, TrainError> {
        (0..STATES_PER_STEP)
            .map(|state| {
                let index = state_index(side, state);
                // A Gaussian that is cut off at one frame has another mean than its centre.
                let duration = self.hsmm.durations[index].discretise(self.hsmm.max_duration)?;
                let gaussian = &self.hsmm.gaussians[index];
                Ok(StateModel {
                    mean: gaussian.mean().to_vec(),
                    variance: gaussian.variance().to_vec(),
                    duration_mean: duration.mean(),
                    duration_variance: duration.variance().max(DURATION_VARIANCE_FLOOR),
                })
            })
            .collect()
    }

    /// The most probable boundaries between a sequence's states: [`STATES_PER_STEP`] a step, plus the end.
    ///
    /// # Errors
    /// [`TrainError::Inference`] when the sequence cannot be explained.
    pub fn align(&self, sequence: &Sequence) -> Result<Vec<usize>, TrainError> {
        let durations = self.hsmm.discretised()?;
        let chain = |step: &LabelledStep| chain(core::slice::from_ref(step));
        cut_steps(sequence, &self.hsmm.gaussians, &durations, chain)
    }

    /// The longest duration of a state, frames.
    pub(crate) fn max_duration(&self) -> usize {
        self.hsmm.max_duration
    }

    /// The duration of every state, the left step's first.
    pub(crate) fn durations(&self) -> &[GaussianDuration] {
        &self.hsmm.durations
    }

    /// The Gaussian of every state, the left step's first.
    pub(crate) fn gaussians(&self) -> &[DiagonalGaussian] {
        &self.hsmm.gaussians
    }

    /// Statistics of the `seen` sequences at the states found in `aligned` ones, which are the same walks frame by frame.
    pub(crate) fn expect(
        &self,
        aligned: &[Sequence],
        seen: &[Sequence],
    ) -> Result<HsmmStats, TrainError> {
        self.hsmm.expect(aligned, seen)
    }
}

/// Statistics of the corpus with every step cut into states of equal length.
fn even_split(corpus: &[Sequence]) -> Result<HsmmStats, TrainError> {
    let mut stats = HsmmStats::new(STATES, OBSERVATION_COUNT, STATES);
    for sequence in corpus {
        let rows: Vec<&[f64]> = sequence
            .observations
            .chunks_exact(OBSERVATION_COUNT)
            .collect();
        for step in &sequence.steps {
            let cut = |state: usize| step.first + step.frames() * state / STATES_PER_STEP;
            for state in 0..STATES_PER_STEP {
                let index = state_index(step.side, state);
                let frames = cut(state)..cut(state + 1);
                if frames.is_empty() {
                    return Err(TrainError::StepTooShort {
                        frames: step.frames(),
                    });
                }
                stats.durations[index].add(frames.len(), 1.0);
                for frame in frames {
                    stats.emissions[index].add(rows[frame], 1.0);
                }
            }
        }
    }
    for side in Side::BOTH {
        if stats.emissions[state_index(side, 0)].weight() <= 0.0 {
            return Err(TrainError::MissingSide { side });
        }
    }
    Ok(stats)
}

pub(crate) fn variance_floor(corpus: &[Sequence]) -> Vec<f64> {
    let mut moments = GaussianStats::new(OBSERVATION_COUNT);
    for sequence in corpus {
        for observation in sequence.observations.chunks_exact(OBSERVATION_COUNT) {
            moments.add(observation, 1.0);
        }
    }
    moments
        .variance()
        .iter()
        .map(|variance| (VARIANCE_FLOOR * variance).max(ABSOLUTE_VARIANCE_FLOOR))
        .collect()
}
