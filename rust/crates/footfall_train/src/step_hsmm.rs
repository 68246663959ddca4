//! The hidden semi-Markov model of a left and a right step, for averages and for styles alike.

use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use footfall_core::Side;
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::gaussian::{DiagonalGaussian, log_densities};
use footfall_prob::hsmm::{
    Boundary, ChainState, HsmmPosterior, HsmmStats, hsmm_forward_backward, hsmm_viterbi,
};
use rayon::prelude::*;

/// States of both steps together.
pub(crate) const STATES: usize = 2 * STATES_PER_STEP;

/// Least variance of a state's duration, frames².
pub(crate) const DURATION_VARIANCE_FLOOR: f64 = 0.25;

/// Output and duration of every state, the left step's first.
#[derive(Clone, Debug)]
pub(crate) struct StepHsmm {
    pub(crate) gaussians: Vec<DiagonalGaussian>,
    /// Gaussians that are cut off at one frame, whose centres are not their means.
    pub(crate) durations: Vec<GaussianDuration>,
    /// Frames that a state lasts at most.
    pub(crate) max_duration: usize,
}

impl StepHsmm {
    /// The M-step: the most probable states by statistics, no output narrower than `floor`.
    pub(crate) fn estimate(
        stats: &HsmmStats,
        max_duration: usize,
        floor: &[f64],
    ) -> Result<Self, TrainError> {
        let outputs = stats.emissions.iter();
        let durations = stats.durations.iter();
        Ok(Self {
            gaussians: outputs
                .map(|moments| moments.estimate(floor))
                .collect::<Result<_, _>>()?,
            durations: durations
                .map(|moments| moments.estimate(max_duration, DURATION_VARIANCE_FLOOR))
                .collect::<Result<_, _>>()?,
            max_duration,
        })
    }

    /// The E-step, in parallel: where `aligned` sequences say that the states are, and what `seen` sequences, frame by frame the same
    /// walks, show there.
    pub(crate) fn expect(
        &self,
        aligned: &[Sequence],
        seen: &[Sequence],
    ) -> Result<HsmmStats, TrainError> {
        let durations = self.discretised()?;
        let parts: Vec<HsmmStats> = aligned
            .par_iter()
            .zip(seen)
            .map(|(aligned, seen)| {
                let mut stats = empty_stats();
                self.add(aligned, seen, &durations, &mut stats)?;
                Ok(stats)
            })
            .collect::<Result<_, TrainError>>()?;
        let mut stats = empty_stats();
        for part in &parts {
            stats.merge(part);
        }
        Ok(stats)
    }

    /// The E-step over few sequences: sums run on from one to the next.
    pub(crate) fn expect_in_order(&self, corpus: &[Sequence]) -> Result<HsmmStats, TrainError> {
        let durations = self.discretised()?;
        let mut stats = empty_stats();
        for sequence in corpus {
            self.add(sequence, sequence, &durations, &mut stats)?;
        }
        Ok(stats)
    }

    /// Adds what `seen` shows in the states of a sequence, cut step by step as by [`cut_steps`].
    fn add(
        &self,
        sequence: &Sequence,
        seen: &Sequence,
        durations: &[DurationDist],
        stats: &mut HsmmStats,
    ) -> Result<(), TrainError> {
        let mut log_emissions = Vec::new();
        for step in &sequence.steps {
            log_densities(&self.gaussians, sequence.rows_of(step), &mut log_emissions)?;
            let (chain, posterior) =
                posterior(&log_emissions, core::slice::from_ref(step), durations)?;
            stats.add(&chain, &posterior, seen.rows_of(step))?;
        }
        Ok(())
    }

    /// Probabilities of the durations in whole frames.
    pub(crate) fn discretised(&self) -> Result<Vec<DurationDist>, TrainError> {
        discretised(&self.durations, self.max_duration)
    }
}

fn empty_stats() -> HsmmStats {
    HsmmStats::new(STATES, OBSERVATION_COUNT, STATES)
}

/// Probabilities of durations in whole frames, `longest` at most.
pub(crate) fn discretised(
    durations: &[GaussianDuration],
    longest: usize,
) -> Result<Vec<DurationDist>, TrainError> {
    let discretise = |duration: &GaussianDuration| duration.discretise(longest);
    Ok(durations.iter().map(discretise).collect::<Result<_, _>>()?)
}

/// Index of a state among those of both steps.
pub(crate) fn state_index(side: Side, state: usize) -> usize {
    side.index() * STATES_PER_STEP + state
}

/// The states of a walk in a row.
pub(crate) fn chain(steps: &[LabelledStep]) -> Vec<ChainState> {
    steps
        .iter()
        .flat_map(|step| (0..STATES_PER_STEP).map(|state| state_index(step.side, state)))
        .map(|index| ChainState {
            emission: index,
            duration: index,
        })
        .collect()
}

/// Posterior of the [`chain`] of steps, from T × [`STATES`] log densities of their frames.
pub(crate) fn posterior(
    log_emissions: &[f64],
    steps: &[LabelledStep],
    durations: &[DurationDist],
) -> Result<(Vec<ChainState>, HsmmPosterior), TrainError> {
    let chain = chain(steps);
    let boundary = Boundary::default();
    let posterior = hsmm_forward_backward(log_emissions, STATES, &chain, durations, boundary)?;
    Ok((chain, posterior))
}

/// The most probable boundaries between the states of a sequence's steps, plus the end.
///
/// Step by step, not the whole walk: free boundaries between steps settle a few frames off the initial contacts, where the likelihood is
/// best, and the generator puts a foot down where its step begins.
pub(crate) fn cut_steps(
    sequence: &Sequence,
    gaussians: &[DiagonalGaussian],
    durations: &[DurationDist],
    chain: impl Fn(&LabelledStep) -> Vec<ChainState>,
) -> Result<Vec<usize>, TrainError> {
    let mut log_emissions = Vec::new();
    let mut boundaries = vec![0];
    for step in &sequence.steps {
        log_densities(gaussians, sequence.rows_of(step), &mut log_emissions)?;
        let path = hsmm_viterbi(
            &log_emissions,
            gaussians.len(),
            &chain(step),
            durations,
            Boundary::default(),
        )?;
        boundaries.pop();
        boundaries.extend(path.boundaries.iter().map(|frame| step.first + frame));
    }
    Ok(boundaries)
}
