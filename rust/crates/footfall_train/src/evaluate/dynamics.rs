//! Two systems that switch against one that does not, by category: how well both predict recordings.

use crate::dynamics::{DynamicsComparison, DynamicsConfig, compare_dynamics};
use crate::error::TrainError;
use footfall_motion::recording::Recording;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Errors of one category, means over its recordings: root mean squares over the spread of the component weights.
#[derive(Clone, Debug, Default, Serialize)]
pub struct DynamicsErrors {
    /// Number of recordings with enough steps.
    pub recordings: usize,
    /// Two systems, one frame ahead.
    pub switching_one_step: f64,
    /// A single system, one frame ahead.
    pub single_one_step: f64,
    /// The first over the second.
    pub one_step_ratio: f64,
    /// Two systems, left to themselves.
    pub switching_simulated: f64,
    /// A single system, left to itself.
    pub single_simulated: f64,
    /// The first over the second.
    pub simulated_ratio: f64,
}

/// Prediction errors of both models.
#[derive(Clone, Debug, Serialize)]
pub struct DynamicsReport {
    /// By category.
    pub categories: BTreeMap<String, DynamicsErrors>,
    /// Recordings with too few steps, by their paths.
    pub too_short: Vec<String>,
}

/// Report on recordings, and what it summarises.
#[derive(Clone, Debug)]
pub struct DynamicsEvaluation {
    /// The report.
    pub report: DynamicsReport,
    /// Errors over time of every recording with enough steps, in the order of the recordings.
    pub comparisons: Vec<DynamicsComparison>,
}

/// Fits two switching systems and a single one to every recording, and compares how well they predict it.
///
/// # Errors
/// [`TrainError::Fit`] names a recording with a pose that is not finite.
pub fn evaluate_dynamics(
    recordings: &[Recording],
    config: &DynamicsConfig,
) -> Result<DynamicsEvaluation, TrainError> {
    let compared: Vec<Option<DynamicsComparison>> = recordings
        .par_iter()
        .map(|recording| {
            compare_dynamics(recording, config).map_err(|error| TrainError::Fit {
                path: recording.row.path.clone(),
                error: Box::new(error),
            })
        })
        .collect::<Result<_, _>>()?;
    let mut categories: BTreeMap<String, DynamicsErrors> = BTreeMap::new();
    let mut too_short = Vec::new();
    for (recording, comparison) in recordings.iter().zip(&compared) {
        match comparison {
            Some(comparison) => {
                let category = categories.entry(recording.row.category().to_owned());
                category.or_default().add(comparison);
            }
            None => too_short.push(recording.row.path.display().to_string()),
        }
    }
    categories.values_mut().for_each(DynamicsErrors::finish);
    Ok(DynamicsEvaluation {
        report: DynamicsReport {
            categories,
            too_short,
        },
        comparisons: compared.into_iter().flatten().collect(),
    })
}

impl DynamicsErrors {
    fn add(&mut self, comparison: &DynamicsComparison) {
        self.recordings += 1;
        let [one_step, simulated] = comparison.switching.means();
        self.switching_one_step += one_step;
        self.switching_simulated += simulated;
        let [one_step, simulated] = comparison.single.means();
        self.single_one_step += one_step;
        self.single_simulated += simulated;
    }

    fn finish(&mut self) {
        let count = self.recordings as f64;
        for sum in [
            &mut self.switching_one_step,
            &mut self.single_one_step,
            &mut self.switching_simulated,
            &mut self.single_simulated,
        ] {
            *sum /= count;
        }
        self.one_step_ratio = self.switching_one_step / self.single_one_step;
        self.simulated_ratio = self.switching_simulated / self.single_simulated;
    }
}
