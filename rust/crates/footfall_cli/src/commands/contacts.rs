//! `footfall contacts`: when each foot stands, and the steps.

use crate::motion_input::{MapArgs, read_file};
use crate::output;
use anyhow::{Context as _, Result};
use clap::ValueEnum;
use footfall_core::GaitEvent;
use footfall_motion::contact_file::ContactFile;
use footfall_motion::recording::Recording;
use footfall_motion::retarget::Retargeted;
use footfall_motion::switches::{detect_switches, stances, walks};
use std::path::{Path, PathBuf};

/// Find ground contacts, gait events and steps
///
/// An initial contact is the first frame in which any part of the foot bears on the ground, a terminal contact the last.
/// Frames and times refer to the file as given, frame 0 included. Steps carry their place in the walk: first, second,
/// inside, `last_but_one`, last.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall contacts walk.bvh\n  \
    footfall contacts walk.bvh --json > contacts.json")]
pub(crate) struct ContactsArgs {
    /// The recording, .bvh, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    map: MapArgs,
    /// Method of detection
    #[arg(long, value_enum, default_value_t = Method::Kinematic)]
    method: Method,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Heights and speeds of heels and toes
    Kinematic,
    /// Switches of hip and knee angles: initial contacts only; a stance lasts until the other foot's; no steps
    Switching,
}

pub(crate) fn run(args: &ContactsArgs) -> Result<()> {
    let (_, motion) = read_file(&args.input, &args.map.read(None)?)?;
    let report = match args.method {
        Method::Kinematic => {
            let recording = Recording::detected(motion);
            ContactFile::new(&recording.contacts, &recording.walks)
        }
        Method::Switching => {
            switching(&motion).with_context(|| args.input.display().to_string())?
        }
    };
    output::print_report(args.json, &report, |report| text(&args.input, report))
}

/// An event or a step a line.
fn text(input: &Path, report: &ContactFile) -> String {
    let mut lines = vec![format!(
        "{}: {} frames at {} fps, {} steps",
        input.display(),
        report.frames,
        report.fps,
        report.steps.len()
    )];
    lines.extend(report.events.iter().map(|event| {
        let kind = event.kind.replace('_', " ");
        format!(
            "{:8.3} s  frame {:5}  {:5}  {kind}",
            event.time_s, event.frame, event.foot
        )
    }));
    lines.extend(report.steps.iter().map(|step| {
        format!(
            "step on the {:5} foot, frames {:5} to {:5}  {}",
            step.foot,
            step.first,
            step.last,
            step.position.replace('_', " ")
        )
    }));
    lines.join("\n")
}

fn switching(motion: &Retargeted) -> Result<ContactFile> {
    let frames = motion.clip.poses.len();
    let switches = detect_switches(&motion.clip, motion.first_frame)?;
    let events: Vec<GaitEvent> = switches.iter().map(|switch| switch.event()).collect();
    let stances = stances(&switches, frames);
    let [left, right] = stances.each_ref().map(Vec::as_slice);
    let rate = motion.clip.frame_rate_hz;
    let report = ContactFile::from_spans(rate, frames, [left, right], &events);
    Ok(report.with_steps(&walks(&switches, rate)))
}
