//! `footfall dynamics synth`: a switching model walks.

use crate::commands::walk_output::WalkArgs;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_model::DynamicsModel;
use footfall_synth::{SwitchingWalkConfig, synthesize_switching};
use footfall_train::read_model_file;
use std::path::PathBuf;
use std::sync::Arc;

/// Generate a walk from a switching model
///
/// The same model, seed and settings give the same bytes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall dynamics synth --model gait.footdyn --seconds 10 --seed 1 -o out.bvh")]
pub(crate) struct DynamicsSynthArgs {
    /// The model
    #[arg(long, value_name = "GAIT.footdyn")]
    model: PathBuf,
    /// Length of the walk, seconds
    #[arg(long, default_value_t = 10.0)]
    seconds: f64,
    #[command(flatten)]
    walk: WalkArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &DynamicsSynthArgs) -> Result<()> {
    args.walk.check_speed()?;
    args.walk.check(&[&args.model])?;
    ensure!(
        (0.1..=7200.0).contains(&args.seconds),
        "cannot write a walk of {} seconds; set --seconds to 0.1 to 7200",
        args.seconds
    );
    let model = read_model_file(&args.model, DynamicsModel::from_bytes)?;
    let model = Arc::new(model);
    let config = SwitchingWalkConfig {
        seconds: args.seconds,
        seed: args.walk.seed,
        variation: args.walk.variation,
        speed_mps: args.walk.speed,
        turn_rate_radps: args.walk.turn.to_radians(),
        direction_rad: args.walk.direction.to_radians(),
        frame_rate_hz: args.walk.fps,
    };
    let walk = synthesize_switching(&model, &model.skeleton, &config)
        .with_context(|| args.model.display().to_string())?;
    let facts = args.walk.write(&walk)?;
    if args.json {
        return output::print_json(&facts);
    }
    output::note(&format!(
        "{}: {:.2} s at {} fps, {:.2} m/s",
        args.walk.output.display(),
        facts.seconds,
        facts.fps,
        facts.speed_mps
    ));
    Ok(())
}
