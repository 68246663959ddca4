//! `footfall evaluate training`: what taking walkers out of the average walk gains.

use crate::commands::train::TrainingProgress;
use crate::commands::training_run::skipped;
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_prob::windows::Windows;
use footfall_train::{EmConfig, TrainConfig, TrainingComparison, compare_training};
use serde::Serialize;
use std::fmt::Write as _;

/// Walker-adaptive training against plain training
///
/// Trains with and without a linear transform per walker, on all walkers and with each walker in turn unseen, and scores the unseen
/// walker's recordings, each under the transform that the walker's other recordings tell.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate training --corpus index.csv --where category=neutral_walk --where 'path=cmu/*'")]
pub(crate) struct TrainingArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    /// Frames per second of the models
    #[arg(long, default_value_t = 60.0)]
    fps: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
pub(super) struct Report {
    /// Mean ln variance of the states' Gaussians.
    plain_log_variance: f64,
    adaptive_log_variance: f64,
    /// Log density a frame, mean over all frames of unseen walkers.
    plain: f64,
    plain_adapted: f64,
    adaptive: f64,
    walkers: Vec<Walker>,
    skipped: Vec<String>,
}

#[derive(Serialize)]
struct Walker {
    subject: String,
    frames: usize,
    plain: f64,
    plain_adapted: f64,
    adaptive: f64,
}

pub(crate) fn run(args: &TrainingArgs) -> Result<()> {
    let report = evaluate(args)?;
    for reason in &report.skipped {
        output::note(&format!("warning: left out {reason}"));
    }
    if args.json {
        return output::print_json(&report);
    }
    output::print_text(&report.table())
}

/// Evaluates, and returns the report that is printed as JSON.
pub(super) fn evaluate(args: &TrainingArgs) -> Result<Report> {
    let mut progress = TrainingProgress(output::Progress::new());
    progress.0.stage("reading the corpus", 0);
    let corpus = args.corpus.read()?;
    let config = TrainConfig {
        frame_rate_hz: args.fps,
        windows: Windows::Compact,
        mirror: true,
        em: EmConfig {
            max_iterations: 30,
            min_gain_per_frame: 1e-3,
        },
    };
    let comparison = compare_training(&corpus.clips, &config, &mut progress)
        .with_context(|| args.corpus.index.display().to_string())?;
    progress.0.finish();
    let left_out = skipped(&corpus).into_iter().map(|s| s.reason).collect();
    Ok(Report::new(comparison, left_out))
}

impl Report {
    fn new(comparison: TrainingComparison, skipped: Vec<String>) -> Self {
        let walkers: Vec<Walker> = comparison
            .held_out
            .into_iter()
            .map(|walker| Walker {
                subject: walker.subject,
                frames: walker.frames,
                plain: walker.plain,
                plain_adapted: walker.plain_adapted,
                adaptive: walker.adaptive,
            })
            .collect();
        let frames: usize = walkers.iter().map(|walker| walker.frames).sum();
        let mean = |of: fn(&Walker) -> f64| {
            let sum: f64 = walkers.iter().map(|w| w.frames as f64 * of(w)).sum();
            sum / frames.max(1) as f64
        };
        Self {
            plain_log_variance: comparison.log_variance[0],
            adaptive_log_variance: comparison.log_variance[1],
            plain: mean(|walker| walker.plain),
            plain_adapted: mean(|walker| walker.plain_adapted),
            adaptive: mean(|walker| walker.adaptive),
            walkers,
            skipped,
        }
    }

    fn table(&self) -> String {
        let mut table = format!(
            "Mean ln variance of the states: plain {:.3}, walker-adaptive {:.3}\n\nLog density a frame of walkers that were not trained on\n{:<12} {:>7} {:>10} {:>16} {:>16}\n",
            self.plain_log_variance,
            self.adaptive_log_variance,
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
        for walker in &self.walkers {
            let values = [walker.plain, walker.plain_adapted, walker.adaptive];
            row(&walker.subject, walker.frames, values);
        }
        let frames = self.walkers.iter().map(|walker| walker.frames).sum();
        row(
            "all",
            frames,
            [self.plain, self.plain_adapted, self.adaptive],
        );
        table
    }
}
