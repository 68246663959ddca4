//! Explicit-duration hidden semi-Markov inference on a left-to-right chain of segments.
//!
//! A whole sequence of T frames is explained by K segments in a given order (the states of its
//! steps, one after the other, no skips), so the only unknowns are the K - 1 inner boundaries. A
//! segment that covers frames a..b costs the log probability of its duration b - a plus the sum of
//! its emission log densities, which running sums make O(1). Model: S.-Z. Yu, "Hidden semi-Markov
//! models" (2010); in the paper, section 5.1.1 and figure 3.
//!
//! Everything is in the log domain and only reachable boundaries are visited.

mod messages;
mod posterior;
mod stats;
mod viterbi;

pub use posterior::{HsmmPosterior, SegmentPosterior, hsmm_forward_backward};
pub use stats::HsmmStats;
pub use viterbi::{HsmmPath, hsmm_viterbi};

use crate::duration::DurationDist;
use crate::error::{ProbError, check_finite, check_len};

/// One segment of a chain: which emission and which duration distribution it uses. Segments may share both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChainState {
    /// Column of the log-emission matrix.
    pub emission: usize,
    /// Index into the duration distributions.
    pub duration: usize,
}

/// End of a recording: at the end of a segment, or within one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edge {
    /// The outermost segment is seen whole on this side.
    #[default]
    Complete,
    /// The outermost segment goes on outside the recording: its duration is only bounded from below.
    Censored,
}

/// Knowledge about the two ends of the recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Boundary {
    /// The start, where [`Edge::Censored`] means that the first segment was already running, since
    /// a time that does not depend on the motion ([`DurationDist::log_residual`]).
    pub start: Edge,
    /// The end, where [`Edge::Censored`] means that the last segment goes on
    /// ([`DurationDist::log_survival`]).
    pub end: Edge,
}

/// A checked problem: slices that fit each other, with running sums of the emissions.
struct Problem<'a> {
    chain: &'a [ChainState],
    durations: &'a [DurationDist],
    boundary: Boundary,
    n_frames: usize,
    /// (T + 1) x E: sum over frames before t of (log emission - best log emission of the frame).
    /// Taking the best away keeps the sums small, so that differences stay exact at T = 10 000.
    cumulative: Vec<f64>,
    n_emissions: usize,
    /// Σ over frames of the best log emission: what was taken away.
    log_scale: f64,
    /// For boundary j (between segments j - 1 and j), the reachable frames, both ends included.
    reach: Vec<(usize, usize)>,
}

impl<'a> Problem<'a> {
    fn new(
        log_emissions: &[f64],
        n_emissions: usize,
        chain: &'a [ChainState],
        durations: &'a [DurationDist],
        boundary: Boundary,
    ) -> Result<Self, ProbError> {
        if chain.is_empty() {
            return Err(ProbError::Empty { what: "chain" });
        }
        if n_emissions == 0 {
            return Err(ProbError::Empty {
                what: "emission columns",
            });
        }
        let n_frames = log_emissions.len() / n_emissions;
        check_len("log_emissions", log_emissions.len(), n_frames * n_emissions)?;
        check_finite("log_emissions", log_emissions)?;
        for (index, state) in chain.iter().enumerate() {
            if state.emission >= n_emissions {
                return Err(ProbError::IndexOutOfRange {
                    what: "chain emission",
                    index,
                    value: state.emission,
                    len: n_emissions,
                });
            }
            if state.duration >= durations.len() {
                return Err(ProbError::IndexOutOfRange {
                    what: "chain duration",
                    index,
                    value: state.duration,
                    len: durations.len(),
                });
            }
        }
        if n_frames < chain.len() {
            return Err(ProbError::SequenceTooShort {
                frames: n_frames,
                segments: chain.len(),
            });
        }
        let longest = chain
            .iter()
            .map(|s| durations[s.duration].max_duration())
            .sum();
        if n_frames > longest {
            return Err(ProbError::SequenceTooLong {
                frames: n_frames,
                longest,
            });
        }
        let (cumulative, log_scale) = running_sums(log_emissions, n_emissions);
        let reach = reachable_boundaries(n_frames, chain, durations);
        Ok(Self {
            chain,
            durations,
            boundary,
            n_frames,
            cumulative,
            n_emissions,
            log_scale,
            reach,
        })
    }

    /// Running emission sum of segment `k` before frame `t`.
    fn emitted(&self, k: usize, t: usize) -> f64 {
        self.cumulative[t * self.n_emissions + self.chain[k].emission]
    }

    fn is_start_censored(&self, k: usize) -> bool {
        k == 0 && self.boundary.start == Edge::Censored
    }

    fn is_end_censored(&self, k: usize) -> bool {
        k + 1 == self.chain.len() && self.boundary.end == Edge::Censored
    }

    /// Boundary of segment `k`: only the outermost ones can be cut off.
    fn seen(&self, k: usize) -> Boundary {
        Boundary {
            start: if self.is_start_censored(k) {
                Edge::Censored
            } else {
                Edge::Complete
            },
            end: if self.is_end_censored(k) {
                Edge::Censored
            } else {
                Edge::Complete
            },
        }
    }

    /// Log weight of seeing 1, 2, ... frames of segment `k`.
    fn log_durations(&self, k: usize) -> &[f64] {
        self.durations[self.chain[k].duration].observed_log_table(self.seen(k))
    }
}

fn running_sums(log_emissions: &[f64], n_emissions: usize) -> (Vec<f64>, f64) {
    let mut cumulative = Vec::with_capacity(log_emissions.len() + n_emissions);
    cumulative.resize(n_emissions, 0.0);
    let mut log_scale = 0.0;
    for (t, frame) in log_emissions.chunks_exact(n_emissions).enumerate() {
        let best = frame.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        log_scale += best;
        for (e, log_emission) in frame.iter().enumerate() {
            cumulative.push(cumulative[t * n_emissions + e] + (log_emission - best));
        }
    }
    (cumulative, log_scale)
}

/// Frames at which each boundary can lie: segments before it take at least one frame and at most
/// their longest, and so do those after it.
fn reachable_boundaries(
    n_frames: usize,
    chain: &[ChainState],
    durations: &[DurationDist],
) -> Vec<(usize, usize)> {
    let n_segments = chain.len();
    let longest = |k: usize| durations[chain[k].duration].max_duration();
    let mut reach = Vec::with_capacity(n_segments + 1);
    let mut longest_before = 0;
    for j in 0..=n_segments {
        reach.push((j, longest_before.min(n_frames - (n_segments - j))));
        if j < n_segments {
            longest_before += longest(j);
        }
    }
    let mut longest_after = 0;
    for j in (0..=n_segments).rev() {
        reach[j].0 = reach[j].0.max(n_frames.saturating_sub(longest_after));
        if j > 0 {
            longest_after += longest(j - 1);
        }
    }
    reach
}
