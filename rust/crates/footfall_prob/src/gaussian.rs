//! Gaussians with diagonal covariance, and the weighted moments from which they are estimated.

use std::f64::consts::TAU;

use crate::error::{ProbError, check_finite, check_len, check_positive};

/// A Gaussian with diagonal covariance over D dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagonalGaussian {
    mean: Vec<f64>,
    variance: Vec<f64>,
    precision: Vec<f64>,
    /// -½ Σ ln(2π σ²), so that a density costs no logarithm.
    log_normaliser: f64,
}

impl DiagonalGaussian {
    /// A Gaussian from its mean and variance, D values each.
    ///
    /// # Errors
    /// [`ProbError`] when the lengths differ or are zero, a value is not finite, or a variance is
    /// not above zero.
    pub fn new(mean: Vec<f64>, variance: Vec<f64>) -> Result<Self, ProbError> {
        if mean.is_empty() {
            return Err(ProbError::Empty { what: "mean" });
        }
        check_len("variance", variance.len(), mean.len())?;
        check_finite("mean", &mean)?;
        check_positive("variance", &variance)?;
        let precision: Vec<f64> = variance.iter().map(|v| v.recip()).collect();
        check_finite("precision", &precision)?;
        let log_normaliser = -0.5 * variance.iter().map(|v| (TAU * v).ln()).sum::<f64>();
        Ok(Self {
            mean,
            variance,
            precision,
            log_normaliser,
        })
    }

    /// Number of dimensions D.
    pub fn dim(&self) -> usize {
        self.mean.len()
    }

    /// Mean, D values.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Variance, D values.
    pub fn variance(&self) -> &[f64] {
        &self.variance
    }

    /// Precision (reciprocal variance), D values.
    pub fn precision(&self) -> &[f64] {
        &self.precision
    }

    /// Natural logarithm of the density at `x` (D values; only the shorter of the two lengths is
    /// looked at, so check lengths once outside the loop).
    pub fn log_density(&self, x: &[f64]) -> f64 {
        self.log_normaliser - 0.5 * mahalanobis_squared(x, &self.mean, &self.precision)
    }
}

/// Σ p (x - m)², with eight running sums so that the compiler can use vector registers.
fn mahalanobis_squared(x: &[f64], mean: &[f64], precision: &[f64]) -> f64 {
    const LANES: usize = 8;
    let dim = x.len().min(mean.len()).min(precision.len());
    let (x, mean, precision) = (&x[..dim], &mean[..dim], &precision[..dim]);
    let (x, x_rest) = x.as_chunks::<LANES>();
    let (mean, mean_rest) = mean.as_chunks::<LANES>();
    let (precision, precision_rest) = precision.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for ((x, mean), precision) in x.iter().zip(mean).zip(precision) {
        for lane in 0..LANES {
            let delta = x[lane] - mean[lane];
            sums[lane] += delta * delta * precision[lane];
        }
    }
    let rest: f64 = x_rest
        .iter()
        .zip(mean_rest)
        .zip(precision_rest)
        .map(|((x, mean), precision)| (x - mean) * (x - mean) * precision)
        .sum();
    sums.iter().sum::<f64>() + rest
}

/// Log densities of `observations` (T x D, row-major) under every Gaussian, written to `out` as
/// T x E, row-major: what [`hsmm_forward_backward`](crate::hsmm::hsmm_forward_backward) reads.
///
/// # Errors
/// [`ProbError`] when there is no Gaussian, the Gaussians differ in dimension, the observations
/// are not whole frames, or a value is not finite.
pub fn log_densities(
    gaussians: &[DiagonalGaussian],
    observations: &[f64],
    out: &mut Vec<f64>,
) -> Result<(), ProbError> {
    let first = gaussians
        .first()
        .ok_or(ProbError::Empty { what: "gaussians" })?;
    let dim = first.dim();
    for gaussian in gaussians {
        check_len("mean", gaussian.dim(), dim)?;
    }
    let n_frames = observations.len() / dim;
    check_len("observations", observations.len(), n_frames * dim)?;
    check_finite("observations", observations)?;
    out.clear();
    out.reserve(n_frames * gaussians.len());
    for frame in observations.chunks_exact(dim) {
        out.extend(gaussians.iter().map(|gaussian| gaussian.log_density(frame)));
    }
    Ok(())
}

/// Weighted moments of a stream of vectors: the sufficient statistics of a [`DiagonalGaussian`].
///
/// Kept centred (West's update), because sums of squares cancel badly when the mean is large
/// beside the spread.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianStats {
    weight: f64,
    mean: Vec<f64>,
    /// Σ w (x - mean)² per dimension.
    scatter: Vec<f64>,
}

impl GaussianStats {
    /// Empty statistics over `dim` dimensions.
    pub fn new(dim: usize) -> Self {
        Self {
            weight: 0.0,
            mean: vec![0.0; dim],
            scatter: vec![0.0; dim],
        }
    }

    /// Adds `x` (D values) with a weight; weights of zero or less, or NaN, change nothing.
    pub fn add(&mut self, x: &[f64], weight: f64) {
        if weight.is_nan() || weight <= 0.0 {
            return;
        }
        self.weight += weight;
        let share = weight / self.weight;
        for ((mean, scatter), x) in self.mean.iter_mut().zip(&mut self.scatter).zip(x) {
            let delta = x - *mean;
            *mean += share * delta;
            *scatter += weight * delta * (x - *mean);
        }
    }

    /// Adds what `other` has seen, as if its vectors had been added here.
    pub fn merge(&mut self, other: &Self) {
        if other.weight <= 0.0 {
            return;
        }
        let total = self.weight + other.weight;
        let share = other.weight / total;
        let between = self.weight * share;
        for d in 0..self.mean.len().min(other.mean.len()) {
            let delta = other.mean[d] - self.mean[d];
            self.scatter[d] += other.scatter[d] + between * delta * delta;
            self.mean[d] += share * delta;
        }
        self.weight = total;
    }

    /// Number of dimensions D.
    pub fn dim(&self) -> usize {
        self.mean.len()
    }

    /// Sum of the weights: how many frames were seen, in expectation.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// Weighted mean, D values (zeros before anything was added).
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Weighted variance per dimension (zeros before anything was added).
    pub fn variance(&self) -> Vec<f64> {
        let scale = if self.weight > 0.0 {
            self.weight.recip()
        } else {
            0.0
        };
        self.scatter.iter().map(|s| (s * scale).max(0.0)).collect()
    }

    /// The maximum-likelihood Gaussian whose variances are nowhere below `variance_floor` (D values).
    ///
    /// # Errors
    /// [`ProbError::NoData`] when nothing was added; otherwise as [`DiagonalGaussian::new`].
    pub fn estimate(&self, variance_floor: &[f64]) -> Result<DiagonalGaussian, ProbError> {
        if self.weight <= 0.0 {
            return Err(ProbError::NoData { what: "a Gaussian" });
        }
        check_len("variance_floor", variance_floor.len(), self.dim())?;
        let variance = self
            .variance()
            .iter()
            .zip(variance_floor)
            .map(|(v, floor)| v.max(*floor))
            .collect();
        DiagonalGaussian::new(self.mean.clone(), variance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_is_the_textbook_one() {
        let dim = 19; // two full lane blocks and a rest
        let mean: Vec<f64> = (0..dim).map(|d| f64::from(d) * 0.3 - 1.0).collect();
        let variance: Vec<f64> = (0..dim).map(|d| 0.2 + f64::from(d)).collect();
        let x: Vec<f64> = (0..dim).map(|d| (f64::from(d) * 1.7).sin()).collect();
        let expected: f64 = (0..dim as usize)
            .map(|d| -0.5 * ((TAU * variance[d]).ln() + (x[d] - mean[d]).powi(2) / variance[d]))
            .sum();
        let gaussian = DiagonalGaussian::new(mean, variance).unwrap();
        assert!((gaussian.log_density(&x) - expected).abs() < 1e-12);
    }

    #[test]
    fn moments_match_two_passes_and_merging_changes_nothing() {
        // A mean of 1e8 beside a spread of 1 would break a plain sum of squares.
        let data: Vec<([f64; 2], f64)> = (0..50)
            .map(|i| {
                let i = f64::from(i);
                (
                    [1e8 + (i * 0.7).sin(), (i * 0.3).cos()],
                    0.1 + (i * 1.3).sin().abs(),
                )
            })
            .collect();
        let (mut whole, mut left, mut right) = (
            GaussianStats::new(2),
            GaussianStats::new(2),
            GaussianStats::new(2),
        );
        for (i, (x, weight)) in data.iter().enumerate() {
            whole.add(x, *weight);
            if i % 3 == 0 {
                left.add(x, *weight);
            } else {
                right.add(x, *weight);
            }
        }
        left.merge(&right);
        let total: f64 = data.iter().map(|(_, w)| w).sum();
        for d in 0..2 {
            let mean = data.iter().map(|(x, w)| w * (x[d] - 1e8)).sum::<f64>() / total + 1e8;
            let variance = data
                .iter()
                .map(|(x, w)| w * (x[d] - mean).powi(2))
                .sum::<f64>()
                / total;
            for stats in [&whole, &left] {
                assert!((stats.mean()[d] - mean).abs() < 1e-6);
                assert!(
                    (stats.variance()[d] - variance).abs() < 1e-6,
                    "{} {variance}",
                    stats.variance()[d]
                );
                assert!((stats.weight() - total).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn bad_input_is_named() {
        assert!(matches!(
            DiagonalGaussian::new(vec![], vec![]),
            Err(ProbError::Empty { .. })
        ));
        assert!(matches!(
            DiagonalGaussian::new(vec![0.0], vec![1.0, 1.0]),
            Err(ProbError::Shape { .. })
        ));
        assert!(matches!(
            DiagonalGaussian::new(vec![f64::NAN], vec![1.0]),
            Err(ProbError::NotFinite { .. })
        ));
        assert!(matches!(
            DiagonalGaussian::new(vec![0.0, 0.0], vec![1.0, 0.0]),
            Err(ProbError::NotPositive { index: 1, .. })
        ));
        assert!(matches!(
            GaussianStats::new(1).estimate(&[1.0]),
            Err(ProbError::NoData { .. })
        ));
        let gaussian = DiagonalGaussian::new(vec![0.0; 2], vec![1.0; 2]).unwrap();
        let mut out = Vec::new();
        assert!(matches!(
            log_densities(std::slice::from_ref(&gaussian), &[0.0; 3], &mut out),
            Err(ProbError::Shape { .. })
        ));
        assert!(matches!(
            log_densities(&[gaussian], &[0.0, f64::NAN], &mut out),
            Err(ProbError::NotFinite { index: 1, .. })
        ));
    }

    #[test]
    fn floor_holds_where_the_data_does_not_vary() {
        let mut stats = GaussianStats::new(2);
        stats.add(&[1.0, 0.0], 1.0);
        stats.add(&[1.0, 2.0], 1.0);
        assert_eq!(
            stats.estimate(&[0.25, 0.25]).unwrap().variance(),
            &[0.25, 1.0]
        );
    }
}
