//! `footfall evaluate dynamics`: systems that switch against one that does not.

use crate::commands::dynamics::SizeArgs;
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_train::dynamics::{DynamicsComparison, compare_dynamics};
use plotters::prelude::*;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Two switching systems against one linear system of the same order
///
/// Fits both to every recording and compares how well they foretell it: one frame ahead, and left to themselves from the initial
/// state (of every segment, or of the recording). Errors are root mean squares over the spread of the component weights.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate dynamics --corpus index.csv --where category=neutral_walk --plot errors.svg")]
pub(crate) struct DynamicsArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    #[command(flatten)]
    size: SizeArgs,
    /// Picture of the first recording's errors over time
    #[arg(long, value_name = "ERRORS.svg")]
    plot: Option<PathBuf>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Errors of one category: means over its recordings.
#[derive(Default, Serialize)]
struct Errors {
    recordings: usize,
    switching_one_step: f64,
    single_one_step: f64,
    one_step_ratio: f64,
    switching_simulated: f64,
    single_simulated: f64,
    simulated_ratio: f64,
}

#[derive(Serialize)]
pub(super) struct Report {
    categories: BTreeMap<String, Errors>,
    /// Recordings with too few steps.
    too_short: Vec<String>,
}

/// Evaluates, and returns the report that is printed as JSON. Draws the errors of the first recording if that was asked for.
pub(super) fn evaluate(args: &DynamicsArgs) -> Result<Report> {
    let config = args.size.config()?;
    let corpus = args.corpus.read()?;
    let compared: Vec<Option<DynamicsComparison>> = corpus
        .clips
        .par_iter()
        .map(|clip| {
            compare_dynamics(clip, &config).with_context(|| clip.row.path.display().to_string())
        })
        .collect::<Result<_>>()?;
    let mut report = Report {
        categories: BTreeMap::new(),
        too_short: Vec::new(),
    };
    for (clip, comparison) in corpus.clips.iter().zip(&compared) {
        let Some(comparison) = comparison else {
            report.too_short.push(clip.row.path.display().to_string());
            continue;
        };
        let category = clip.row.category().to_owned();
        report
            .categories
            .entry(category)
            .or_default()
            .add(comparison);
    }
    for errors in report.categories.values_mut() {
        errors.finish();
    }
    if let Some(path) = &args.plot {
        let first = compared
            .iter()
            .flatten()
            .next()
            .context("no recording has enough steps to be drawn")?;
        output::write_atomic(path, plot(first)?.as_bytes())?;
    }
    Ok(report)
}

pub(crate) fn run(args: &DynamicsArgs) -> Result<()> {
    let report = evaluate(args)?;
    if args.json {
        return output::print_json(&report);
    }
    let mut lines = vec![
        "Error over spread: one frame ahead, and left to itself".to_owned(),
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
    output::print_text(&lines.join("\n"))
}

impl Errors {
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
            ("left to itself", &switching.simulated, &single.simulated),
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
