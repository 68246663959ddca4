//! An evaluation of styles as a report that can be printed, drawn and written as JSON.

use super::{Confusion, Naturalness, Resemblance, Split, StyleEvaluation, StyleMeasures};
use crate::averages::upper_median;
use serde::Serialize;
use std::collections::BTreeMap;

/// Recognition, resemblance and naturalness of styles. Values that could not be measured are `None`.
#[derive(Clone, Debug, Serialize)]
pub struct StyleReport {
    /// Division of the real strides into seen and unseen.
    pub split: Split,
    /// Names of the styles, in the order of the confusions.
    pub styles: Vec<String>,
    /// Real strides that the classifiers had not seen.
    pub real: Recognition,
    /// Synthesised strides, by the same classifiers.
    pub synthesised: Option<Recognition>,
    /// Rate on synthesised strides over that on unseen real ones.
    pub ratio: Option<f64>,
    /// Pearson correlation of the styles' rates.
    pub rate_correlation: Option<f64>,
    /// Median of all styles' between-step variability ratios.
    pub step_variability_ratio: Option<f64>,
    /// By style.
    pub measures: BTreeMap<String, StyleFigures>,
    /// Mean shrinkage of the classifiers.
    pub shrinkage: f64,
    /// Recordings that were left out, and why.
    pub skipped: Vec<String>,
}

/// Strides by their style and by the style that the classifiers name.
#[derive(Clone, Debug, Serialize)]
pub struct Recognition {
    /// Number of strides.
    pub strides: usize,
    /// Share that is recognised.
    pub rate: Option<f64>,
    /// Rate over chance.
    pub efficiency: Option<f64>,
    /// Rates by style.
    pub rates: BTreeMap<String, Option<f64>>,
    /// Row: actual style, column: named style, in the order of [`StyleReport::styles`].
    pub confusion: Vec<Vec<usize>>,
}

/// Figures of one style.
#[derive(Clone, Debug, Serialize)]
pub struct StyleFigures {
    /// The real recordings.
    pub real: Naturalness,
    /// One part of the real recordings against the other.
    pub real_against_real: Resemblance,
    /// The synthesised recordings.
    pub synthesised: Option<Naturalness>,
    /// These against the real ones.
    pub synthesised_against_real: Option<Resemblance>,
}

impl StyleReport {
    /// Figures of an evaluation; `skipped` are reasons why recordings were left out of it.
    pub fn new(evaluation: &StyleEvaluation, skipped: Vec<String>) -> Self {
        let entry = |measures: &StyleMeasures| {
            let (synthesised, against) = measures.synthesised.clone().unzip();
            let entry = StyleFigures {
                real: measures.real,
                real_against_real: measures.real_against_real.clone(),
                synthesised,
                synthesised_against_real: against,
            };
            (measures.style.clone(), entry)
        };
        Self {
            split: evaluation.split,
            styles: evaluation.real.labels.clone(),
            real: (&evaluation.real).into(),
            synthesised: evaluation.synthesised.as_ref().map(Into::into),
            ratio: evaluation.ratio(),
            rate_correlation: evaluation.rate_correlation(),
            step_variability_ratio: overall_variability(evaluation),
            measures: evaluation.styles.iter().map(entry).collect(),
            shrinkage: evaluation.shrinkage,
            skipped,
        }
    }
}

impl From<&Confusion> for Recognition {
    fn from(confusion: &Confusion) -> Self {
        let rates = confusion.labels.iter().enumerate();
        Self {
            strides: confusion.total(),
            rate: confusion.rate(),
            efficiency: confusion.efficiency(),
            rates: rates
                .map(|(style, name)| (name.clone(), confusion.class_rate(style)))
                .collect(),
            confusion: confusion.counts.clone(),
        }
    }
}

/// Median over the styles of what is judged: synthesised against real if there is any, else real against real.
fn overall_variability(evaluation: &StyleEvaluation) -> Option<f64> {
    let medians = evaluation.styles.iter().filter_map(|style| {
        let judged = match (&style.synthesised, &evaluation.synthesised) {
            (Some((_, against)), _) => against,
            (None, Some(_)) => return None,
            (None, None) => &style.real_against_real,
        };
        judged.variability.median()
    });
    upper_median(medians)
}
