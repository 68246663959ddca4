//! The single most probable segmentation.

use super::{Boundary, ChainState, Problem};
use crate::duration::DurationDist;
use crate::error::ProbError;

/// The most probable segmentation.
#[derive(Debug, Clone, PartialEq)]
pub struct HsmmPath {
    /// K + 1 frames: segment k covers frames `boundaries[k]..boundaries[k + 1]`.
    pub boundaries: Vec<usize>,
    /// ln p(frames, boundaries | chain).
    pub log_probability: f64,
}

/// Finds the segmentation with the highest joint probability (the earliest boundaries among equals).
/// Arguments as in [`hsmm_forward_backward`](super::hsmm_forward_backward).
///
/// # Errors
/// As [`hsmm_forward_backward`](super::hsmm_forward_backward).
pub fn hsmm_viterbi(
    log_emissions: &[f64],
    n_emissions: usize,
    chain: &[ChainState],
    durations: &[DurationDist],
    boundary: Boundary,
) -> Result<HsmmPath, ProbError> {
    let problem = Problem::new(log_emissions, n_emissions, chain, durations, boundary)?;
    let n_segments = chain.len();
    let mut best = vec![0.0];
    // best_start[k][end - low]: where segment k starts if it ends at `end`.
    let mut best_start: Vec<Vec<usize>> = Vec::with_capacity(n_segments);
    for k in 0..n_segments {
        let (from_low, from_high) = problem.reach[k];
        let (to_low, to_high) = problem.reach[k + 1];
        let table = problem.log_durations(k);
        let source: Vec<f64> = (from_low..=from_high)
            .zip(&best)
            .map(|(s, b)| b - problem.emitted(k, s))
            .collect();
        let mut next = Vec::with_capacity(to_high - to_low + 1);
        let mut starts = Vec::with_capacity(to_high - to_low + 1);
        for end in to_low..=to_high {
            let mut top = (f64::NEG_INFINITY, from_low);
            for start in from_low.max(end.saturating_sub(table.len()))..=from_high.min(end - 1) {
                let score = source[start - from_low] + table[end - start - 1];
                if score > top.0 {
                    top = (score, start);
                }
            }
            next.push(top.0 + problem.emitted(k, end));
            starts.push(top.1);
        }
        best = next;
        best_start.push(starts);
    }
    if best[0] == f64::NEG_INFINITY {
        return Err(ProbError::NoSegmentation {
            frames: problem.n_frames,
        });
    }
    let mut boundaries = vec![problem.n_frames; n_segments + 1];
    for k in (0..n_segments).rev() {
        boundaries[k] = best_start[k][boundaries[k + 1] - problem.reach[k + 1].0];
    }
    Ok(HsmmPath {
        boundaries,
        log_probability: best[0] + problem.log_scale,
    })
}
