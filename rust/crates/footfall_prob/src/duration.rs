//! Durations of segments in frames: Gaussian on 1..=max, in the log domain.
//!
//! The paper (section 5.1.1) models state durations by a Gaussian density. Frames are whole and a
//! state lasts at least one, so the density is evaluated at 1, 2, ..., `max_duration` and normalised there.

mod fit;

pub use fit::DurationStats;

use crate::error::{ProbError, check_finite, check_positive};
use crate::hsmm::{Boundary, Edge};

/// Parameters of a Gaussian over durations, in frames. What a model file stores.
///
/// These are the Gaussian's own parameters; once cut to 1..=max the moments differ slightly
/// ([`DurationDist::mean`], [`DurationDist::variance`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianDuration {
    /// Centre, frames.
    pub mean: f64,
    /// Spread, frames².
    pub variance: f64,
}

impl GaussianDuration {
    /// The distribution on 1..=`max_duration` frames.
    ///
    /// # Errors
    /// [`ProbError`] when a parameter is not finite, the variance is not above zero, or
    /// `max_duration` is zero.
    pub fn discretise(self, max_duration: usize) -> Result<DurationDist, ProbError> {
        check_finite("duration mean", &[self.mean])?;
        check_positive("duration variance", &[self.variance])?;
        let log_weights: Vec<f64> = (1..=max_duration)
            .map(|d| -0.5 * (d as f64 - self.mean).powi(2) / self.variance)
            .collect();
        DurationDist::from_log_weights(log_weights)
    }
}

/// A distribution over durations 1..=max frames, with the tables that censored segments need.
#[derive(Debug, Clone, PartialEq)]
pub struct DurationDist {
    // All tables: entry d - 1 is for duration d.
    log_pmf: Vec<f64>,
    log_survival: Vec<f64>,
    log_residual: Vec<f64>,
    log_residual_survival: Vec<f64>,
    mean: f64,
    variance: f64,
}

impl DurationDist {
    /// A distribution proportional to exp(`log_weights[d - 1]`); entries may be -∞.
    ///
    /// # Errors
    /// [`ProbError`] when the table is empty, an entry is NaN or +∞, or all are -∞.
    pub fn from_log_weights(mut log_weights: Vec<f64>) -> Result<Self, ProbError> {
        if log_weights.is_empty() {
            return Err(ProbError::Empty {
                what: "duration table",
            });
        }
        if let Some(index) = log_weights
            .iter()
            .position(|w| w.is_nan() || *w == f64::INFINITY)
        {
            return Err(ProbError::NotFinite {
                what: "duration table",
                index,
                value: log_weights[index],
            });
        }
        let log_total = log_sum_exp(&log_weights);
        if log_total == f64::NEG_INFINITY {
            return Err(ProbError::NoData {
                what: "duration table",
            });
        }
        for weight in &mut log_weights {
            *weight -= log_total;
        }
        let log_pmf = log_weights;
        let mean: f64 = (1..)
            .zip(&log_pmf)
            .map(|(d, p)| f64::from(d) * p.exp())
            .sum();
        let variance = (1..)
            .zip(&log_pmf)
            .map(|(d, p)| (f64::from(d) - mean).powi(2) * p.exp())
            .sum();
        let log_survival = reverse_log_cumulative(&log_pmf);
        let log_mean = mean.ln();
        let log_residual: Vec<f64> = log_survival.iter().map(|s| s - log_mean).collect();
        let log_residual_survival = reverse_log_cumulative(&log_residual);
        Ok(Self {
            log_pmf,
            log_survival,
            log_residual,
            log_residual_survival,
            mean,
            variance,
        })
    }

    /// Longest duration, frames.
    pub fn max_duration(&self) -> usize {
        self.log_pmf.len()
    }

    /// ln P(D = `duration`); -∞ outside 1..=max.
    pub fn log_pmf(&self, duration: usize) -> f64 {
        entry(&self.log_pmf, duration)
    }

    /// ln P(D ≥ `duration`): the weight of a segment that the end of the recording cut off after
    /// `duration` frames. 0 at one frame, -∞ beyond max.
    pub fn log_survival(&self, duration: usize) -> f64 {
        if duration == 0 {
            0.0
        } else {
            entry(&self.log_survival, duration)
        }
    }

    /// ln (P(D ≥ `duration`) / E\[D\]): the probability that `duration` frames remain, the present
    /// one included, of a segment that was running when the recording started at a time that does
    /// not depend on the motion (renewal theory). Sums to one over 1..=max.
    pub fn log_residual(&self, duration: usize) -> f64 {
        entry(&self.log_residual, duration)
    }

    /// Expected duration, frames.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Variance of the duration, frames².
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// The table for a segment whose start or end lies outside the recording.
    pub(crate) fn observed_log_table(&self, seen: Boundary) -> &[f64] {
        match (seen.start, seen.end) {
            (Edge::Complete, Edge::Complete) => &self.log_pmf,
            (Edge::Complete, Edge::Censored) => &self.log_survival,
            (Edge::Censored, Edge::Complete) => &self.log_residual,
            (Edge::Censored, Edge::Censored) => &self.log_residual_survival,
        }
    }
}

fn entry(table: &[f64], duration: usize) -> f64 {
    duration
        .checked_sub(1)
        .and_then(|i| table.get(i))
        .copied()
        .unwrap_or(f64::NEG_INFINITY)
}

/// out[i] = ln Σ_{j ≥ i} exp(x[j]).
fn reverse_log_cumulative(x: &[f64]) -> Vec<f64> {
    let mut out = vec![f64::NEG_INFINITY; x.len()];
    let mut running = f64::NEG_INFINITY;
    for i in (0..x.len()).rev() {
        running = log_add_exp(running, x[i]);
        out[i] = running;
    }
    out
}

fn log_add_exp(a: f64, b: f64) -> f64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    if low == f64::NEG_INFINITY {
        high
    } else {
        high + (low - high).exp().ln_1p()
    }
}

/// ln Σ exp(x); -∞ for an empty slice.
pub(crate) fn log_sum_exp(x: &[f64]) -> f64 {
    let max = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if max == f64::NEG_INFINITY {
        return max;
    }
    max + x.iter().map(|v| (v - max).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_agree_with_plain_sums() {
        let dist = GaussianDuration {
            mean: 4.3,
            variance: 2.5,
        }
        .discretise(12)
        .unwrap();
        let p: Vec<f64> = (1..=12).map(|d| dist.log_pmf(d).exp()).collect();
        assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        let ratio = (-0.5 * ((3.0f64 - 4.3).powi(2) - (7.0f64 - 4.3).powi(2)) / 2.5).exp();
        assert!((p[2] / p[6] - ratio).abs() < 1e-12 * ratio);
        let mean: f64 = p
            .iter()
            .enumerate()
            .map(|(i, p)| (i as f64 + 1.0) * p)
            .sum();
        let square: f64 = p
            .iter()
            .enumerate()
            .map(|(i, p)| (i as f64 + 1.0).powi(2) * p)
            .sum();
        assert!((dist.mean() - mean).abs() < 1e-13);
        assert!((dist.variance() - (square - mean * mean)).abs() < 1e-12);
        for d in 1..=12 {
            let survival: f64 = p[d - 1..].iter().sum();
            assert!((dist.log_survival(d).exp() - survival).abs() < 1e-14);
            assert!((dist.log_residual(d).exp() - survival / mean).abs() < 1e-14);
        }
        let residual: f64 = (1..=12).map(|d| dist.log_residual(d).exp()).sum();
        assert!((residual - 1.0).abs() < 1e-13);
        for outside in [dist.log_pmf(0), dist.log_pmf(13), dist.log_survival(13)] {
            assert!(outside.is_infinite() && outside < 0.0);
        }
    }

    #[test]
    fn far_tails_stay_finite() {
        let dist = GaussianDuration {
            mean: 2.0,
            variance: 0.01,
        }
        .discretise(100)
        .unwrap();
        assert!(dist.log_pmf(100).is_finite() && dist.log_pmf(100) < -400_000.0);
        assert!(dist.log_survival(100).is_finite());
    }

    #[test]
    fn bad_input_is_named() {
        let duration = |mean, variance| GaussianDuration { mean, variance };
        assert!(matches!(
            duration(3.0, 0.0).discretise(5),
            Err(ProbError::NotPositive { .. })
        ));
        assert!(matches!(
            duration(f64::NAN, 1.0).discretise(5),
            Err(ProbError::NotFinite { .. })
        ));
        assert!(matches!(
            duration(3.0, 1.0).discretise(0),
            Err(ProbError::Empty { .. })
        ));
        assert!(matches!(
            DurationDist::from_log_weights(vec![f64::NEG_INFINITY]),
            Err(ProbError::NoData { .. })
        ));
        assert!(matches!(
            DurationDist::from_log_weights(vec![0.0, f64::NAN]),
            Err(ProbError::NotFinite { .. })
        ));
    }
}
