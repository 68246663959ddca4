//! An evaluation as JSON and as tables.

use footfall_train::evaluate::{
    Confusion, JointRatios, Naturalness, Resemblance, Split, StyleEvaluation, StyleMeasures,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON object. Values that could not be measured are `null`.
#[derive(Serialize)]
pub(super) struct Report {
    /// `take` or `half`.
    split: &'static str,
    styles: Vec<String>,
    real: Recognition,
    synthesised: Option<Recognition>,
    /// Rate on synthesised strides over that on unseen real ones.
    ratio: Option<f64>,
    /// Pearson correlation of the styles' rates.
    rate_correlation: Option<f64>,
    /// Median of all styles' between-step variability ratios.
    step_variability_ratio: Option<f64>,
    measures: BTreeMap<String, StyleEntry>,
    /// Mean shrinkage of the classifiers.
    shrinkage: f64,
    skipped: Vec<String>,
}

#[derive(Serialize)]
struct Recognition {
    strides: usize,
    rate: Option<f64>,
    /// Rate over chance.
    efficiency: Option<f64>,
    rates: BTreeMap<String, Option<f64>>,
    /// Row: actual style, column: named style, in the order of `styles`.
    confusion: Vec<Vec<usize>>,
}

#[derive(Serialize)]
struct StyleEntry {
    real: NaturalnessEntry,
    real_against_real: ResemblanceEntry,
    synthesised: Option<NaturalnessEntry>,
    synthesised_against_real: Option<ResemblanceEntry>,
}

#[derive(Serialize)]
struct NaturalnessEntry {
    clips: usize,
    strides: usize,
    slip_mps: Option<f64>,
    skating_ratio: Option<f64>,
    jerk_mps3: Option<f64>,
    step_variability_rad: Option<f64>,
}

#[derive(Serialize)]
struct ResemblanceEntry {
    /// Root mean square over the features, in units of the spread within styles.
    distance: Option<f64>,
    variance_ratio: Ratios,
    step_variability_ratio: Ratios,
}

#[derive(Serialize)]
struct Ratios {
    median: Option<f64>,
    joints: BTreeMap<&'static str, f64>,
}

impl Report {
    pub(super) fn new(evaluation: &StyleEvaluation, skipped: Vec<String>) -> Self {
        let entry = |measures: &StyleMeasures| {
            let (synthesised, against) = measures
                .synthesised
                .as_ref()
                .map(|(own, against)| (own, against))
                .unzip();
            let entry = StyleEntry {
                real: (&measures.real).into(),
                real_against_real: (&measures.real_against_real).into(),
                synthesised: synthesised.map(Into::into),
                synthesised_against_real: against.map(Into::into),
            };
            (measures.style.clone(), entry)
        };
        Self {
            split: split_name(evaluation.split),
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

impl From<&Naturalness> for NaturalnessEntry {
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

impl From<&Resemblance> for ResemblanceEntry {
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

const fn split_name(split: Split) -> &'static str {
    match split {
        Split::Take => "take",
        Split::Half => "half",
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

/// All tables as text.
pub(super) fn tables(evaluation: &StyleEvaluation) -> String {
    let unseen = match evaluation.split {
        Split::Take => "each take in turn unseen",
        Split::Half => "each half of every recording in turn unseen",
    };
    let mut lines = recognition_lines(&evaluation.real, &format!("Real strides, {unseen}"));
    if let Some(synthesised) = &evaluation.synthesised {
        lines.push(String::new());
        lines.extend(recognition_lines(
            synthesised,
            "Synthesised strides, same classifiers",
        ));
        lines.push(String::new());
        lines.push(format!(
            "Synthesised over real: {}; correlation of the styles' rates: {}",
            number(evaluation.ratio(), 2),
            number(evaluation.rate_correlation(), 2)
        ));
    }
    lines.push(String::new());
    lines.extend(measure_lines(evaluation));
    lines.join("\n")
}

fn recognition_lines(confusion: &Confusion, title: &str) -> Vec<String> {
    let percent = |rate: Option<f64>| {
        rate.map_or_else(|| "-".to_owned(), |rate| format!("{:.1}", 100.0 * rate))
    };
    let width = confusion.labels.iter().map(String::len).max().unwrap_or(0);
    let mut lines = vec![
        format!(
            "{title}: {} % of {} recognised, {} times chance",
            percent(confusion.rate()),
            confusion.total(),
            number(confusion.efficiency(), 2)
        ),
        format!(
            "{:width$}  named as, % (columns in the order of the rows)",
            ""
        ),
    ];
    for (actual, label) in confusion.labels.iter().enumerate() {
        let judged = confusion.judged(actual);
        let cells = confusion.counts[actual]
            .iter()
            .map(|count| match (judged, *count) {
                (0, _) => "   -".to_owned(),
                (_, 0) => "   .".to_owned(),
                _ => format!("{:4.0}", 100.0 * *count as f64 / judged as f64),
            });
        lines.push(format!("{label:width$} {}", cells.collect::<String>()));
    }
    lines
}

fn measure_lines(evaluation: &StyleEvaluation) -> Vec<String> {
    let width = evaluation
        .styles
        .iter()
        .map(|style| style.style.len())
        .max()
        .unwrap_or(0)
        .max(5);
    let mut lines = vec![
        "Distance: of mean features, in spreads within styles. Variance, variability (between steps): medians of the joints' ratios."
            .to_owned(),
        format!(
            "{:width$}  {:11} strides  slip cm/s  skating   jerk m/s3  distance  variance  variability",
            "style", "recordings"
        ),
    ];
    for style in &evaluation.styles {
        let rows = [
            Some(("real", &style.real, &style.real_against_real)),
            style
                .synthesised
                .as_ref()
                .map(|(own, against)| ("synthesised", own, against)),
        ];
        for (kind, own, against) in rows.into_iter().flatten() {
            lines.push(format!(
                "{:width$}  {kind:11} {:7}  {:>9}  {:>7}  {:>10}  {:>8}  {:>8}  {:>11}",
                style.style,
                own.strides,
                number(own.slip_mps.map(|slip| 100.0 * slip), 2),
                number(own.skating_ratio, 3),
                number(own.jerk, 1),
                number(against.distance, 2),
                number(against.variance.median(), 2),
                number(against.variability.median(), 2),
            ));
        }
    }
    lines
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
