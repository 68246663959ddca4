//! `footfall evaluate training`: what taking walkers out of the average walk gains.

use crate::commands::train::TrainingProgress;
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_train::evaluate::training::{DEFAULT_RATE_HZ, TrainingReport, evaluate_training};
use std::fmt::Write as _;

/// Compare walker-adaptive training with plain training
///
/// Trains with and without a linear transform per walker, on all walkers and with each walker in turn unseen. Scores the unseen
/// walker's recordings, each under the transform estimated from the walker's other recordings.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate training --corpus index.csv --where category=neutral_walk --where 'path=cmu/*'")]
pub(crate) struct TrainingArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    /// Frames per second of the models
    #[arg(long, default_value_t = DEFAULT_RATE_HZ)]
    fps: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &TrainingArgs) -> Result<()> {
    let report = evaluate(args)?;
    output::note_left_out(&report.skipped);
    output::print_report(args.json, &report, table)
}

/// Evaluates, and returns the report that is printed as JSON.
fn evaluate(args: &TrainingArgs) -> Result<TrainingReport> {
    let mut progress = TrainingProgress(output::Progress::new());
    progress.0.stage("reading the corpus", 0);
    let corpus = args.corpus.read()?;
    let report = evaluate_training(&corpus, args.fps, &mut progress)
        .with_context(|| args.corpus.index.display().to_string())?;
    progress.0.finish();
    Ok(report)
}

/// Walkers in a line each, then all of them.
fn table(report: &TrainingReport) -> String {
    let mut table = format!(
        "Mean ln variance of the states: plain {:.3}, walker-adaptive {:.3}\n\nLog density a frame of walkers that were not trained on\n{:<12} {:>7} {:>10} {:>16} {:>16}\n",
        report.plain_log_variance,
        report.adaptive_log_variance,
        "walker",
        "frames",
        "plain",
        "plain, adapted",
        "walker-adaptive"
    );
    let mut row = |name: &str, frames: usize, values: [f64; 3]| {
        let [plain, adapted, adaptive] = values;
        // Writing to a string does not fail.
        let _written = writeln!(
            table,
            "{name:<12} {frames:>7} {plain:>10.2} {adapted:>16.2} {adaptive:>16.2}"
        );
    };
    for walker in &report.walkers {
        let values = [walker.plain, walker.plain_adapted, walker.adaptive];
        row(&walker.subject, walker.frames, values);
    }
    let frames = report.walkers.iter().map(|walker| walker.frames).sum();
    row(
        "all",
        frames,
        [report.plain, report.plain_adapted, report.adaptive],
    );
    table
}
