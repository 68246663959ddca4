//! Forward and backward messages over boundaries.

use multiversion::multiversion;

use super::Problem;
use crate::error::ProbError;

/// Log messages per boundary over its reachable frames.
pub(super) struct Messages {
    /// `forward[j][t - reach[j].0]`: log probability of the frames before t and of boundary j at t.
    pub(super) forward: Vec<Vec<f64>>,
    /// `backward[j][t - reach[j].0]`: log probability of the frames from t on given boundary j at t.
    pub(super) backward: Vec<Vec<f64>>,
    /// Log likelihood, relative to the problem's `log_scale`.
    pub(super) log_likelihood: f64,
}

/// Terms this far below the largest cannot change a sum of f64 of any length used here.
pub(super) const NEGLIGIBLE: f64 = 45.0;

impl Messages {
    pub(super) fn new(problem: &Problem<'_>) -> Result<Self, ProbError> {
        let n_segments = problem.chain.len();
        let mut scratch = Scratch::default();
        let mut forward = Vec::with_capacity(n_segments + 1);
        forward.push(vec![0.0]);
        for k in 0..n_segments {
            let next = forward_through(problem, k, &forward[k], &mut scratch);
            forward.push(next);
        }
        let log_likelihood = forward[n_segments][0];
        if log_likelihood == f64::NEG_INFINITY {
            return Err(ProbError::NoSegmentation {
                frames: problem.n_frames,
            });
        }
        let mut backward = vec![Vec::new(); n_segments + 1];
        backward[n_segments] = vec![0.0];
        for k in (0..n_segments).rev() {
            backward[k] = backward_through(problem, k, &backward[k + 1], &mut scratch);
        }
        Ok(Self {
            forward,
            backward,
            log_likelihood,
        })
    }
}

/// Buffers that are reused from segment to segment.
#[derive(Default)]
struct Scratch {
    source: Vec<f64>,
    kernel: Vec<f64>,
    terms: Vec<f64>,
}

/// Boundary k to boundary k + 1: out(t) = c(t) + ln Σ exp(before(s) - c(s) + duration(t - s)).
fn forward_through(
    problem: &Problem<'_>,
    k: usize,
    before: &[f64],
    scratch: &mut Scratch,
) -> Vec<f64> {
    let (from_low, from_high) = problem.reach[k];
    let (to_low, to_high) = problem.reach[k + 1];
    let Scratch {
        source,
        kernel,
        terms,
    } = scratch;
    source.clear();
    source.extend(
        (from_low..=from_high)
            .zip(before)
            .map(|(s, b)| b - problem.emitted(k, s)),
    );
    // Durations backwards, so that both operands run upwards in s.
    kernel.clear();
    kernel.extend(problem.log_durations(k).iter().rev());
    let max_duration = kernel.len();
    (to_low..=to_high)
        .map(|t| {
            let low = from_low.max(t.saturating_sub(max_duration));
            let high = from_high.min(t - 1);
            if low > high {
                return f64::NEG_INFINITY;
            }
            let durations = &kernel[low + max_duration - t..];
            problem.emitted(k, t)
                + log_dot(&source[low - from_low..=high - from_low], durations, terms)
        })
        .collect()
}

/// Boundary k + 1 to boundary k: out(s) = -c(s) + ln Σ exp(after(t) + c(t) + duration(t - s)).
fn backward_through(
    problem: &Problem<'_>,
    k: usize,
    after: &[f64],
    scratch: &mut Scratch,
) -> Vec<f64> {
    let (from_low, from_high) = problem.reach[k];
    let (to_low, to_high) = problem.reach[k + 1];
    let Scratch { source, terms, .. } = scratch;
    source.clear();
    source.extend(
        (to_low..=to_high)
            .zip(after)
            .map(|(t, a)| a + problem.emitted(k, t)),
    );
    let durations = problem.log_durations(k);
    (from_low..=from_high)
        .map(|s| {
            let low = to_low.max(s + 1);
            let high = to_high.min(s + durations.len());
            if low > high {
                return f64::NEG_INFINITY;
            }
            log_dot(
                &source[low - to_low..=high - to_low],
                &durations[low - s - 1..],
                terms,
            ) - problem.emitted(k, s)
        })
        .collect()
}

/// ln Σ exp(a + b) over the length of `a`; `b` may be longer.
#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn log_dot(a: &[f64], b: &[f64], terms: &mut Vec<f64>) -> f64 {
    const LANES: usize = 8;
    let b = &b[..a.len()];
    // Padded to whole blocks with -∞, which adds nothing.
    terms.clear();
    terms.resize(a.len().next_multiple_of(LANES), f64::NEG_INFINITY);
    // Plain comparisons in lanes turn into vector instructions, `f64::max` does not.
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut lanes = [f64::NEG_INFINITY; LANES];
    let (blocks_a, rest_a) = a.as_chunks::<LANES>();
    let (blocks_b, rest_b) = b.as_chunks::<LANES>();
    let (blocks, _) = terms.as_chunks_mut::<LANES>();
    for ((block, a), b) in blocks.iter_mut().zip(blocks_a).zip(blocks_b) {
        for i in 0..LANES {
            block[i] = a[i] + b[i];
            lanes[i] = larger(lanes[i], block[i]);
        }
    }
    if let Some(block) = blocks.get_mut(blocks_a.len()) {
        for i in 0..rest_a.len() {
            block[i] = rest_a[i] + rest_b[i];
            lanes[i] = larger(lanes[i], block[i]);
        }
    }
    let max = lanes.into_iter().fold(f64::NEG_INFINITY, larger);
    if max == f64::NEG_INFINITY {
        return max;
    }
    // Most boundaries are sharply placed: nearly all exponentials are skipped here.
    let cut = max - NEGLIGIBLE;
    let mut sum = 0.0;
    for block in &*blocks {
        let mut counts = false;
        for term in block {
            counts |= *term > cut;
        }
        if counts {
            for term in block.iter().filter(|term| **term > cut) {
                sum += (term - max).exp();
            }
        }
    }
    max + sum.ln()
}
