//! An evaluation of styles as a report that can be printed, drawn and written as JSON.

use super::{
    Confusion, JointRatios, Naturalness, Resemblance, Split, StyleEvaluation, StyleMeasures,
};
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
    pub real: NaturalnessFigures,
    /// One part of the real recordings against the other.
    pub real_against_real: ResemblanceFigures,
    /// The synthesised recordings.
    pub synthesised: Option<NaturalnessFigures>,
    /// These against the real ones.
    pub synthesised_against_real: Option<ResemblanceFigures>,
}

/// Figures of recordings by themselves.
#[derive(Clone, Debug, Serialize)]
pub struct NaturalnessFigures {
    /// Number of recordings.
    pub clips: usize,
    /// Number of their strides.
    pub strides: usize,
    /// Median speed of standing feet, m/s.
    pub slip_mps: Option<f64>,
    /// Share of frames in which a foot skates.
    pub skating_ratio: Option<f64>,
    /// Root mean square jerk, m/s³.
    pub jerk_mps3: Option<f64>,
    /// Median over the joints of the deviation between steps, radians.
    pub step_variability_rad: Option<f64>,
}

/// Figures of recordings against others of the same style.
#[derive(Clone, Debug, Serialize)]
pub struct ResemblanceFigures {
    /// Root mean square over the features, in units of the spread within styles.
    pub distance: Option<f64>,
    /// Variance of the joints' motion over the others'.
    pub variance_ratio: Ratios,
    /// Variability between steps over the others'.
    pub step_variability_ratio: Ratios,
}

/// Ratios of all joints.
#[derive(Clone, Debug, Serialize)]
pub struct Ratios {
    /// Median over the joints.
    pub median: Option<f64>,
    /// By joint.
    pub joints: BTreeMap<&'static str, f64>,
}

impl StyleReport {
    /// Figures of an evaluation; `skipped` are reasons why recordings were left out of it.
    pub fn new(evaluation: &StyleEvaluation, skipped: Vec<String>) -> Self {
        let entry = |measures: &StyleMeasures| {
            let (synthesised, against) = measures
                .synthesised
                .as_ref()
                .map(|(own, against)| (own, against))
                .unzip();
            let entry = StyleFigures {
                real: (&measures.real).into(),
                real_against_real: (&measures.real_against_real).into(),
                synthesised: synthesised.map(Into::into),
                synthesised_against_real: against.map(Into::into),
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

impl From<&Naturalness> for NaturalnessFigures {
    fn from(measured: &Naturalness) -> Self {
        Self {
            clips: measured.clips,
            strides: measured.strides,
            slip_mps: measured.slip_mps,
            skating_ratio: measured.skating_ratio,
            jerk_mps3: measured.jerk,
            step_variability_rad: measured.step_variability,
        }
    }
}

impl From<&Resemblance> for ResemblanceFigures {
    fn from(measured: &Resemblance) -> Self {
        Self {
            distance: measured.distance,
            variance_ratio: (&measured.variance).into(),
            step_variability_ratio: (&measured.variability).into(),
        }
    }
}

impl From<&JointRatios> for Ratios {
    fn from(ratios: &JointRatios) -> Self {
        let joints = ratios.joints.iter();
        Self {
            median: ratios.median(),
            joints: joints
                .map(|(joint, ratio)| (joint.name(), *ratio))
                .collect(),
        }
    }
}

/// Median over the styles of what is judged: synthesised against real if there is any, else real against real.
fn overall_variability(evaluation: &StyleEvaluation) -> Option<f64> {
    let mut medians: Vec<f64> = evaluation
        .styles
        .iter()
        .filter_map(|style| {
            let judged = match (&style.synthesised, &evaluation.synthesised) {
                (Some((_, against)), _) => against,
                (None, Some(_)) => return None,
                (None, None) => &style.real_against_real,
            };
            judged.variability.median()
        })
        .collect();
    medians.sort_by(f64::total_cmp);
    medians.get(medians.len() / 2).copied()
}
