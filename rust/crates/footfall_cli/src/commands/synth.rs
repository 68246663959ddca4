//! `footfall synth`: a model walks.

mod controls;

use crate::commands::training_run::conclude;
use crate::commands::walk_output::{WalkArgs, WalkFacts};
use anyhow::{Context as _, Result, bail, ensure};
use footfall_core::EventKind;
use footfall_model::{GaitModel, GaitStyle};
use footfall_synth::{
    GaitChoice, StandConfig, SynthesizedWalk, WalkConfig, synthesize, synthesize_moves,
    synthesize_standing,
};
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

/// Longest useful recording of a standing person.
const LONGEST_STAND_SECS: f64 = 3600.0;

/// Generate a walk from a model
///
/// The same model, seed and settings give the same bytes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall synth --model walk.footfall --steps 20 --seed 1 -o out.bvh\n  \
    footfall synth --model walk.footfall --style sad.footstyle:0.7 --style old.footstyle:0.3 -o out.bvh\n  \
    footfall synth --model walk.footfall --steps 40 --speed 1.5 --turn 10 -o out.bvh --contacts out.json\n  \
    footfall synth --model walk.footfall --speed 0 --seconds 60 --seed 4 -o standing.bvh")]
pub(crate) struct SynthArgs {
    /// The model
    #[arg(long, value_name = "WALK.footfall")]
    model: PathBuf,
    /// Style and its weight, 1 by default; repeatable. More than 1 exaggerates, less than 0 gives the opposite
    #[arg(long = "style", value_name = "STYLE.footstyle[:WEIGHT]")]
    styles: Vec<StyleArg>,
    /// Number of steps
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    steps: u32,
    /// Begin and end standing; otherwise the walk is cut from a longer one
    #[arg(long)]
    standing: bool,
    /// Controls over time: a table with the columns `time_s`, `speed_mps`, `turn_dps`, `direction_deg`, gait, crouch and `jump_m`. A row holds until the next,
    /// the last for one second; missing columns keep their defaults. The walk begins standing
    #[arg(long, value_name = "MOVES.csv", conflicts_with_all = ["steps", "standing", "seconds", "speed", "turn", "direction", "gait"])]
    controls: Option<PathBuf>,
    /// Gait; auto runs above about 2 m/s, if the model can
    #[arg(long, value_enum, default_value_t = GaitArg::Auto)]
    gait: GaitArg,
    /// Seconds to stand, with `--speed 0`
    #[arg(long, default_value_t = 20.0, value_name = "SECONDS")]
    seconds: f64,
    /// Amount of motion while standing, with `--speed 0`: 0 none, 1 as in the recordings
    #[arg(long, default_value_t = 1.0, value_name = "AMOUNT")]
    standing_motion: f32,
    #[command(flatten)]
    walk: WalkArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// The gait that is requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum GaitArg {
    Auto,
    Walk,
    Run,
}

impl From<GaitArg> for GaitChoice {
    fn from(gait: GaitArg) -> Self {
        match gait {
            GaitArg::Auto => Self::Auto,
            GaitArg::Walk => Self::Walk,
            GaitArg::Run => Self::Run,
        }
    }
}

/// A `.footstyle` file and how much of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StyleArg {
    path: PathBuf,
    weight: f64,
}

impl FromStr for StyleArg {
    type Err = String;

    /// The weight stands behind the last colon, if a number does.
    fn from_str(text: &str) -> Result<Self, String> {
        let (path, weight) = match text.rsplit_once(':') {
            Some((path, weight)) if !weight.contains(['/', '\\']) => {
                let number: f64 = weight.parse().map_err(|error| {
                    format!("'{weight}' is not a weight ({error}); write FILE.footstyle:0.7")
                })?;
                (path, number)
            }
            _ => (text, 1.0),
        };
        if path.is_empty() {
            return Err("there is no file name; write FILE.footstyle:0.7".to_owned());
        }
        Ok(Self {
            path: path.into(),
            weight,
        })
    }
}

#[derive(Serialize)]
pub(crate) struct StyleReport {
    name: String,
    weight: f64,
}

#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    walk: WalkFacts<'a>,
    steps: u32,
    styles: Vec<StyleReport>,
    cadence_per_minute: f64,
    warnings: Vec<String>,
}

pub(crate) fn run(args: &SynthArgs) -> Result<()> {
    let styles = args.styles.iter().map(|style| style.path.as_path());
    let inputs: Vec<&Path> = styles.chain([args.model.as_path()]).collect();
    let inputs: Vec<&Path> = inputs.into_iter().chain(args.controls.as_deref()).collect();
    let stands = args.walk.speed == Some(0.0);
    if !stands {
        args.walk.check_speed()?;
    }
    args.walk.check(&inputs)?;
    let (model, styles) = dressed(&args.model, &args.styles)?;
    let model = Arc::new(model);
    if let Some(table) = &args.controls {
        return follow(args, table, &model, styles);
    }
    if stands {
        return stand(args, &model, styles);
    }
    let speed = args.walk.speed;
    let warnings = speed.and_then(|speed| beyond_recordings(&model, args.gait, speed));
    let config = WalkConfig {
        steps: args.steps as usize,
        seed: args.walk.seed,
        variation: args.walk.variation,
        speed_mps: args.walk.speed,
        turn_rate_radps: args.walk.turn.to_radians(),
        direction_rad: args.walk.direction.to_radians(),
        frame_rate_hz: args.walk.fps,
        from_standing: args.standing,
        gait: args.gait.into(),
    };
    let walk = synthesize(&model, &model.skeleton, &config)
        .with_context(|| args.model.display().to_string())?;
    report(
        args,
        args.steps,
        &walk,
        styles,
        warnings.into_iter().collect(),
    )
}

/// Returns a warning if a speed is outside the recorded range of walks, or of runs where the gait may be a run.
fn beyond_recordings(model: &GaitModel, gait: GaitArg, speed_mps: f32) -> Option<String> {
    let running = model.running.as_deref();
    let runs = running.filter(|_| gait != GaitArg::Walk);
    let walks = (gait != GaitArg::Run || runs.is_none()).then_some(model);
    let ranges = [("walks", walks), ("runs", runs)];
    let mut recorded = Vec::new();
    for (name, model) in ranges {
        let Some(model) = model else { continue };
        let [slowest, fastest] = model.speed_range();
        if (slowest - 1e-3..=fastest + 1e-3).contains(&f64::from(speed_mps)) {
            return None;
        }
        recorded.push(format!("{name} ({slowest:.2} to {fastest:.2} m/s)"));
    }
    Some(format!(
        "{speed_mps} m/s is beyond the recorded {}: the motion is extrapolated",
        recorded.join(" and ")
    ))
}

/// A walk with the controls of a table.
fn follow(
    args: &SynthArgs,
    table: &Path,
    model: &Arc<GaitModel>,
    styles: Vec<StyleReport>,
) -> Result<()> {
    let table = controls::read(table)?;
    let config = StandConfig {
        seconds: table.seconds,
        seed: args.walk.seed,
        variation: args.walk.variation,
        motion: args.standing_motion,
        frame_rate_hz: args.walk.fps,
    };
    let walk = synthesize_moves(model, &model.skeleton, &table.moves, &config)
        .with_context(|| args.model.display().to_string())?;
    let landings = walk.events().into_iter();
    let steps = landings.filter(|event| event.kind == EventKind::InitialContact);
    report(
        args,
        steps.count() as u32,
        &walk,
        styles,
        table.warnings(model),
    )
}

/// Standing person, for the requested time.
fn stand(args: &SynthArgs, model: &Arc<GaitModel>, styles: Vec<StyleReport>) -> Result<()> {
    ensure!(
        (0.0..=LONGEST_STAND_SECS).contains(&args.seconds),
        "cannot stand for {} seconds; set --seconds to {LONGEST_STAND_SECS} at most",
        args.seconds
    );
    let config = StandConfig {
        seconds: args.seconds,
        seed: args.walk.seed,
        variation: args.walk.variation,
        motion: args.standing_motion,
        frame_rate_hz: args.walk.fps,
    };
    let standing = synthesize_standing(model, &model.skeleton, &config)
        .with_context(|| args.model.display().to_string())?;
    let mut warnings = Vec::new();
    if model.standing.is_none() {
        warnings.push(format!(
            "{} has no standing motion: the pose is still; train it with --standing",
            args.model.display()
        ));
    }
    report(args, 0, &standing, styles, warnings)
}

/// The model in the given styles.
pub(crate) fn dressed(path: &Path, styles: &[StyleArg]) -> Result<(GaitModel, Vec<StyleReport>)> {
    let model = read_model_file(path, GaitModel::from_bytes)?;
    if styles.is_empty() {
        return Ok((model, Vec::new()));
    }
    let (base, chosen) = (path, styles);
    let mut styles: Vec<(GaitStyle, f64)> = Vec::new();
    for StyleArg { path, weight } in chosen {
        if !weight.is_finite() {
            bail!(
                "{}: the weight {weight} is not finite; give a number",
                path.display()
            );
        }
        styles.push((read_model_file(path, GaitStyle::from_bytes)?, *weight));
    }
    let weighted: Vec<(&GaitStyle, f64)> = styles.iter().map(|(s, weight)| (s, *weight)).collect();
    let dressed = model
        .styled(&weighted)
        .with_context(|| base.display().to_string())?;
    let reports = styles.into_iter().map(|(style, weight)| StyleReport {
        name: style.name,
        weight,
    });
    Ok((dressed, reports.collect()))
}

fn report(
    args: &SynthArgs,
    steps: u32,
    walk: &SynthesizedWalk,
    styles: Vec<StyleReport>,
    warnings: Vec<String>,
) -> Result<()> {
    let facts = args.walk.write(walk)?;
    let report = Report {
        cadence_per_minute: 60.0 * f64::from(steps) / facts.seconds.max(f64::MIN_POSITIVE),
        walk: facts,
        steps,
        styles,
        warnings,
    };
    let all = core::iter::empty::<&str>();
    conclude(args.json, &report, all, &report.warnings, |report| {
        vec![format!(
            "{}: {} steps in {:.2} s, {} frames at {} fps, {:.2} m/s, {:.0} steps a minute",
            args.walk.output.display(),
            report.steps,
            report.walk.seconds,
            report.walk.frames,
            report.walk.fps,
            report.walk.speed_mps,
            report.cadence_per_minute
        )]
    })
}
