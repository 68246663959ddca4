//! `footfall dynamics synth`: a switching model walks.

use crate::commands::synth::contact_report;
use crate::model_file::read_dynamics;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_synth::{SwitchingWalkConfig, synthesize_switching};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Make a walk from a switching model
///
/// The same model, seed and settings give the same bytes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall dynamics synth --model gait.footdyn --seconds 10 --seed 1 -o out.bvh")]
pub(crate) struct DynamicsSynthArgs {
    /// The model
    #[arg(long, value_name = "GAIT.footdyn")]
    model: PathBuf,
    /// How long to walk
    #[arg(long, default_value_t = 10.0)]
    seconds: f64,
    /// Which of its walks
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Speed over the ground in m/s; that of the recordings when absent
    #[arg(long)]
    speed: Option<f32>,
    /// How far steps stray from the average: 0 not at all, 1 as in the recordings
    #[arg(long, default_value_t = 1.0)]
    variation: f32,
    /// Turning in degrees per second, positive to the left
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEG_PER_S"
    )]
    turn: f32,
    /// Frames per second; the model's when absent
    #[arg(long)]
    fps: Option<f64>,
    /// Where to write
    #[arg(short, long, value_name = "OUT.bvh")]
    output: PathBuf,
    /// Where to write the contacts, as `footfall contacts --json` prints them
    #[arg(long, value_name = "OUT.json")]
    contacts: Option<PathBuf>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    contacts: Option<&'a Path>,
    fps: f64,
    frames: usize,
    seconds: f64,
    seed: u64,
    speed_mps: f64,
}

pub(crate) fn run(args: &DynamicsSynthArgs) -> Result<()> {
    for output in [Some(&args.output), args.contacts.as_ref()]
        .into_iter()
        .flatten()
    {
        output::refuse_overwrite(&[&args.model], output)?;
    }
    ensure!(
        args.contacts.as_ref() != Some(&args.output),
        "{} is both the motion and the contacts; give --contacts another name",
        args.output.display()
    );
    ensure!(
        args.fps.is_none_or(|fps| (1.0..=1000.0).contains(&fps)),
        "{} frames per second cannot be written; give --fps a number from 1 to 1000",
        args.fps.unwrap_or_default()
    );
    ensure!(
        (0.1..=7200.0).contains(&args.seconds),
        "a walk of {} seconds cannot be written; give --seconds a number from 0.1 to 7200",
        args.seconds
    );
    let model = read_dynamics(&args.model)?;
    let model = Arc::new(model);
    let config = SwitchingWalkConfig {
        seconds: args.seconds,
        seed: args.seed,
        variation: args.variation,
        speed_mps: args.speed,
        turn_rate_radps: args.turn.to_radians(),
        frame_rate_hz: args.fps,
    };
    let walk = synthesize_switching(&model, &model.skeleton, &config)
        .with_context(|| args.model.display().to_string())?;
    output::write_atomic(
        &args.output,
        bvh::write(&clip_to_bvh(&walk.clip)).as_bytes(),
    )?;
    if let Some(path) = &args.contacts {
        let text = serde_json::to_string(&contact_report(&walk)).context("the contacts")?;
        output::write_atomic(path, format!("{text}\n").as_bytes())?;
    }
    let seconds = walk.clip.duration_secs();
    let travel = walk.clip.poses.last().map_or(0.0, |pose| {
        f64::from(pose.root_position.x.hypot(pose.root_position.z))
    });
    let report = Report {
        output: &args.output,
        contacts: args.contacts.as_deref(),
        fps: walk.clip.frame_rate_hz,
        frames: walk.clip.poses.len(),
        seconds,
        seed: args.seed,
        speed_mps: travel / seconds.max(1e-9),
    };
    if args.json {
        return output::print_json(&report);
    }
    output::note(&format!(
        "{}: {:.2} s at {} fps, {:.2} m/s",
        args.output.display(),
        report.seconds,
        report.fps,
        report.speed_mps
    ));
    Ok(())
}
