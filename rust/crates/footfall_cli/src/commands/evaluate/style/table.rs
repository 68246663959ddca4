//! The report as tables for a terminal.

use footfall_train::evaluate::Split;
use footfall_train::evaluate::style_report::{Recognition, StyleReport};

/// All tables as text.
pub(super) fn tables(report: &StyleReport) -> String {
    let unseen = match report.split {
        Split::Take => "each take in turn unseen",
        Split::Half => "each half of every recording in turn unseen",
    };
    let recognition = |recognition: &Recognition, title: &str| {
        recognition_lines(recognition, &report.styles, title)
    };
    let mut lines = recognition(&report.real, &format!("Real strides, {unseen}"));
    if let Some(synthesised) = &report.synthesised {
        lines.push(String::new());
        lines.extend(recognition(
            synthesised,
            "Synthesised strides, same classifiers",
        ));
        lines.push(String::new());
        lines.push(format!(
            "Synthesised over real: {}; correlation of the styles' rates: {}",
            number(report.ratio, 2),
            number(report.rate_correlation, 2)
        ));
    }
    lines.push(String::new());
    lines.extend(measure_lines(report));
    lines.join("\n")
}

fn recognition_lines(recognition: &Recognition, styles: &[String], title: &str) -> Vec<String> {
    let percent = |rate: Option<f64>| {
        rate.map_or_else(|| "-".to_owned(), |rate| format!("{:.1}", 100.0 * rate))
    };
    let width = styles.iter().map(String::len).max().unwrap_or(0);
    let mut lines = vec![
        format!(
            "{title}: {} % of {} recognised, {} times chance",
            percent(recognition.rate),
            recognition.strides,
            number(recognition.efficiency, 2)
        ),
        format!(
            "{:width$}  named as, % (columns in the order of the rows)",
            ""
        ),
    ];
    for (label, counts) in styles.iter().zip(&recognition.confusion) {
        let judged: usize = counts.iter().sum();
        let cells = counts.iter().map(|count| match (judged, *count) {
            (0, _) => "   -".to_owned(),
            (_, 0) => "   .".to_owned(),
            _ => format!("{:4.0}", 100.0 * *count as f64 / judged as f64),
        });
        lines.push(format!("{label:width$} {}", cells.collect::<String>()));
    }
    lines
}

fn measure_lines(report: &StyleReport) -> Vec<String> {
    let width = report
        .measures
        .keys()
        .map(String::len)
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
    for (style, figures) in &report.measures {
        let synthesised = figures.synthesised.as_ref();
        let rows = [
            Some(("real", &figures.real, &figures.real_against_real)),
            synthesised
                .zip(figures.synthesised_against_real.as_ref())
                .map(|(own, against)| ("synthesised", own, against)),
        ];
        for (kind, own, against) in rows.into_iter().flatten() {
            lines.push(format!(
                "{style:width$}  {kind:11} {:7}  {:>9}  {:>7}  {:>10}  {:>8}  {:>8}  {:>11}",
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
