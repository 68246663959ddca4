//! `footfall inspect`: what is in a file.

mod calibration;
mod corpus_index;
mod dynamics;
mod imu;
pub(super) mod model;
mod motion;
pub(in crate::commands) mod moves;
mod style;

use crate::motion_input::MapArgs;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_model::Provenance;
use footfall_model::file::read_header;
use footfall_motion::gltf::is_gltf;
use serde::Serialize;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Show the contents of a file
///
/// A recording (.bvh) or a game's clip (.glb, .gltf, with `#Name` if there are several): skeleton, frames, rate, speed, contacts and steps. A model (.footfall): its source, states,
/// durations, speeds. A style (.footstyle): its base and source. A
/// switching model (.footdyn): its two systems. A sensor model (.footimu): sites, frames, behaviours. A calibration (.footcal): mounting of the sensors. An index (.csv): clips by
/// category, style and subject. A recording of a sensor (.csv): samples, rate, problems.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall inspect walk.bvh\n  \
    footfall inspect hero.glb#Walk\n  \
    footfall inspect walk.footfall --json\n  \
    footfall inspect index.csv")]
pub(crate) struct InspectArgs {
    /// A .bvh, .glb, .gltf, .footfall, .footstyle, .footdyn, .footimu or .footcal, an index.csv or a sensor's .csv
    #[arg(value_name = "FILE")]
    input: PathBuf,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Content of a file, by kind.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Finding {
    Motion(motion::MotionFacts),
    GaitModel(Box<model::ModelFacts>),
    GaitStyle(style::StyleFacts),
    DynamicsModel(dynamics::DynamicsFacts),
    ImuModel(imu::ImuModelFacts),
    ImuRecording(imu::ImuRecordingFacts),
    SensorCalibration(calibration::CalibrationFacts),
    CorpusIndex(corpus_index::IndexFacts),
}

pub(crate) fn run(args: &InspectArgs) -> Result<()> {
    let finding = match kind_of(&args.input)? {
        Kind::Model => Finding::GaitModel(Box::new(model::inspect(&args.input)?)),
        Kind::Style => Finding::GaitStyle(style::inspect(&args.input)?),
        Kind::Dynamics => Finding::DynamicsModel(dynamics::inspect(&args.input)?),
        Kind::Imu => Finding::ImuModel(imu::inspect_model(&args.input)?),
        Kind::ImuRecording => Finding::ImuRecording(imu::inspect_recording(&args.input)?),
        Kind::Calibration => Finding::SensorCalibration(calibration::inspect(&args.input)?),
        Kind::Index => Finding::CorpusIndex(corpus_index::inspect(&args.input)?),
        Kind::Motion => Finding::Motion(motion::inspect(&args.input, &args.map.read(None)?)?),
    };
    if args.json {
        return output::print_json(&finding);
    }
    let lines = match &finding {
        Finding::Motion(facts) => facts.lines(),
        Finding::GaitModel(facts) => facts.lines(),
        Finding::GaitStyle(facts) => facts.lines(),
        Finding::DynamicsModel(facts) => facts.lines(),
        Finding::ImuModel(facts) => facts.lines(),
        Finding::ImuRecording(facts) => facts.lines(),
        Finding::SensorCalibration(facts) => facts.lines(),
        Finding::CorpusIndex(facts) => facts.lines(),
    };
    output::print_text(&lines.join("\n"))
}

enum Kind {
    Motion,
    Model,
    Style,
    Dynamics,
    Imu,
    ImuRecording,
    Calibration,
    Index,
}

/// The first bytes decide, then the name: a damaged model is still to be read as a model.
fn kind_of(path: &Path) -> Result<Kind> {
    if is_gltf(path) {
        return Ok(Kind::Motion);
    }
    let mut start = [0; 8];
    let read = File::open(path)
        .and_then(|mut file| file.read(&mut start))
        .with_context(|| format!("{}: cannot read the file", path.display()))?;
    let extension = path.extension().map(OsStr::to_ascii_lowercase);
    let has = |name: &str| {
        extension
            .as_deref()
            .is_some_and(|extension| extension == name)
    };
    Ok(if has("footstyle") {
        Kind::Style
    } else if has("footdyn") {
        Kind::Dynamics
    } else if has("footimu") {
        Kind::Imu
    } else if has("footcal") {
        Kind::Calibration
    } else if has("csv") && start[..read].starts_with(b"time_s,") {
        Kind::ImuRecording
    } else if start[..read] == *b"FOOTFALL" || has("footfall") {
        Kind::Model
    } else if has("csv") {
        Kind::Index
    } else {
        Kind::Motion
    })
}

/// `name   value`, aligned.
fn fact(name: &str, value: impl std::fmt::Display) -> String {
    format!("{name:<14} {value}")
}

/// Facts that every model file of ours has.
#[derive(Serialize)]
struct FileFacts {
    file: PathBuf,
    bytes: u64,
    format_version: u32,
    written_by: String,
    provenance: Provenance,
}

impl FileFacts {
    /// Facts of a file that was read as a model.
    fn of(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| path.display().to_string())?;
        let (format_version, header) =
            read_header(&bytes).with_context(|| path.display().to_string())?;
        Ok(Self {
            file: path.to_owned(),
            bytes: bytes.len() as u64,
            format_version,
            written_by: header.written_by,
            provenance: header.provenance,
        })
    }

    /// File and format, then what stands between them and the corpus, then where the model comes from.
    fn lines(&self, kind: &str, between: Vec<String>) -> Vec<String> {
        let provenance = &self.provenance;
        let mut lines = vec![
            fact(
                kind,
                format!("{} ({} bytes)", self.file.display(), self.bytes),
            ),
            fact(
                "format",
                format!(
                    "{}, written by Footfall {}",
                    self.format_version, self.written_by
                ),
            ),
        ];
        lines.extend(between);
        lines.extend([
            fact("made from", &provenance.corpus),
            fact(
                "corpus",
                format!(
                    "{} clips, {} subjects, {} steps",
                    provenance.clips, provenance.subjects, provenance.steps
                ),
            ),
            fact("terms", &provenance.terms),
            fact("made by", &provenance.command),
        ]);
        if !provenance.commit.is_empty() {
            lines.push(fact("commit", &provenance.commit));
        }
        lines
    }
}
