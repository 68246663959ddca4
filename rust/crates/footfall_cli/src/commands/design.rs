//! `footfall design`: a style from a sheet and captured walks.

mod corpus_run;
mod reference;

use crate::motion_input::{SkeletonArgs, read_recording};
use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_core::Clip;
use footfall_design::{StyleSheet, design, shipped};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::corpus::Where;
use footfall_motion::retarget::normalised_start;
use footfall_motion::steps::segment_walks;
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Apply a style sheet to captured walks
///
/// A style sheet is a short TOML file of changes: posture, swing, stride, cadence, sway, landing of the feet.
/// One recording gives one file; a corpus gives a folder with an index, from which `footfall adapt` trains the style.
/// Shipped sheets are proud, decided, sad, topmodel, drunk, cool, afraid, tiptoeing, heavy, `in_a_hurry`, manly, and
/// template.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall design --sheet sad walk.bvh -o sad.bvh\n  \
    footfall design --print template > mine.toml                     (a sheet to begin with)\n  \
    footfall design --keys                                           (every key, its unit and range)\n  \
    footfall design --sheet mine.toml --corpus index.csv --where category=neutral_walk --steps 24 -o mine")]
pub(crate) struct DesignArgs {
    /// One recording of a walk
    #[arg(value_name = "IN", conflicts_with_all = ["corpus", "conditions"])]
    input: Option<PathBuf>,
    /// Style sheet: a file, or the name of a shipped sheet
    #[arg(long, value_name = "SHEET.toml", required_unless_present_any = ["keys", "print"])]
    sheet: Option<String>,
    /// Index of the recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Condition on a column, for example `category=neutral_walk`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    conditions: Vec<Where>,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Minimum total number of steps from a corpus
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    steps: u32,
    /// Seed of a sheet's irregular steps
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Output file, or output folder for a corpus
    #[arg(short, long, value_name = "OUT", required_unless_present_any = ["keys", "print"])]
    output: Option<PathBuf>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
    /// Print all keys of a sheet as a Markdown page and exit
    #[arg(long, conflicts_with_all = ["print", "json"])]
    keys: bool,
    /// Print a shipped sheet and exit
    #[arg(long, value_name = "NAME", conflicts_with = "json")]
    print: Option<String>,
}

/// Outcome for one recording.
#[derive(Debug, Serialize)]
struct Designed {
    output: PathBuf,
    style: String,
    source: PathBuf,
    frames: usize,
    fps: f64,
    steps: usize,
    speed_mps: f64,
    steps_per_minute: Option<f64>,
}

pub(crate) fn run(args: &DesignArgs) -> Result<()> {
    if args.keys {
        return output::print_text(reference::page().trim_end());
    }
    if let Some(name) = &args.print {
        return output::print_text(shipped_text(name)?.trim_end());
    }
    let (Some(sheet), Some(target)) = (&args.sheet, &args.output) else {
        bail!("give --sheet and -o; see `footfall design --help`");
    };
    let sheet = read_sheet(sheet)?;
    match (&args.input, &args.corpus) {
        (Some(input), None) => run_single(args, &sheet, input, target),
        (None, Some(corpus)) => corpus_run::run(args, &sheet, corpus, target),
        _ => bail!("give one recording, or --corpus with an index; see `footfall design --help`"),
    }
}

fn run_single(args: &DesignArgs, sheet: &StyleSheet, input: &Path, target: &Path) -> Result<()> {
    output::refuse_overwrite(&[input], target)?;
    let recording = read_recording(input, &args.fit.options())?;
    let clip = design(
        &recording.retargeted.clip,
        &recording.contacts,
        &recording.walks,
        sheet,
        args.seed,
    )
    .with_context(|| input.display().to_string())?;
    let designed = write_clip(&clip, sheet, input, target)?;
    if args.json {
        return output::print_json(&designed);
    }
    output::note(&describe(&designed));
    Ok(())
}

fn describe(designed: &Designed) -> String {
    format!(
        "{}: {} steps at {:.2} m/s{}",
        designed.output.display(),
        designed.steps,
        designed.speed_mps,
        designed
            .steps_per_minute
            .map_or_else(String::new, |rate| format!(", {rate:.0} a minute"))
    )
}

/// Writes a clip and measures it as a reader will find it.
fn write_clip(clip: &Clip, sheet: &StyleSheet, source: &Path, target: &Path) -> Result<Designed> {
    let clip = normalised_start(clip, 0);
    output::write_atomic(target, bvh::write(&clip_to_bvh(&clip)).as_bytes())?;
    let contacts = detect_contacts(&clip, &ContactConfig::from_frame(0));
    let walks = segment_walks(&clip, &contacts);
    let steps: Vec<_> = walks.iter().flat_map(|walk| &walk.steps).collect();
    let frames: usize = steps.iter().map(|step| step.frames()).sum();
    let way = clip
        .poses
        .first()
        .zip(clip.poses.last())
        .map_or(0.0, |(first, last)| {
            (last.root_position - first.root_position)
                .with_y(0.0)
                .length()
        });
    Ok(Designed {
        output: target.to_owned(),
        style: sheet.name.clone(),
        source: source.to_owned(),
        frames: clip.poses.len(),
        fps: clip.frame_rate_hz,
        steps: steps.len(),
        speed_mps: f64::from(way) / clip.duration_secs().max(1e-6),
        steps_per_minute: (frames > 0)
            .then(|| 60.0 * steps.len() as f64 * clip.frame_rate_hz / frames as f64),
    })
}

/// A sheet from a file, or a shipped one by name.
fn read_sheet(name: &str) -> Result<StyleSheet> {
    let path = Path::new(name);
    let looks_like_a_file = path.extension().is_some() || path.components().count() > 1;
    let text = if looks_like_a_file || path.is_file() {
        fs::read_to_string(path).with_context(|| format!("{name}: cannot read the style sheet"))?
    } else {
        shipped_text(name)?.to_owned()
    };
    let mut sheet = StyleSheet::parse(&text).with_context(|| name.to_owned())?;
    if sheet.name.is_empty() {
        sheet.name = path
            .file_stem()
            .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    }
    Ok(sheet)
}

fn shipped_text(name: &str) -> Result<&'static str> {
    shipped::text(name).with_context(|| {
        let names: Vec<&str> = shipped::SHEETS.iter().map(|(name, _)| *name).collect();
        format!(
            "there is no shipped sheet \"{name}\", only {}; pass a sheet of your own as a file, such as {name}.toml",
            names.join(", ")
        )
    })
}
