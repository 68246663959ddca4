//! `footfall imu train`: a corpus becomes a model of what sensors on a body mean.

use super::{parse_site, synchronous};
use crate::commands::training_run::{TrainingRun, conclude};
use crate::motion_input::CorpusArgs;
use anyhow::{Context as _, Result};
use footfall_core::Site;
use footfall_imu::ImuRecording;
use footfall_train::imu::{ImuClip, ImuTrainConfig, TrunkTurn, train_imu_clips};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Train a sensor model: from the measurements of one or two sensors to the whole body
///
/// Every recording is cut into phases, each frame with the measurements of a simulated sensor at the site. Give --site twice for
/// two sensors. Columns of the index such as `imu_right_foot` name recordings of real sensors, which replace the simulated ones;
/// these may begin earlier and end later, on any clock, in any mounting.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall imu train --corpus index.csv --where 'path=cmu/*' --site right_foot -o body.footimu\n  \
    footfall imu train --corpus index.csv --site right_foot --site right_hand -o body.footimu")]
pub(crate) struct ImuTrainArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// File to write the model to
    #[arg(short, long, value_name = "BODY.footimu")]
    output: PathBuf,
    /// Description of the data for the model's provenance [default: the conditions]
    #[arg(long, value_name = "TEXT")]
    describe: Option<String>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Options of a model.
#[derive(Clone, Debug, clap::Args)]
pub(in crate::commands) struct ModelArgs {
    /// Site of the sensor; twice for two sensors
    #[arg(long = "site", value_parser = parse_site, required = true)]
    pub(in crate::commands) sites: Vec<Site>,
    /// Frames per second of the model
    #[arg(long, default_value_t = 30.0)]
    fps: f64,
    #[command(flatten)]
    kept: KeptArgs,
}

/// Part of the recordings that a model keeps.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(in crate::commands) struct KeptArgs {
    /// Leave out the recordings' mirror images
    #[arg(long)]
    no_mirror: bool,
    /// Maximum number of frames to keep: the cycles of movement that best represent all others
    #[arg(long, value_name = "N")]
    frames: Option<usize>,
    /// Train on simulated sensors of an uncalibrated board on a loose strap instead of ideal ones
    #[arg(long)]
    learn_strapped: bool,
}

impl KeptArgs {
    pub(in crate::commands) fn config(self, sites: &[Site]) -> ImuTrainConfig {
        ImuTrainConfig {
            mirror: !self.no_mirror,
            most_frames: self.frames,
            strapped: self.learn_strapped,
            ..ImuTrainConfig::new(sites)
        }
    }
}

impl ModelArgs {
    pub(in crate::commands) fn config(&self) -> Result<ImuTrainConfig> {
        let config = ImuTrainConfig {
            frame_rate_hz: self.fps,
            ..self.kept.config(&self.sites)
        };
        config.check()?;
        Ok(config)
    }
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    sites: Vec<&'static str>,
    clips: usize,
    /// Clips with recordings of real sensors.
    real: usize,
    subjects: usize,
    frames: usize,
    segments: usize,
    phases: usize,
    bytes: usize,
    skipped: Vec<String>,
    seconds: f64,
}

pub(crate) fn run(args: &ImuTrainArgs) -> Result<()> {
    let run = TrainingRun::begin(&args.corpus, args.describe.as_deref(), &args.output)?;
    let config = args.model.config()?;
    let mut corpus = run.read()?;
    // Of corrected heads other frames stand for the rest, from which a sensor on the other foot is recognised in 12 of 16 walks, not in all.
    for clip in &mut corpus.clips {
        *clip = clip.with_head_as_recorded();
    }
    let bent = args.corpus.fit.bent_trunks(&corpus.clips);
    let turn_of = |subject: &str| {
        let own = bent.iter().find(|own| own.subject == subject);
        own.map_or(TrunkTurn::default(), |own| own.turn)
    };
    let real: Vec<Vec<ImuRecording>> = corpus
        .clips
        .iter()
        .map(|clip| synchronous::recordings(&args.corpus.index, clip, &config.sites, &args.output))
        .collect::<Result<_>>()?;
    let clips: Vec<ImuClip<'_>> = corpus
        .clips
        .iter()
        .zip(&real)
        .map(|(clip, recordings)| ImuClip {
            recordings,
            trunk: turn_of(clip.subject()),
            ..ImuClip::simulated(clip)
        })
        .collect();
    let provenance = run.provenance(&corpus, "footfall imu train", &[], &options(&args.model));
    let model = train_imu_clips(&clips, &config, provenance)
        .with_context(|| args.corpus.index.display().to_string())?;
    let bytes = model.to_bytes().context("the trained model")?;
    run.write(&bytes)?;
    let report = Report {
        output: &args.output,
        sites: model.sites.iter().map(|site| site.name()).collect(),
        clips: clips.len(),
        real: real
            .iter()
            .filter(|recordings| !recordings.is_empty())
            .count(),
        subjects: model.subjects,
        frames: model.frame_count(),
        segments: model.segments.len(),
        phases: model.phases.len(),
        bytes: bytes.len(),
        skipped: corpus.report.reasons(),
        seconds: run.seconds(),
    };
    conclude(args.json, &report, &report.skipped, &[], |report| {
        vec![format!(
            "{}: {} frames in {} segments of {} phases, {} subjects in {} clips, {} bytes, {:.1} s",
            args.output.display(),
            report.frames,
            report.segments,
            report.phases,
            report.subjects,
            report.clips,
            report.bytes,
            report.seconds
        )]
    })
}

/// The options of a model as they were given, for the command that its file states.
fn options(args: &ModelArgs) -> Vec<String> {
    let sites = args.sites.iter();
    let mut words: Vec<String> = sites
        .map(|site| format!("--site {}", site.name()))
        .collect();
    if args.kept.no_mirror {
        words.push("--no-mirror".to_owned());
    }
    words.extend(args.kept.frames.map(|frames| format!("--frames {frames}")));
    words.push(format!("--fps {}", args.fps));
    words
}
