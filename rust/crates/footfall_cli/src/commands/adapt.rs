//! `footfall adapt`: a dozen recorded steps become a style.

use super::train::TrainingProgress;
use super::training_run::{Skipped, TrainingRun, conclude, name_of, skipped};
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use clap::ValueEnum;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::corpus::Corpus;
use footfall_train::read_model_file;
use footfall_train::{AdaptConfig, AdaptMethod, Adapted, adapt_style, shows_steps};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Train a style on a dozen steps
///
/// Adapts a base model to the walks of an index. Any frame rate, body and walker will do: 6 to 12 steps straight ahead are
/// enough, as BVH or glTF (`hero.glb#Walk` selects one of several animations). In-place clips get their travel from the standing feet,
/// and loops are repeated. The style fits only the base model that it was made for.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall adapt --base walk.footfall --corpus index.csv --where style=sad --name sad -o sad.footstyle\n  \
    footfall adapt --base walk.footfall --corpus index.csv --where 'path=me_*' --name me --steps 12 -o me.footstyle\n  \
    footfall synth --model walk.footfall --style sad.footstyle:0.7 -o out.bvh")]
pub(crate) struct AdaptArgs {
    /// The model to start from
    #[arg(long, value_name = "WALK.footfall")]
    base: PathBuf,
    #[command(flatten)]
    corpus: CorpusArgs,
    /// Name of the style
    #[arg(long)]
    name: String,
    /// Use only the first N steps [default: all]
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..))]
    steps: Option<u32>,
    /// Method by which the base is adapted
    #[arg(long, value_enum, default_value_t = MethodArg::Csmaplr)]
    method: MethodArg,
    /// Description of the data for the style's provenance [default: the conditions]
    #[arg(long, value_name = "TEXT")]
    describe: Option<String>,
    /// File to write the style to
    #[arg(short, long, value_name = "STYLE.footstyle")]
    output: PathBuf,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodArg {
    /// One transform for all states, joint by joint, with a weak prior
    Cmllr,
    /// Transforms over a tree of states, each kept near its parent's
    Csmaplr,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    name: &'a str,
    clips: usize,
    subjects: usize,
    steps: usize,
    frames: usize,
    /// Log-likelihood less the prior's charge at every alignment; never falls.
    objectives: &'a [f64],
    /// Log-likelihood of the steps under the base model, under the transforms, and under the style.
    log_likelihoods: [f64; 3],
    /// Groups of states with transforms of their own.
    classes: usize,
    speed_mps: f64,
    cadence_per_minute: f64,
    bytes: usize,
    skipped: Vec<Skipped>,
    warnings: Vec<String>,
    /// Duration of the adaptation alone, without reading the recordings.
    adaptation_seconds: f64,
    seconds: f64,
}

pub(crate) fn run(args: &AdaptArgs) -> Result<()> {
    output::refuse_overwrite(&[&args.base], &args.output)?;
    let run = TrainingRun::begin(&args.corpus, args.describe.as_deref(), &args.output)?;
    ensure!(
        !args.name.trim().is_empty(),
        "a style needs a name; pass one to --name"
    );
    let base = read_model_file(&args.base, GaitModel::from_bytes)?;
    let mut progress = TrainingProgress(output::Progress::new());
    progress.0.stage("reading the corpus", 0);
    let corpus = run.read()?;
    let still = without_steps(&corpus);
    ensure!(
        still.len() < corpus.clips.len(),
        "{}: {} has no two consecutive steps; give walking clips with steps of both feet",
        args.corpus.index.display(),
        listed(&still)
    );
    let config = AdaptConfig {
        method: match args.method {
            MethodArg::Cmllr => AdaptMethod::Cmllr,
            MethodArg::Csmaplr => AdaptMethod::Csmaplr,
        },
        steps: args.steps.map(|steps| steps as usize),
        mirror: false,
    };
    let read = run.seconds();
    let adapted = adapt_style(
        &base,
        &corpus.clips,
        args.name.trim(),
        &config,
        made_from(args, &run, &corpus),
        &mut progress,
    )
    .with_context(|| args.corpus.index.display().to_string())?;
    let seconds = run.seconds();
    let seconds = [seconds - read, seconds];
    let bytes = adapted.style.to_bytes().context("the style")?;
    run.write(&bytes)?;
    progress.0.finish();
    report(args, &corpus, &adapted, bytes.len(), seconds)
}

/// Clips without a walk, by name and length.
fn without_steps(corpus: &Corpus) -> Vec<String> {
    let clips = corpus.clips.iter();
    clips
        .filter(|clip| !shows_steps(&clip.walks))
        .map(|clip| {
            let secs = clip.round_secs();
            format!("{} ({secs:.1} s)", name_of(&clip.row.path))
        })
        .collect()
}

/// The first of many names, and how many more there are.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 5;
    let first = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

fn made_from(args: &AdaptArgs, run: &TrainingRun<'_>, corpus: &Corpus) -> Provenance {
    let mut options = vec![format!("--name '{}'", args.name.trim())];
    options.extend(args.steps.map(|steps| format!("--steps {steps}")));
    options.push(match args.method {
        MethodArg::Cmllr => "--method cmllr".to_owned(),
        MethodArg::Csmaplr => "--method csmaplr".to_owned(),
    });
    let command = format!("footfall adapt --base {}", name_of(&args.base));
    run.provenance(corpus, &command, &[], &options)
}

fn report(
    args: &AdaptArgs,
    corpus: &Corpus,
    adapted: &Adapted,
    bytes: usize,
    [adaptation_seconds, seconds]: [f64; 2],
) -> Result<()> {
    let style = &adapted.style;
    let made_from = &style.provenance;
    let still = without_steps(corpus);
    let unused = (!still.is_empty())
        .then(|| format!("skipped without two consecutive steps: {}", listed(&still)));
    let warnings = unused.into_iter().chain(style.thin_warning()).collect();
    let report = Report {
        output: &args.output,
        name: &style.name,
        clips: made_from.clips,
        subjects: made_from.subjects,
        steps: made_from.steps,
        frames: adapted.frames,
        objectives: &adapted.objectives,
        log_likelihoods: adapted.log_likelihoods,
        classes: adapted.classes.len(),
        speed_mps: style.speed_mps,
        cadence_per_minute: 60.0 * style.cadence_hz,
        bytes,
        skipped: skipped(corpus),
        warnings,
        adaptation_seconds,
        seconds,
    };
    let left_out = report.skipped.iter().map(|skipped| &skipped.reason);
    conclude(args.json, &report, left_out, &report.warnings, |report| {
        vec![format!(
            "{}: '{}' from {} steps in {} clips, {:.2} m/s, {:.0} steps a minute, {bytes} bytes, {adaptation_seconds:.1} s",
            args.output.display(),
            style.name,
            report.steps,
            report.clips,
            report.speed_mps,
            report.cadence_per_minute,
        )]
    })
}
