//! `footfall evaluate naturalness`: classification of generated against captured walks or runs.

mod pace;
mod report;
mod speeds;

use super::judged::JudgedArgs;
use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_model::GaitModel;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::corpus::Corpus;
use footfall_motion::steps::segment_walks;
use footfall_synth::{GaitChoice, WalkConfig, synthesize};
use footfall_train::evaluate::told_apart::bouts::{Bout, Gait};
use footfall_train::evaluate::told_apart::{Walker, compare, people_apart};
use rayon::prelude::*;
use report::Report;
use speeds::Speeds;
use std::sync::Arc;

/// Compare generated walks or runs with captured ones
///
/// Two classifiers learn to recognise captured strides from some people and seeds, and are tested on others. Motion above 6 Hz, where
/// markers are noisy, is ignored. The score of captured people in the generator's place is the reference, since people differ from each
/// other as well. Further measures locate differences: speed, cadence, flight, slip of standing and landing feet,
/// detail of 3 to 6 Hz by part of the body, surge, limp and bob of the hips, knees and feet.
///
/// A run is two or more consecutive steps with flight, detected by the fall of the hips, at an even speed and nearly straight. The same
/// rule applies to captured and generated runs.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate naturalness --model walk.footfall --corpus index.csv --where category=neutral_walk --where 'path=cmu/*'\n  \
    footfall evaluate naturalness --model locomotion.footfall --gait run --corpus index.csv --where 'category=*run*'\n  \
    footfall evaluate naturalness --model walk.footfall --style sad.footstyle --corpus index.csv --where style=sad --json")]
pub(crate) struct NaturalnessArgs {
    #[command(flatten)]
    judged: JudgedArgs,
    /// Gait to evaluate
    #[arg(long, value_enum, default_value_t)]
    gait: GaitArg,
    /// Speeds of the captured walks or runs to use, m/s [default: all for walks, 2.5:4.5 for runs]
    #[arg(long, value_name = "LEAST:GREATEST")]
    speeds: Option<Speeds>,
    /// Number of generated walks, each at the mean speed of one recording
    #[arg(long, default_value_t = 48, value_parser = clap::value_parser!(u32).range(8..=1000))]
    seeds: u32,
    /// Steps of each generated walk
    #[arg(long, default_value_t = 14, value_parser = clap::value_parser!(u32).range(4..=1000))]
    steps: u32,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Gaits that can be judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
enum GaitArg {
    /// Steps without flight
    #[default]
    Walk,
    /// Steps with flight
    Run,
}

impl GaitArg {
    const fn gait(self) -> Gait {
        match self {
            Self::Walk => Gait::Walk,
            Self::Run => Gait::Run,
        }
    }

    const fn choice(self) -> GaitChoice {
        match self {
            Self::Walk => GaitChoice::Walk,
            Self::Run => GaitChoice::Run,
        }
    }

    /// Speeds that are judged unless others are given.
    const fn speeds(self) -> Option<Speeds> {
        match self {
            Self::Walk => None,
            Self::Run => Some(Speeds::RUNS),
        }
    }
}

pub(crate) fn run(args: &NaturalnessArgs) -> Result<()> {
    let report = evaluate(args)?;
    output::note_left_out(&report.skipped);
    output::print_report(args.json, &report, Report::table)
}

/// The report, as JSON has it.
fn evaluate(args: &NaturalnessArgs) -> Result<Report> {
    let progress = output::Progress::new();
    progress.stage("reading the recordings", 0);
    let (model, corpus) = args.judged.read()?;
    if args.gait == GaitArg::Run && model.running.is_none() {
        bail!(
            "{}: the model cannot run; train it with --running",
            args.judged.model.display()
        );
    }
    let chosen = args.speeds.or(args.gait.speeds());
    let captured = people(&corpus, args.gait.gait(), chosen);
    let speeds = speeds_of(&captured);
    if speeds.is_empty() {
        let within = chosen.map_or_else(String::new, |speeds| format!(" at {speeds} m/s"));
        bail!(
            "{}: the selected recordings show no {} of two steps{within}; widen --where or --speeds",
            args.judged.corpus.display(),
            args.gait.gait().name(),
        );
    }
    progress.stage("generating walks", 0);
    let generated = seeds(&Arc::new(model), args, &speeds)?;
    progress.stage("judging", 0);
    let gait = args.gait.gait();
    let corpus_name = || args.judged.corpus.display().to_string();
    let comparison = compare(&captured, &generated, gait).with_context(corpus_name)?;
    let people = people_apart(&captured, gait).with_context(corpus_name)?;
    progress.finish();
    Ok(Report::new(
        gait,
        &comparison,
        &people,
        corpus.report.reasons(),
    ))
}

/// Recordings by person, with what they show of the gait at the speeds.
fn people(corpus: &Corpus, gait: Gait, speeds: Option<Speeds>) -> Vec<Walker> {
    let mut walkers: Vec<Walker> = Vec::new();
    for recording in &corpus.clips {
        let own = (recording.retargeted.clip.clone(), recording.walks.clone());
        let name = recording.row.subject();
        match walkers.iter_mut().find(|walker| walker.name == name) {
            Some(walker) => walker.clips.push(own),
            None => walkers.push(Walker {
                name: name.to_owned(),
                clips: vec![own],
                asked_mps: None,
            }),
        }
    }
    let range = speeds.map(Speeds::range);
    let judged = |walker: Walker| walker.in_gait(gait, range.as_ref());
    walkers.into_iter().map(judged).collect()
}

/// Mean speed of each recording's longest walk of at least two steps, m/s.
fn speeds_of(captured: &[Walker]) -> Vec<f64> {
    let clips = captured.iter().flat_map(|walker| &walker.clips);
    clips
        .filter_map(|(clip, walks)| {
            let longest = walks.iter().max_by_key(|walk| walk.steps.len())?;
            let bout = Bout::of(clip, longest).filter(|bout| bout.steps >= 2)?;
            Some(bout.speed_mps)
        })
        .collect()
}

/// Walks of the model, a seed each.
fn seeds(model: &Arc<GaitModel>, args: &NaturalnessArgs, speeds: &[f64]) -> Result<Vec<Walker>> {
    (0..args.seeds)
        .into_par_iter()
        .map(|seed| {
            // Every recording's speed comes up equally often, in an order that folds of seeds do not follow.
            let asked_mps = speeds[(seed as usize * 5) % speeds.len()];
            let config = WalkConfig {
                steps: args.steps as usize,
                seed: u64::from(seed) + 1,
                variation: 1.0,
                speed_mps: Some(asked_mps as f32),
                turn_rate_radps: 0.0,
                direction_rad: 0.0,
                frame_rate_hz: None,
                from_standing: false,
                gait: args.gait.choice(),
            };
            let walk = synthesize(model, &model.skeleton, &config)
                .with_context(|| args.judged.model.display().to_string())?;
            let contacts = detect_contacts(&walk.clip, &ContactConfig::from_frame(0));
            let walks = segment_walks(&walk.clip, &contacts);
            let walker = Walker {
                name: format!("seed {}", config.seed),
                clips: vec![(walk.clip, walks)],
                asked_mps: Some(asked_mps),
            };
            Ok(walker.in_gait(args.gait.gait(), None))
        })
        .collect()
}
