//! `footfall synth`: a model walks.

use crate::contact_report::{ContactReport, StepEntry};
use crate::model_file::{read_model, read_style};
use crate::output;
use anyhow::{Context as _, Result, bail, ensure};
use footfall_core::{FrameSpan, Side};
use footfall_model::{GaitModel, GaitStyle};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_synth::{SynthesizedWalk, WalkConfig, synthesize};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

/// Make a walk from a model
///
/// The same model, seed and settings give the same bytes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall synth --model walk.footfall --steps 20 --seed 1 -o out.bvh\n  \
    footfall synth --model walk.footfall --style sad.footstyle:0.7 --style old.footstyle:0.3 -o out.bvh\n  \
    footfall synth --model walk.footfall --steps 40 --speed 1.5 --turn 10 -o out.bvh --contacts out.json")]
pub(crate) struct SynthArgs {
    /// The model
    #[arg(long, value_name = "WALK.footfall")]
    model: PathBuf,
    /// A style to walk in and its weight, 1 when absent; may repeat. Beyond 1 exaggerates, below 0 is the opposite
    #[arg(long = "style", value_name = "STYLE.footstyle[:WEIGHT]")]
    styles: Vec<StyleArg>,
    /// How many steps to take
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    steps: u32,
    /// Which walker, and which of its walks
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Frames per second; the model's when absent
    #[arg(long)]
    fps: Option<f64>,
    /// Speed over the ground in m/s; the corpus' mean when absent
    #[arg(long)]
    speed: Option<f32>,
    /// Turning in degrees per second, positive to the left
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEG_PER_S"
    )]
    turn: f32,
    /// Begin and end standing; otherwise the walk is cut out of a longer one
    #[arg(long)]
    standing: bool,
    /// How far the walker strays from the average: 0 not at all, 1 as in the recordings
    #[arg(long, default_value_t = 1.0)]
    variation: f32,
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

/// A `.footstyle` file and how much of it.
#[derive(Clone, Debug, PartialEq)]
struct StyleArg {
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
                    format!("'{weight}' is no weight ({error}); write FILE.footstyle:0.7")
                })?;
                (path, number)
            }
            _ => (text, 1.0),
        };
        if path.is_empty() {
            return Err("no file; write FILE.footstyle:0.7".to_owned());
        }
        Ok(Self {
            path: path.into(),
            weight,
        })
    }
}

#[derive(Serialize)]
struct StyleReport {
    name: String,
    weight: f64,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    contacts: Option<&'a Path>,
    fps: f64,
    frames: usize,
    seconds: f64,
    steps: u32,
    seed: u64,
    styles: Vec<StyleReport>,
    speed_mps: f32,
    cadence_per_minute: f64,
    warnings: Vec<String>,
}

pub(crate) fn run(args: &SynthArgs) -> Result<()> {
    for output in [Some(&args.output), args.contacts.as_ref()]
        .into_iter()
        .flatten()
    {
        let styles = args.styles.iter().map(|style| style.path.as_path());
        let inputs: Vec<&Path> = styles.chain([args.model.as_path()]).collect();
        output::refuse_overwrite(&inputs, output)?;
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
        args.speed
            .is_none_or(|speed| speed > 0.0 && speed.is_finite()),
        "a walk at {} m/s goes nowhere; give --speed a number above zero",
        args.speed.unwrap_or_default()
    );
    let (model, styles) = dressed(args)?;
    let model = Arc::new(model);
    let mut warnings = Vec::new();
    let [slowest, fastest] = model.speed_range();
    if let Some(speed) = args.speed
        && !(slowest - 1e-3..=fastest + 1e-3).contains(&f64::from(speed))
    {
        warnings.push(format!(
            "{speed} m/s is beyond the recorded walks ({slowest:.2} to {fastest:.2} m/s): the walk is extrapolated"
        ));
    }
    let config = WalkConfig {
        steps: args.steps as usize,
        seed: args.seed,
        variation: args.variation,
        speed_mps: args.speed,
        turn_rate_radps: args.turn.to_radians(),
        frame_rate_hz: args.fps,
        from_standing: args.standing,
    };
    let walk = synthesize(&model, &model.skeleton, &config)
        .with_context(|| args.model.display().to_string())?;
    output::write_atomic(
        &args.output,
        bvh::write(&clip_to_bvh(&walk.clip)).as_bytes(),
    )?;
    if let Some(path) = &args.contacts {
        let text = serde_json::to_string(&contact_report(&walk)).context("the contacts")?;
        output::write_atomic(path, format!("{text}\n").as_bytes())?;
    }
    report(args, &walk, styles, warnings)
}

/// The model in the given styles.
fn dressed(args: &SynthArgs) -> Result<(GaitModel, Vec<StyleReport>)> {
    let model = read_model(&args.model)?;
    if args.styles.is_empty() {
        return Ok((model, Vec::new()));
    }
    let mut styles: Vec<(GaitStyle, f64)> = Vec::new();
    for StyleArg { path, weight } in &args.styles {
        if !weight.is_finite() {
            bail!(
                "{}: a weight of {weight} says nothing; give a number",
                path.display()
            );
        }
        styles.push((read_style(path)?, *weight));
    }
    let weighted: Vec<(&GaitStyle, f64)> = styles.iter().map(|(s, weight)| (s, *weight)).collect();
    let dressed = model
        .styled(&weighted)
        .with_context(|| args.model.display().to_string())?;
    let reports = styles.into_iter().map(|(style, weight)| StyleReport {
        name: style.name,
        weight,
    });
    Ok((dressed, reports.collect()))
}

/// Contacts and steps of a generated walk. It begins and ends in full stride, so every step is inside.
pub(super) fn contact_report(walk: &SynthesizedWalk) -> ContactReport {
    let clip = &walk.clip;
    let stances = Side::BOTH.map(|side| walk.contacts[side.index()].as_slice());
    let mut report = ContactReport::from_spans(
        clip.frame_rate_hz,
        clip.poses.len(),
        stances,
        &walk.events(),
    );
    let mut landings: Vec<(usize, Side)> = Side::BOTH
        .into_iter()
        .flat_map(|side| landings(stances[side.index()], side))
        .collect();
    landings.sort_unstable();
    report.steps = landings
        .windows(2)
        .map(|pair| StepEntry {
            foot: pair[0].1.name().to_owned(),
            first: pair[0].0,
            last: pair[1].0.saturating_sub(1),
            position: "inside".to_owned(),
            walk: 0,
        })
        .collect();
    report
}

/// Frames of initial contact. The walk begins with one of the left foot; the right foot's first stance began before.
fn landings(stances: &[FrameSpan], side: Side) -> Vec<(usize, Side)> {
    stances
        .iter()
        .filter(|stance| side == Side::Left || stance.first > 0)
        .map(|stance| (stance.first, side))
        .collect()
}

fn report(
    args: &SynthArgs,
    walk: &SynthesizedWalk,
    styles: Vec<StyleReport>,
    warnings: Vec<String>,
) -> Result<()> {
    let clip = &walk.clip;
    let seconds = clip.duration_secs();
    let way = match (clip.poses.first(), clip.poses.last()) {
        (Some(first), Some(last)) => (last.root_position - first.root_position)
            .with_y(0.0)
            .length(),
        _ => 0.0,
    };
    let report = Report {
        output: &args.output,
        contacts: args.contacts.as_deref(),
        fps: clip.frame_rate_hz,
        frames: clip.poses.len(),
        seconds,
        steps: args.steps,
        seed: args.seed,
        styles,
        speed_mps: way / seconds as f32,
        cadence_per_minute: 60.0 * f64::from(args.steps) / seconds,
        warnings,
    };
    for warning in &report.warnings {
        output::note(&format!("warning: {warning}"));
    }
    if args.json {
        return output::print_json(&report);
    }
    output::note(&format!(
        "{}: {} steps in {:.2} s, {} frames at {} fps, {:.2} m/s, {:.0} steps a minute",
        args.output.display(),
        report.steps,
        report.seconds,
        report.frames,
        report.fps,
        report.speed_mps,
        report.cadence_per_minute
    ));
    Ok(())
}
