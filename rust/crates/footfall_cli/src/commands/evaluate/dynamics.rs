//! `footfall evaluate dynamics`: systems that switch against one that does not.

use crate::commands::dynamics::SizeArgs;
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_train::dynamics::DynamicsComparison;
use footfall_train::evaluate::dynamics::{DynamicsReport, evaluate_dynamics};
use plotters::prelude::*;
use std::path::PathBuf;

/// Compare a switching model with one linear system of the same order
///
/// Fits both to every recording and compares their predictions: one frame ahead, and in free simulation from the initial
/// state (of every segment, or of the recording). Errors are root mean squares relative to the spread of the component weights.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate dynamics --corpus index.csv --where category=neutral_walk --plot errors.svg")]
pub(crate) struct DynamicsArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    #[command(flatten)]
    size: SizeArgs,
    /// SVG of the first recording's errors over time
    #[arg(long, value_name = "ERRORS.svg")]
    plot: Option<PathBuf>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Evaluates, and returns the report that is printed as JSON. Draws the errors of the first recording if that was asked for.
fn evaluate(args: &DynamicsArgs) -> Result<DynamicsReport> {
    let config = args.size.config()?;
    let corpus = args.corpus.read()?;
    let evaluation = evaluate_dynamics(&corpus.clips, &config)?;
    if let Some(path) = &args.plot {
        let first = evaluation
            .comparisons
            .first()
            .context("no recording has enough steps for the plot")?;
        output::write_atomic(path, plot(first)?.as_bytes())?;
    }
    Ok(evaluation.report)
}

pub(crate) fn run(args: &DynamicsArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, table)
}

/// Categories in a line each.
fn table(report: &DynamicsReport) -> String {
    let mut lines = vec![
        "Error over spread: one frame ahead, and in free simulation".to_owned(),
        format!(
            "{:24} {:>10}  {:>9} {:>7} {:>6}  {:>9} {:>7} {:>6}",
            "category",
            "recordings",
            "switching",
            "single",
            "ratio",
            "switching",
            "single",
            "ratio"
        ),
    ];
    lines.extend(report.categories.iter().map(|(category, errors)| {
        format!(
            "{category:24} {:10}  {:9.4} {:7.4} {:6.2}  {:9.3} {:7.3} {:6.2}",
            errors.recordings,
            errors.switching_one_step,
            errors.single_one_step,
            errors.one_step_ratio,
            errors.switching_simulated,
            errors.single_simulated,
            errors.simulated_ratio
        )
    }));
    if !report.too_short.is_empty() {
        lines.push(format!(
            "{} recordings have too few steps",
            report.too_short.len()
        ));
    }
    lines.join("\n")
}

/// Both errors over time as an SVG, one frame ahead above, left to themselves below; switches as grey lines.
fn plot(comparison: &DynamicsComparison) -> Result<String> {
    const SIZE: (u32, u32) = (960, 560);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (switching, single) = (&comparison.switching, &comparison.single);
        let panels = [
            ("one frame ahead", &switching.one_step, &single.one_step),
            ("free simulation", &switching.simulated, &single.simulated),
        ];
        for (area, (title, switching, single)) in area.split_evenly((2, 1)).iter().zip(panels) {
            let secs = |frame: usize| frame as f64 / comparison.frame_rate_hz;
            let greatest = switching.iter().chain(single).copied().fold(1e-9, f64::max);
            let mut chart = ChartBuilder::on(area)
                .caption(format!("Error over spread, {title}"), ("sans-serif", 16))
                .margin(8)
                .x_label_area_size(36)
                .y_label_area_size(48)
                .build_cartesian_2d(0.0..secs(switching.len().max(1)), 0.0..1.05 * greatest)?;
            chart
                .configure_mesh()
                .disable_mesh()
                .x_desc("seconds")
                .draw()?;
            chart.draw_series(comparison.switches.iter().map(|switch| {
                let at = secs(*switch);
                PathElement::new([(at, 0.0), (at, 1.05 * greatest)], BLACK.mix(0.2))
            }))?;
            let models = [
                (single, "one linear system", RGBColor(217, 95, 2)),
                (switching, "two switching systems", RGBColor(31, 119, 180)),
            ];
            for (errors, name, colour) in models {
                let points = errors.iter().enumerate();
                let points = points.map(|(frame, error)| (secs(frame), *error));
                chart
                    .draw_series(LineSeries::new(points, colour))?
                    .label(name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
            }
            chart
                .configure_series_labels()
                .background_style(WHITE.mix(0.8))
                .draw()?;
        }
        area.present()?;
    }
    Ok(svg)
}
