//! Posterior of states and durations given the whole sequence.

use std::ops::Range;

use super::messages::{Messages, NEGLIGIBLE};
use super::{Boundary, ChainState, Problem};
use crate::duration::DurationDist;
use crate::error::ProbError;

/// Posterior of one segment of the chain, given the whole sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentPosterior {
    /// First frame of `state_probs`; outside its range the segment has no probability.
    pub first_frame: usize,
    /// P(frame lies in this segment | all frames), one value per frame from `first_frame` on.
    pub state_probs: Vec<f64>,
    /// P(whole duration = d | all frames) at d - 1; sums to one. For a censored segment this is the
    /// duration that it would have if it were seen whole.
    pub duration_probs: Vec<f64>,
    /// The segment was already running at the start, so its duration was drawn with probability
    /// proportional to its length ([`DurationStats::add_length_biased`](crate::duration::DurationStats::add_length_biased)).
    pub length_biased: bool,
}

impl SegmentPosterior {
    /// The frames that `state_probs` covers.
    pub fn frames(&self) -> Range<usize> {
        self.first_frame..self.first_frame + self.state_probs.len()
    }
}

/// Result of [`hsmm_forward_backward`].
#[derive(Debug, Clone, PartialEq)]
pub struct HsmmPosterior {
    /// ln p(frames | chain): the sum over all segmentations.
    pub log_likelihood: f64,
    /// Number of frames T.
    pub n_frames: usize,
    /// One per segment of the chain. Over the segments, the state probabilities of a frame sum to one.
    pub segments: Vec<SegmentPosterior>,
}

impl HsmmPosterior {
    /// P(`frame` lies in chain segment `segment` | all frames); zero outside.
    pub fn state_prob(&self, frame: usize, segment: usize) -> f64 {
        self.segments
            .get(segment)
            .and_then(|s| s.state_probs.get(frame.checked_sub(s.first_frame)?))
            .copied()
            .unwrap_or(0.0)
    }
}

/// Forward-backward over all segmentations of the sequence into the chain.
///
/// - `log_emissions`: T x `n_emissions`, row-major, finite log densities
///   ([`log_densities`](crate::gaussian::log_densities)).
/// - `chain`: K segments in order. T must lie between K and the sum of the longest durations.
/// - `boundary`: which outermost segments are cut off by the recording.
///
/// Time is O(Σ reachable boundaries x durations), memory O(Σ reachable boundaries).
///
/// ```
/// use footfall_prob::duration::GaussianDuration;
/// use footfall_prob::hsmm::{Boundary, ChainState, hsmm_forward_backward};
///
/// // Two states, one emission column each; the third frame clearly belongs to the second.
/// let log_emissions = [0.0, -9.0, 0.0, -9.0, -9.0, 0.0];
/// let durations = [GaussianDuration { mean: 1.5, variance: 1.0 }.discretise(4)?];
/// let chain = [ChainState { emission: 0, duration: 0 }, ChainState { emission: 1, duration: 0 }];
/// let posterior = hsmm_forward_backward(&log_emissions, 2, &chain, &durations, Boundary::default())?;
/// assert!(posterior.state_prob(1, 0) > 0.99 && posterior.state_prob(2, 1) > 0.99);
/// # Ok::<(), footfall_prob::ProbError>(())
/// ```
///
/// # Errors
/// [`ProbError`] when shapes or indices do not fit, an emission is not finite, the sequence is too
/// short or too long for the chain, or no segmentation has a probability.
pub fn hsmm_forward_backward(
    log_emissions: &[f64],
    n_emissions: usize,
    chain: &[ChainState],
    durations: &[DurationDist],
    boundary: Boundary,
) -> Result<HsmmPosterior, ProbError> {
    let problem = Problem::new(log_emissions, n_emissions, chain, durations, boundary)?;
    let messages = Messages::new(&problem)?;
    let segments = (0..chain.len())
        .map(|k| {
            let (first_frame, state_probs) = state_probs(&problem, &messages, k);
            let observed = observed_durations(&problem, &messages, k);
            let length_biased = problem.is_start_censored(k);
            let duration_probs = if length_biased || problem.is_end_censored(k) {
                whole_durations(&problem, k, &observed)
            } else {
                observed
            };
            SegmentPosterior {
                first_frame,
                state_probs,
                duration_probs,
                length_biased,
            }
        })
        .collect();
    Ok(HsmmPosterior {
        log_likelihood: messages.log_likelihood + problem.log_scale,
        n_frames: problem.n_frames,
        segments,
    })
}

/// P(boundary j at each of its reachable frames), normalised: rounding at T = 10 000 goes away.
fn boundary_probs(messages: &Messages, j: usize) -> Vec<f64> {
    let prob = |(forward, backward): (&f64, &f64)| {
        let log_prob = forward + backward - messages.log_likelihood;
        // Underflowing exponentials are slow, and add nothing.
        if log_prob > -NEGLIGIBLE {
            log_prob.exp()
        } else {
            0.0
        }
    };
    let mut probs: Vec<f64> = messages.forward[j]
        .iter()
        .zip(&messages.backward[j])
        .map(prob)
        .collect();
    let total: f64 = probs.iter().sum();
    for p in &mut probs {
        *p /= total;
    }
    probs
}

/// A frame lies in segment k when boundary k is at or before it and boundary k + 1 after it.
fn state_probs(problem: &Problem<'_>, messages: &Messages, k: usize) -> (usize, Vec<f64>) {
    let (start_low, _) = problem.reach[k];
    let (end_low, end_high) = problem.reach[k + 1];
    let starts = boundary_probs(messages, k);
    let ends = boundary_probs(messages, k + 1);
    let mut started = 0.0;
    let mut ended = 0.0;
    let mut probs: Vec<f64> = (start_low..end_high)
        .map(|t| {
            started += starts.get(t - start_low).copied().unwrap_or(0.0);
            ended += t
                .checked_sub(end_low)
                .and_then(|i| ends.get(i))
                .copied()
                .unwrap_or(0.0);
            let p: f64 = started - ended;
            // What is left of a difference of near-equal sums is rounding, not probability.
            if p < 1e-14 { 0.0 } else { p.min(1.0) }
        })
        .collect();
    let leading = probs.iter().take_while(|p| **p <= 0.0).count();
    let trailing = probs[leading..]
        .iter()
        .rev()
        .take_while(|p| **p <= 0.0)
        .count();
    probs.truncate(probs.len() - trailing);
    probs.drain(..leading);
    (start_low + leading, probs)
}

/// P(d frames of segment k are seen), normalised.
fn observed_durations(problem: &Problem<'_>, messages: &Messages, k: usize) -> Vec<f64> {
    let table = problem.log_durations(k);
    let (start_low, _) = problem.reach[k];
    let (end_low, end_high) = problem.reach[k + 1];
    let mut probs = vec![0.0; table.len()];
    for (i, (forward, backward)) in messages.forward[k]
        .iter()
        .zip(&messages.backward[k])
        .enumerate()
    {
        if forward + backward - messages.log_likelihood < -NEGLIGIBLE {
            continue;
        }
        let start = start_low + i;
        let base = forward - problem.emitted(k, start) - messages.log_likelihood;
        for end in end_low.max(start + 1)..=end_high.min(start + table.len()) {
            let duration = end - start;
            let log_prob = base
                + problem.emitted(k, end)
                + table[duration - 1]
                + messages.backward[k + 1][end - end_low];
            if log_prob > -NEGLIGIBLE {
                probs[duration - 1] += log_prob.exp();
            }
        }
    }
    normalise(&mut probs);
    probs
}

/// From seen to whole durations of a censored segment: the sum over n of P(n seen) P(D = d | n seen).
fn whole_durations(problem: &Problem<'_>, k: usize, observed: &[f64]) -> Vec<f64> {
    let dist = &problem.durations[problem.chain[k].duration];
    let max = observed.len();
    let both = problem.is_start_censored(k) && problem.is_end_censored(k);
    let mut whole = vec![0.0; max];
    for (seen, p) in (1..).zip(observed) {
        if *p <= 0.0 {
            continue;
        }
        // Cut on one side, D ≥ n is all that is known; cut on both, a segment of D frames can show
        // n of them in D - n + 1 places.
        let log_weights: Vec<f64> = (seen..=max)
            .map(|d| {
                dist.log_pmf(d)
                    + if both {
                        ((d - seen + 1) as f64).ln()
                    } else {
                        0.0
                    }
            })
            .collect();
        let log_total = crate::duration::log_sum_exp(&log_weights);
        for (d, w) in (seen..=max).zip(&log_weights) {
            whole[d - 1] += p * (w - log_total).exp();
        }
    }
    normalise(&mut whole);
    whole
}

fn normalise(probs: &mut [f64]) {
    let total: f64 = probs.iter().sum();
    if total > 0.0 {
        for p in probs {
            *p /= total;
        }
    }
}
