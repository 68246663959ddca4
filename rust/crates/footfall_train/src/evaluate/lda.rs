//! Linear discriminant analysis with a shrunk covariance: few steps, many features.
//!
//! Every class is a Gaussian about its mean, all share one covariance, all are equally likely beforehand. The correlations
//! of the features within the classes are shrunk towards none (Schäfer and Strimmer 2005, equation 10 with target D): with
//! a dozen steps a style and two hundred features the plain estimate has no inverse.

use super::EvaluateError;
use nalgebra::{DMatrix, DVector};

/// Least share of the target under [`Shrinkage::Automatic`]: keeps the covariance invertible whatever the data.
const LEAST_SHRINKAGE: f64 = 0.01;

/// Shrinkage of the correlations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shrinkage {
    /// By the formula of Schäfer and Strimmer, from the data alone, and at least by 0.01.
    Automatic,
    /// By this share in [0, 1]; 0 is the textbook's discriminant.
    Fixed(f64),
}

/// One observation: its features and the class that it belongs to.
#[derive(Clone, Copy, Debug)]
pub struct Labelled<'a> {
    /// Features, D of them.
    pub features: &'a [f64],
    /// Class, from 0.
    pub class: usize,
}

/// Mean of each class and the spread that all classes share.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassMoments {
    /// Mean features of each class, D each.
    pub means: Vec<Vec<f64>>,
    /// Standard deviation of each feature about the means of the classes, at least the floor that was asked for.
    pub spread: Vec<f64>,
}

impl ClassMoments {
    /// Estimates the moments of `classes` classes. `least_spread` is the least standard deviation of a feature.
    ///
    /// # Errors
    /// [`EvaluateError::EmptyClass`], [`EvaluateError::TooFewSamples`] when there are no more samples than classes, and
    /// [`EvaluateError::Features`] when features are not finite or not of the same number.
    pub fn of(
        samples: &[Labelled<'_>],
        classes: usize,
        least_spread: f64,
    ) -> Result<Self, EvaluateError> {
        let width = samples.first().map_or(0, |sample| sample.features.len());
        let mut counts = vec![0_usize; classes];
        let mut means = vec![vec![0.0; width]; classes];
        for sample in samples {
            let sound = sample.features.iter().all(|value| value.is_finite());
            if !sound || sample.features.len() != width || sample.class >= classes {
                return Err(EvaluateError::Features);
            }
            counts[sample.class] += 1;
            for (mean, value) in means[sample.class].iter_mut().zip(sample.features) {
                *mean += value;
            }
        }
        if let Some(class) = counts.iter().position(|count| *count == 0) {
            return Err(EvaluateError::EmptyClass { class });
        }
        if samples.len() <= classes || width == 0 {
            return Err(EvaluateError::TooFewSamples {
                samples: samples.len(),
                classes,
            });
        }
        for (mean, count) in means.iter_mut().zip(&counts) {
            for value in mean {
                *value /= *count as f64;
            }
        }
        let freedom = (samples.len() - classes) as f64;
        let spread = (0..width)
            .map(|feature| {
                let squares = samples.iter().map(|sample| {
                    (sample.features[feature] - means[sample.class][feature]).powi(2)
                });
                (squares.sum::<f64>() / freedom).sqrt().max(least_spread)
            })
            .collect();
        Ok(Self { means, spread })
    }
}

/// A trained classifier.
#[derive(Clone, Debug)]
pub struct Lda {
    moments: ClassMoments,
    /// D × classes, for features divided by their spread.
    weights: DMatrix<f64>,
    offsets: DVector<f64>,
    shrinkage: f64,
}

impl Lda {
    /// Trains on samples of `classes` classes.
    ///
    /// # Errors
    /// As [`ClassMoments::of`]; [`EvaluateError::Singular`] when the covariance has no inverse, which only a fixed shrinkage
    /// near 0 can bring about.
    pub fn fit(
        samples: &[Labelled<'_>],
        classes: usize,
        least_spread: f64,
        shrinkage: Shrinkage,
    ) -> Result<Self, EvaluateError> {
        let moments = ClassMoments::of(samples, classes, least_spread)?;
        let width = moments.spread.len();
        let residuals = DMatrix::from_fn(samples.len(), width, |row, feature| {
            let sample = samples[row];
            let mean = moments.means[sample.class][feature];
            (sample.features[feature] - mean) / moments.spread[feature]
        });
        let freedom = (samples.len() - classes) as f64;
        let mut covariance = residuals.tr_mul(&residuals) / freedom;
        let shrinkage = match shrinkage {
            Shrinkage::Fixed(share) => share,
            Shrinkage::Automatic => automatic_shrinkage(&residuals, &covariance),
        };
        covariance *= 1.0 - shrinkage;
        // The spread already holds the variance, floor included.
        covariance.fill_diagonal(1.0);
        let factor = covariance.cholesky().ok_or(EvaluateError::Singular)?;
        let means = DMatrix::from_fn(width, classes, |feature, class| {
            moments.means[class][feature] / moments.spread[feature]
        });
        let weights = factor.solve(&means);
        let offsets = DVector::from_fn(classes, |class, _| {
            -0.5 * means.column(class).dot(&weights.column(class))
        });
        Ok(Self {
            moments,
            weights,
            offsets,
            shrinkage,
        })
    }

    /// By how much the correlations were shrunk, in [0, 1].
    pub const fn shrinkage(&self) -> f64 {
        self.shrinkage
    }

    /// Log-probability of each class given the features; the exponentials sum to 1.
    pub fn log_posteriors(&self, features: &[f64]) -> Vec<f64> {
        let scaled = DVector::from_iterator(
            self.moments.spread.len(),
            features
                .iter()
                .zip(&self.moments.spread)
                .map(|(value, spread)| value / spread),
        );
        let scores = self.weights.tr_mul(&scaled) + &self.offsets;
        let best = scores.max();
        let total = scores.map(|score| (score - best).exp()).sum().ln() + best;
        scores.iter().map(|score| score - total).collect()
    }

    /// The most probable class.
    pub fn classify(&self, features: &[f64]) -> usize {
        let posteriors = self.log_posteriors(features);
        (0..posteriors.len())
            .max_by(|a, b| posteriors[*a].total_cmp(&posteriors[*b]))
            .unwrap_or_default()
    }
}

/// The sum of the variances of the correlations over the sum of their squares.
fn automatic_shrinkage(residuals: &DMatrix<f64>, covariance: &DMatrix<f64>) -> f64 {
    let count = residuals.nrows() as f64;
    let products = residuals.tr_mul(residuals) / count;
    let squared = residuals.map(|value| value * value);
    let squares = squared.tr_mul(&squared);
    let (mut noise, mut signal) = (0.0, 0.0);
    for row in 0..covariance.nrows() {
        for column in 0..row {
            let spread = squares[(row, column)] - count * products[(row, column)].powi(2);
            noise += spread * count / (count - 1.0).powi(3);
            signal += covariance[(row, column)].powi(2);
        }
    }
    if signal > 0.0 {
        (noise / signal).clamp(LEAST_SHRINKAGE, 1.0)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests;
