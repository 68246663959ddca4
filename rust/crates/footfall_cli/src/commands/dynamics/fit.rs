//! `footfall dynamics fit`: a corpus becomes two systems that switch.

use crate::commands::training_run::{TrainingRun, conclude};
use crate::motion_input::CorpusArgs;
use anyhow::{Context as _, Result, ensure};
use footfall_train::dynamics::{DynamicsConfig, FittedDynamics, fit_dynamics};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Fit a switching model: two linear systems that switch when a foot lands
///
/// The model describes a gait by a few hundred numbers: one linear system generates the pose's strongest components while the left foot
/// carries the body, another while the right foot does. Fit it to the walks of one person.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall dynamics fit --corpus index.csv --where subject=cmu_35 --where category=neutral_walk -o gait.footdyn")]
pub(crate) struct FitArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    /// File to write the model to
    #[arg(short, long, value_name = "GAIT.footdyn")]
    output: PathBuf,
    #[command(flatten)]
    size: SizeArgs,
    /// Description of the data for the model's provenance [default: the conditions]
    #[arg(long, value_name = "TEXT")]
    describe: Option<String>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Size of the systems.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(in crate::commands) struct SizeArgs {
    /// Frames per second of the systems
    #[arg(long, default_value_t = 60.0)]
    fps: f64,
    /// Principal components of the pose
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u8).range(1..=40))]
    components: u8,
    /// Order of each system
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u8).range(1..=60))]
    order: u8,
}

impl SizeArgs {
    pub(in crate::commands) fn config(self) -> Result<DynamicsConfig> {
        ensure!(
            (20.0..=240.0).contains(&self.fps),
            "cannot fit systems at {} frames per second; set --fps to 20 to 240",
            self.fps
        );
        Ok(DynamicsConfig {
            frame_rate_hz: self.fps,
            components: usize::from(self.components),
            order: usize::from(self.order),
            ..DynamicsConfig::default()
        })
    }
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    clips: usize,
    subjects: usize,
    /// Segments of the left and of the right foot.
    segments: [usize; 2],
    /// Share of the variance that the components hold.
    explained: f64,
    /// Root mean square one-step error over the spread of the component weights, left and right.
    one_step_error: [f64; 2],
    bytes: usize,
    skipped: Vec<String>,
    seconds: f64,
}

pub(crate) fn run(args: &FitArgs) -> Result<()> {
    let run = TrainingRun::begin(&args.corpus, args.describe.as_deref(), &args.output)?;
    let config = args.size.config()?;
    let corpus = run.read()?;
    let options = [
        format!("--fps {}", args.size.fps),
        format!("--components {}", args.size.components),
        format!("--order {}", args.size.order),
    ];
    let provenance = run.provenance(&corpus, "footfall dynamics fit", &[], &options);
    let FittedDynamics {
        model,
        segments,
        explained,
        one_step_error,
    } = fit_dynamics(&corpus.clips, &config, provenance)
        .with_context(|| args.corpus.index.display().to_string())?;
    let bytes = model.to_bytes().context("the fitted model")?;
    run.write(&bytes)?;
    let report = Report {
        output: &args.output,
        clips: model.provenance.clips,
        subjects: model.provenance.subjects,
        segments,
        explained,
        one_step_error,
        bytes: bytes.len(),
        skipped: corpus.report.reasons(),
        seconds: run.seconds(),
    };
    conclude(args.json, &report, &report.skipped, &[], |report| {
        vec![format!(
            "{}: {} and {} segments of {} subjects in {} clips, {:.1} % of the variance, one-step error {:.3} and {:.3}, {} bytes, {:.1} s",
            args.output.display(),
            segments[0],
            segments[1],
            report.subjects,
            report.clips,
            100.0 * explained,
            one_step_error[0],
            one_step_error[1],
            report.bytes,
            report.seconds
        )]
    })
}
