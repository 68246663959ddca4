//! `footfall retarget`: any body to the canonical body.

use crate::fit_facts::{HeadFacts, HipFacts};
use crate::motion_input::{MapArgs, read_file};
use crate::output;
use anyhow::Result;
use footfall_core::Joint;
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::retarget::normalised_start;
use serde::Serialize;
use std::path::PathBuf;

/// Retarget a recording to the canonical body
///
/// Writes a BVH file with the joints of Godot's humanoid profile: metres, Y up, floor at 0, the first frame of the motion
/// at the origin facing +Z, a T-pose at zero rotations. Directions of limbs and trunk are kept; travel and height are
/// scaled by leg length. Frames keep their numbers unless --fps is given.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall retarget walk.bvh -o canonical.bvh\n  \
    footfall retarget walk.bvh -o canonical.bvh --fps 60\n  \
    footfall retarget robot.bvh -o canonical.bvh --map robot.toml     (lines such as Hips = \"pelvis\")")]
pub(crate) struct RetargetArgs {
    /// The recording, .bvh, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Output file
    #[arg(short, long, value_name = "OUT.bvh")]
    output: PathBuf,
    /// Frames per second of the output [default: the input's]
    #[arg(long)]
    fps: Option<f64>,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    output: PathBuf,
    skeleton: String,
    fps: f64,
    frames: usize,
    /// Frames before this one are no motion.
    first_motion_frame: usize,
    metres_per_unit: f32,
    /// Canonical joints that the file does not have.
    absent_joints: Vec<&'static str>,
    /// The finding about the hip joints; absent with --as-recorded.
    #[serde(skip_serializing_if = "Option::is_none")]
    hip_joints: Option<HipFacts>,
    /// The finding about neck and head; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    head: Option<HeadFacts>,
}

pub(crate) fn run(args: &RetargetArgs) -> Result<()> {
    output::refuse_overwrite(&[&args.input], &args.output)?;
    let (_, retargeted) = read_file(&args.input, &args.map.read(args.fps)?)?;
    let clip = normalised_start(&retargeted.clip, retargeted.first_frame);
    output::write_atomic(&args.output, bvh::write(&clip_to_bvh(&clip)).as_bytes())?;
    let report = Report {
        output: args.output.clone(),
        skeleton: retargeted.report.map.clone(),
        fps: clip.frame_rate_hz,
        frames: clip.poses.len(),
        first_motion_frame: retargeted.first_frame,
        metres_per_unit: retargeted.report.scale,
        absent_joints: Joint::ALL
            .into_iter()
            .filter(|joint| retargeted.report.source_joints[joint.index()].is_none())
            .map(Joint::name)
            .collect(),
        hip_joints: HipFacts::of(&retargeted.report.fit.hip_centres),
        head: retargeted.report.fit.head.as_ref().map(HeadFacts::of),
    };
    if args.json {
        return output::print_json(&report);
    }
    output::note(&format!(
        "{}: {} frames at {} fps on the canonical body, from a {} skeleton ({:.4} m a unit)",
        report.output.display(),
        report.frames,
        report.fps,
        report.skeleton,
        report.metres_per_unit
    ));
    if let Some(hip_joints) = &report.hip_joints {
        output::note(&format!("hip joints {}", hip_joints.line));
    }
    if let Some(head) = &report.head {
        output::note(&format!("head: {}", head.line));
    }
    Ok(())
}
