//! Sufficient statistics for the M-step, gathered from posteriors.

use super::{ChainState, HsmmPosterior};
use crate::duration::DurationStats;
use crate::error::{ProbError, check_len};
use crate::gaussian::GaussianStats;

/// Expected sufficient statistics over any number of sequences.
///
/// Fill one per worker and [`merge`](Self::merge) them in a fixed order, so that results do not
/// depend on scheduling.
#[derive(Debug, Clone, PartialEq)]
pub struct HsmmStats {
    /// Per emission column, moments of the frames weighted by their state probabilities.
    pub emissions: Vec<GaussianStats>,
    /// Per duration distribution, the expected durations.
    pub durations: Vec<DurationStats>,
    /// Σ log likelihood of the sequences: EM must not let it fall.
    pub log_likelihood: f64,
    /// Frames seen.
    pub n_frames: usize,
}

impl HsmmStats {
    /// Empty statistics for `n_emissions` Gaussians over `dim` dimensions and `n_durations` durations.
    pub fn new(n_emissions: usize, dim: usize, n_durations: usize) -> Self {
        Self {
            emissions: vec![GaussianStats::new(dim); n_emissions],
            durations: vec![DurationStats::new(); n_durations],
            log_likelihood: 0.0,
            n_frames: 0,
        }
    }

    /// Adds a sequence: its `posterior` for `chain`, and its `observations` (T x D, row-major).
    ///
    /// # Errors
    /// [`ProbError`] when the arguments do not fit each other or these statistics; then nothing was added.
    pub fn add(
        &mut self,
        chain: &[ChainState],
        posterior: &HsmmPosterior,
        observations: &[f64],
    ) -> Result<(), ProbError> {
        let dim = self
            .emissions
            .first()
            .ok_or(ProbError::Empty { what: "emissions" })?
            .dim();
        check_len("posterior segments", posterior.segments.len(), chain.len())?;
        check_len("observations", observations.len(), posterior.n_frames * dim)?;
        for (index, state) in chain.iter().enumerate() {
            let tables = [
                ("chain emission", state.emission, self.emissions.len()),
                ("chain duration", state.duration, self.durations.len()),
            ];
            for (what, value, len) in tables {
                if value >= len {
                    return Err(ProbError::IndexOutOfRange {
                        what,
                        index,
                        value,
                        len,
                    });
                }
            }
        }
        for (state, segment) in chain.iter().zip(&posterior.segments) {
            let emission = &mut self.emissions[state.emission];
            let frames = segment.frames();
            let observed = observations[frames.start * dim..frames.end * dim].chunks_exact(dim);
            for (frame, weight) in observed.zip(&segment.state_probs) {
                emission.add(frame, *weight);
            }
            let duration = &mut self.durations[state.duration];
            for (d, weight) in (1..).zip(&segment.duration_probs) {
                if segment.length_biased {
                    duration.add_length_biased(d, *weight);
                } else {
                    duration.add(d, *weight);
                }
            }
        }
        self.log_likelihood += posterior.log_likelihood;
        self.n_frames += posterior.n_frames;
        Ok(())
    }

    /// Adds what `other` has seen.
    pub fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.emissions.iter_mut().zip(&other.emissions) {
            mine.merge(theirs);
        }
        for (mine, theirs) in self.durations.iter_mut().zip(&other.durations) {
            mine.merge(theirs);
        }
        self.log_likelihood += other.log_likelihood;
        self.n_frames += other.n_frames;
    }
}
