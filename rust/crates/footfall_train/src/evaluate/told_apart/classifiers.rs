//! Two classifiers of strides: a logistic regression, which sees sums of features, and extremely randomised trees, which see
//! their combinations.

use crate::evaluate::EvaluateError;
use smartcore::ensemble::extra_trees_regressor::{
    ExtraTreesRegressor, ExtraTreesRegressorParameters,
};
use smartcore::linalg::basic::matrix::DenseMatrix;
use smartcore::linear::logistic_regression::{LogisticRegression, LogisticRegressionParameters};

/// Inverse strength of the regularisation, for classes that are balanced and features that are standardised.
const INVERSE_REGULARISATION: f64 = 0.02;
const TREES: usize = 400;
const LEAST_LEAF: usize = 3;
const SEED: u64 = 1;

/// Kinds of classifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classifier {
    /// Logistic regression on standardised features.
    Logistic,
    /// Extremely randomised trees (Geurts et al. 2006), whose mean vote decides.
    Trees,
}

impl Classifier {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Logistic, Self::Trees];

    /// Learns from captured and generated samples, both classes of equal weight, and returns for each sample to be judged whether it is
    /// taken for captured.
    ///
    /// # Errors
    /// [`EvaluateError::Features`] for features that are not finite or of different lengths, and for a class without samples.
    pub fn judge(
        self,
        captured: &[&[f64]],
        generated: &[&[f64]],
        judged: &[&[f64]],
    ) -> Result<Vec<bool>, EvaluateError> {
        if captured.is_empty() || generated.is_empty() {
            return Err(EvaluateError::Features);
        }
        let scale = Standardisation::of(captured.iter().chain(generated));
        let larger = captured.len().max(generated.len());
        // Samples of the smaller class come round again until both are as many.
        let rows: Vec<Vec<f64>> = [captured, generated]
            .iter()
            .flat_map(|class| class.iter().cycle().take(larger))
            .map(|features| scale.apply(features))
            .collect();
        let labels: Vec<i32> = (0..2 * larger).map(|row| i32::from(row < larger)).collect();
        let rows = matrix(&rows)?;
        let judged: Vec<Vec<f64>> = judged.iter().map(|row| scale.apply(row)).collect();
        if judged.is_empty() {
            return Ok(Vec::new());
        }
        let judged = matrix(&judged)?;
        match self {
            Self::Logistic => {
                let share = (captured.len() + generated.len()) as f64 / (2 * larger) as f64;
                let parameters = LogisticRegressionParameters::default()
                    .with_alpha(1.0 / (INVERSE_REGULARISATION * share));
                let model = LogisticRegression::fit(&rows, &labels, parameters).map_err(broken)?;
                let answers: Vec<i32> = model.predict(&judged).map_err(broken)?;
                Ok(answers.into_iter().map(|answer| answer == 1).collect())
            }
            Self::Trees => {
                let votes: Vec<f64> = labels.into_iter().map(f64::from).collect();
                let at_once = (rows_wide(&rows) as f64).sqrt() as usize;
                let parameters = ExtraTreesRegressorParameters::default()
                    .with_n_trees(TREES)
                    .with_min_samples_leaf(LEAST_LEAF)
                    .with_m(at_once.max(1))
                    .with_seed(SEED);
                let model = ExtraTreesRegressor::fit(&rows, &votes, parameters).map_err(broken)?;
                let answers: Vec<f64> = model.predict(&judged).map_err(broken)?;
                Ok(answers.into_iter().map(|answer| answer > 0.5).collect())
            }
        }
    }
}

fn rows_wide(rows: &DenseMatrix<f64>) -> usize {
    use smartcore::linalg::basic::arrays::Array as _;
    rows.shape().1
}

fn matrix(rows: &Vec<Vec<f64>>) -> Result<DenseMatrix<f64>, EvaluateError> {
    let wide = rows.first().map_or(0, Vec::len);
    let is_sound = rows
        .iter()
        .all(|row| row.len() == wide && row.iter().all(|value| value.is_finite()));
    if !is_sound {
        return Err(EvaluateError::Features);
    }
    DenseMatrix::from_2d_vec(rows).map_err(broken)
}

fn broken(_: smartcore::error::Failed) -> EvaluateError {
    EvaluateError::Features
}

/// Means and deviations of the features that a classifier learns from.
struct Standardisation {
    means: Vec<f64>,
    deviations: Vec<f64>,
}

impl Standardisation {
    fn of<'a>(samples: impl Iterator<Item = &'a &'a [f64]> + Clone) -> Self {
        let wide = samples.clone().next().map_or(0, |row| row.len());
        let count = samples.clone().count().max(1) as f64;
        let mut means = vec![0.0; wide];
        let mut deviations = vec![0.0; wide];
        for row in samples.clone() {
            for (mean, value) in means.iter_mut().zip(*row) {
                *mean += value / count;
            }
        }
        for row in samples {
            for ((deviation, mean), value) in deviations.iter_mut().zip(&means).zip(*row) {
                *deviation += (value - mean).powi(2) / count;
            }
        }
        for deviation in &mut deviations {
            // A feature that never varies tells nothing.
            *deviation = if *deviation < 1e-18 {
                1.0
            } else {
                deviation.sqrt()
            };
        }
        Self { means, deviations }
    }

    fn apply(&self, row: &[f64]) -> Vec<f64> {
        let scaled = row.iter().zip(&self.means).zip(&self.deviations);
        scaled
            .map(|((value, mean), deviation)| (value - mean) / deviation)
            .collect()
    }
}
