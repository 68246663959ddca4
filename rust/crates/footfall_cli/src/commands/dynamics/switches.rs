//! `footfall dynamics switches`: when the legs change roles, from joint angles alone.

use crate::motion_input::{MapArgs, read_file};
use crate::output;
use anyhow::{Context as _, Result};
use footfall_motion::switches::detect_switches;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Detect the times at which the legs change roles, from hip and knee angles only
///
/// Heights, speeds and the ground are not used. Frames and times refer to the input file, frame 0 included; `foot` is the foot
/// that lands. A recording without a walk has no switches.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall dynamics switches walk.bvh\n  \
    footfall dynamics switches walk.bvh --json > switches.json")]
pub(crate) struct SwitchesArgs {
    /// The recording, .bvh, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    fps: f64,
    frames: usize,
    switches: Vec<Entry>,
}

#[derive(Serialize)]
struct Entry {
    frame: usize,
    time_s: f64,
    /// `left` or `right`: the foot that lands.
    foot: &'static str,
}

pub(crate) fn run(args: &SwitchesArgs) -> Result<()> {
    let (_, motion) = read_file(&args.input, &args.map.read(None)?)?;
    let fps = motion.clip.frame_rate_hz;
    let switches = detect_switches(&motion.clip, motion.first_frame)
        .with_context(|| args.input.display().to_string())?;
    let report = Report {
        fps,
        frames: motion.clip.poses.len(),
        switches: switches
            .iter()
            .map(|switch| Entry {
                frame: switch.frame,
                time_s: switch.frame as f64 / fps,
                foot: switch.side.name(),
            })
            .collect(),
    };
    output::print_report(args.json, &report, |report| text(&args.input, report))
}

/// A switch a line.
fn text(input: &Path, report: &Report) -> String {
    let mut lines = vec![format!(
        "{}: {} frames at {} fps, {} switches",
        input.display(),
        report.frames,
        report.fps,
        report.switches.len()
    )];
    lines.extend(report.switches.iter().map(|switch| {
        format!(
            "{:8.3} s  frame {:5}  onto the {} foot",
            switch.time_s, switch.frame, switch.foot
        )
    }));
    lines.join("\n")
}
