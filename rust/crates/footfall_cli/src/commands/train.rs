//! `footfall train`: a corpus becomes a model.

mod moves;

use crate::commands::inspect::model::RunningFacts;
use crate::commands::inspect::moves::{CrouchFacts, JumpFacts};
use crate::commands::training_run::{Skipped, TrainingRun, conclude, skipped, terms};
use crate::motion_input::CorpusArgs;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use clap::ValueEnum;
use footfall_core::StepPosition;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::corpus::{Corpus, Where};
use footfall_prob::windows::Windows;
use footfall_train::standing::{self, LearnedStanding, StandingClip};
use footfall_train::{ContextReport, EmConfig, TrainConfig, Trained, learn_running, train_average};
use moves::Moves;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Train an average walk
///
/// Reads the recordings of an index (columns path, category, style and subject, paths relative to the index), detects
/// their steps and trains one model of the left and the right step. `*` in a condition stands for any run of characters;
/// all conditions must hold.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall train --corpus index.csv --where category=neutral_walk -o walk.footfall\n  \
    footfall train --corpus index.csv --where category=neutral_walk --where 'path=cmu/*' -o walk.footfall\n  \
    footfall train --corpus index.csv --where category=neutral_walk --standing category=idle -o walk.footfall\n  \
    footfall train --corpus index.csv --where category=neutral_walk --running category=running -o locomotion.footfall")]
pub(crate) struct TrainArgs {
    #[command(flatten)]
    corpus: CorpusArgs,
    /// Condition on recordings of people who stand, for example `category=idle`; repeatable. The model learns standing motion from them;
    /// without them it stands still
    #[arg(long = "standing", value_name = "COLUMN=VALUE")]
    standing: Vec<Where>,
    /// Condition on recordings in which people run, for example `category=running`; repeatable. The model learns running from
    /// them, and without them it only walks. People with fewer than 40 steps adapt the run of those with more
    #[arg(long = "running", value_name = "COLUMN=VALUE")]
    running: Vec<Where>,
    /// Condition on recordings of two-footed jumps out of standing, for example `category=jumping`; repeatable
    #[arg(long = "jumping", value_name = "COLUMN=VALUE")]
    jumping: Vec<Where>,
    /// Condition on recordings in which people walk upright and crouched, for example `path=o3de/Crouching1.bvh`; repeatable
    #[arg(long = "crouching", value_name = "COLUMN=VALUE")]
    crouching: Vec<Where>,
    /// File to write the model to
    #[arg(short, long, value_name = "WALK.footfall")]
    output: PathBuf,
    /// Frames per second of the model
    #[arg(long, default_value_t = 60.0)]
    fps: f64,
    /// Time differences of the model
    #[arg(long, value_enum, default_value_t = WindowsArg::Compact)]
    windows: WindowsArg,
    /// Description of the data for the model's provenance [default: the conditions]
    #[arg(long, value_name = "TEXT")]
    describe: Option<String>,
    /// Maximum number of iterations of expectation-maximisation
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..=500))]
    iterations: u16,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum WindowsArg {
    /// Δ² over frames t−2, t, t+2, as printed in the paper
    Paper,
    /// Δ² over frames t−1, t, t+1
    Compact,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    clips: usize,
    subjects: usize,
    steps: usize,
    frames: usize,
    /// Total log-likelihood at every iteration.
    log_likelihoods: &'a [f64],
    /// The same as recorded, after every round of the walkers' transforms.
    adaptive_log_likelihoods: &'a [f64],
    contexts: Contexts<'a>,
    speed_range_mps: [f64; 2],
    cadence_range_per_minute: [f64; 2],
    /// Seconds in which people stand, by person; nothing where the model stands still.
    standing_seconds: BTreeMap<String, f64>,
    /// Running; nothing where the model only walks.
    running: Option<RunningFacts>,
    /// Jumps off both feet and crouching; empty if there are none.
    jumping: Option<JumpFacts>,
    crouching: Option<CrouchFacts>,
    /// Recordings that could not be used, and why.
    skipped: Vec<Skipped>,
    warnings: Vec<String>,
    seconds: f64,
}

/// Counts of the steps that share a model.
#[derive(Serialize)]
struct Contexts<'a> {
    /// Steps seen by place in the walk (left, right), mirrored ones included.
    seen: BTreeMap<&'static str, [usize; 2]>,
    /// Leaves of the tree of each state's output.
    output_leaves: &'a [usize],
    /// Leaves of the tree of durations.
    duration_leaves: usize,
    /// Different step models left of ten.
    models: usize,
    /// Questions that the trees ask.
    questions: &'a [String],
}

impl<'a> Contexts<'a> {
    fn of(report: &'a ContextReport) -> Self {
        let places = StepPosition::ALL.iter().zip(report.seen.chunks_exact(2));
        Self {
            seen: places
                .map(|(place, seen)| (place.name(), [seen[0], seen[1]]))
                .collect(),
            output_leaves: &report.output_leaves,
            duration_leaves: report.duration_leaves,
            models: report.models,
            questions: &report.questions,
        }
    }
}

pub(crate) fn run(args: &TrainArgs) -> Result<()> {
    let run = TrainingRun::begin(&args.corpus, args.describe.as_deref(), &args.output)?;
    ensure!(
        (20.0..=240.0).contains(&args.fps),
        "cannot train a model at {} frames per second; set --fps to 20 to 240",
        args.fps
    );
    let mut progress = TrainingProgress(output::Progress::new());
    progress.0.stage("reading the corpus", 0);
    let corpus = run.read()?;
    let standing = run.read_further(&args.standing)?;
    let running = run.read_further(&args.running)?;
    let moves = Moves::read(args, &run)?;
    let others = [standing.as_ref(), running.as_ref()];
    let others = others.into_iter().chain(moves.corpora()).flatten();
    let all: Vec<&Corpus> = others.chain([&corpus]).collect();
    let made_from = Provenance {
        terms: terms(&all),
        ..provenance(args, &run, &corpus)
    };
    let mut trained = train_average(&corpus.clips, &config(args), made_from, &mut progress)
        .with_context(|| args.corpus.index.display().to_string())?;
    let standing = match standing {
        Some(standing) => Some(learn_standing(&standing, &trained.model, args)?),
        None => None,
    };
    trained.model.standing = standing.as_ref().map(|learned| learned.model.clone());
    trained.model.running = match &running {
        Some(running) => {
            let walk = &trained.model;
            let made_from = provenance(args, &run, running);
            Some(Box::new(running_of(
                walk,
                running,
                args,
                made_from,
                &mut progress,
            )?))
        }
        None => None,
    };
    moves.learn(args, &mut trained.model)?;
    let bytes = trained.model.to_bytes().context("the trained model")?;
    run.write(&bytes)?;
    progress.0.finish();
    report(args, &corpus, &trained, standing.as_ref(), run.seconds())
}

fn running_of(
    walk: &GaitModel,
    corpus: &Corpus,
    args: &TrainArgs,
    made_from: Provenance,
    progress: &mut TrainingProgress,
) -> Result<GaitModel> {
    learn_running(walk, &corpus.clips, &config(args), made_from, progress).with_context(|| {
        format!(
            "{}: the recordings of --running show no run of several steps; widen it",
            args.corpus.index.display()
        )
    })
}

fn learn_standing(corpus: &Corpus, walk: &GaitModel, args: &TrainArgs) -> Result<LearnedStanding> {
    let clips: Vec<StandingClip> = corpus
        .clips
        .iter()
        .map(|clip| StandingClip::new(clip.row.subject(), &clip.retargeted))
        .collect();
    standing::learn(&clips, walk).with_context(|| {
        format!(
            "{}: the recordings of --standing have no several seconds of upright standing with hanging arms; widen it",
            args.corpus.index.display()
        )
    })
}

/// Provenance of what is learned from a corpus of the run.
fn provenance(args: &TrainArgs, run: &TrainingRun<'_>, corpus: &Corpus) -> Provenance {
    let further: [(&str, &[Where]); 4] = [
        ("standing", &args.standing),
        ("running", &args.running),
        ("jumping", &args.jumping),
        ("crouching", &args.crouching),
    ];
    let windows = match args.windows {
        WindowsArg::Paper => "paper",
        WindowsArg::Compact => "compact",
    };
    let options = [
        format!("--fps {}", args.fps),
        format!("--windows {windows}"),
        format!("--iterations {}", args.iterations),
    ];
    run.provenance(corpus, "footfall train", &further, &options)
}

fn config(args: &TrainArgs) -> TrainConfig {
    TrainConfig {
        frame_rate_hz: args.fps,
        windows: match args.windows {
            WindowsArg::Paper => Windows::Paper,
            WindowsArg::Compact => Windows::Compact,
        },
        mirror: true,
        em: EmConfig {
            max_iterations: usize::from(args.iterations),
            min_gain_per_frame: 1e-3,
        },
    }
}

fn report(
    args: &TrainArgs,
    corpus: &Corpus,
    trained: &Trained,
    standing: Option<&LearnedStanding>,
    seconds: f64,
) -> Result<()> {
    let made_from = &trained.model.provenance;
    let mut warnings = Vec::new();
    if made_from.subjects == 1 {
        warnings.push(
            "all steps are of one subject: walkers will differ only as much as that subject's steps; add recordings of others"
                .to_owned(),
        );
    }
    let report = Report {
        output: &args.output,
        clips: made_from.clips,
        subjects: made_from.subjects,
        steps: made_from.steps,
        frames: trained.frames,
        log_likelihoods: &trained.log_likelihoods,
        adaptive_log_likelihoods: &trained.adaptive_log_likelihoods,
        contexts: Contexts::of(&trained.contexts),
        speed_range_mps: trained.model.speed_range(),
        cadence_range_per_minute: trained.model.speed.cadence_range_hz.map(|hz| 60.0 * hz),
        standing_seconds: standing
            .map(|learned| learned.people.iter().cloned().collect())
            .unwrap_or_default(),
        running: trained.model.running.as_deref().map(RunningFacts::of),
        jumping: JumpFacts::of(&trained.model),
        crouching: CrouchFacts::of(&trained.model),
        skipped: skipped(corpus),
        warnings,
        seconds,
    };
    let left_out = report.skipped.iter().map(|skipped| &skipped.reason);
    conclude(
        args.json,
        &report,
        left_out,
        &report.warnings,
        Report::lines,
    )
}

impl Report<'_> {
    /// The report in words.
    fn lines(&self) -> Vec<String> {
        let [slowest, fastest] = self.speed_range_mps;
        let mut lines = vec![format!(
            "{}: {} steps of {} subjects in {} clips, {slowest:.2} to {fastest:.2} m/s, {} iterations, {:.1} s",
            self.output.display(),
            self.steps,
            self.subjects,
            self.clips,
            self.log_likelihoods.len(),
            self.seconds
        )];
        if !self.standing_seconds.is_empty() {
            lines.push(format!(
                "standing: {:.0} s of {} people",
                self.standing_seconds.values().sum::<f64>(),
                self.standing_seconds.len()
            ));
        }
        let running = self.running.as_ref();
        lines.extend(running.map(|facts| format!("running: {}", facts.line())));
        let jumping = self.jumping.as_ref();
        lines.extend(jumping.map(|facts| format!("jumping: {}", facts.line())));
        let crouching = self.crouching.as_ref();
        lines.extend(crouching.map(|facts| format!("crouching: {}", facts.line())));
        let contexts = &self.contexts;
        lines.push(format!(
            "{} step models for ten contexts: leaves of the trees of outputs {:?}, of durations {}",
            contexts.models, contexts.output_leaves, contexts.duration_leaves
        ));
        lines
    }
}

/// Shows the progress of training.
pub(super) struct TrainingProgress(pub(super) output::Progress);

impl footfall_train::Progress for TrainingProgress {
    fn advance(&mut self, task: &str, done: usize, total: usize) -> ControlFlow<()> {
        if done == 0 {
            self.0.stage(task, total as u64);
        }
        self.0.reach(done as u64);
        ControlFlow::Continue(())
    }
}
