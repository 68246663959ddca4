//! `footfall evaluate naturalness`: can a classifier tell generated walks from captured ones?

mod report;

use super::judged::JudgedArgs;
use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_model::GaitModel;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::corpus::Corpus;
use footfall_motion::steps::segment_walks;
use footfall_synth::{WalkConfig, synthesize};
use footfall_train::evaluate::told_apart::{Walker, compare};
use rayon::prelude::*;
use report::Report;
use std::sync::Arc;

/// Generated walks beside captured ones
///
/// Two classifiers learn which strides were captured, from some people and some seeds, and judge others. Motion above 6 Hz, where
/// markers are noisy, does not count. What people score in the generator's place stands beside the verdict, for they differ from each
/// other, too. Then come the measures that say where a difference lies: detail of 3 to 6 Hz by part of the body, surge, limp and bob of
/// the hips, knees and feet.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate naturalness --model walk.footfall --corpus index.csv --where category=neutral_walk --where 'path=cmu/*'\n  \
    footfall evaluate naturalness --model walk.footfall --style sad.footstyle --corpus index.csv --where style=sad --json")]
pub(crate) struct NaturalnessArgs {
    #[command(flatten)]
    judged: JudgedArgs,
    /// Number of generated walks, each at the mean speed of one of the recordings
    #[arg(long, default_value_t = 48, value_parser = clap::value_parser!(u32).range(8..=1000))]
    seeds: u32,
    /// Steps of each generated walk
    #[arg(long, default_value_t = 14, value_parser = clap::value_parser!(u32).range(4..=1000))]
    steps: u32,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &NaturalnessArgs) -> Result<()> {
    let report = evaluate(args)?;
    report.note_skipped();
    if args.json {
        return output::print_json(&report);
    }
    output::print_text(&report.table())
}

/// The report, as JSON has it.
pub(super) fn evaluate(args: &NaturalnessArgs) -> Result<Report> {
    let progress = output::Progress::new();
    progress.stage("reading the recordings", 0);
    let (model, corpus) = args.judged.read()?;
    let (captured, speeds) = people(&corpus);
    if speeds.is_empty() {
        bail!(
            "{}: the chosen recordings show no walk of two steps; widen --where",
            args.judged.corpus.display()
        );
    }
    progress.stage("generating walks", 0);
    let generated = seeds(&Arc::new(model), args, &speeds)?;
    progress.stage("judging", 0);
    let comparison =
        compare(&captured, &generated).with_context(|| args.judged.corpus.display().to_string())?;
    progress.finish();
    let skipped = corpus.report.skipped.into_iter();
    Ok(Report::new(
        &comparison,
        skipped.map(|clip| clip.reason).collect(),
    ))
}

/// Recordings by person, and the mean speed of each recording's longest walk, m/s.
fn people(corpus: &Corpus) -> (Vec<Walker>, Vec<f32>) {
    let mut walkers: Vec<Walker> = Vec::new();
    let mut speeds = Vec::new();
    for recording in &corpus.clips {
        let clip = &recording.retargeted.clip;
        let own = (clip.clone(), recording.walks.clone());
        let name = recording.row.subject();
        match walkers.iter_mut().find(|walker| walker.name == name) {
            Some(walker) => walker.clips.push(own),
            None => walkers.push(Walker {
                name: name.to_owned(),
                clips: vec![own],
            }),
        }
        let longest = recording.walks.iter().max_by_key(|walk| walk.steps.len());
        if let Some([first, .., last]) = longest.map(|walk| walk.steps.as_slice()) {
            let end = last.end.min(clip.poses.len() - 1);
            let way = clip.poses[end].root_position - clip.poses[first.first].root_position;
            let secs = (end - first.first) as f64 / clip.frame_rate_hz;
            speeds.push(way.with_y(0.0).length() / secs as f32);
        }
    }
    (walkers, speeds)
}

/// Walks of the model, a seed each.
fn seeds(model: &Arc<GaitModel>, args: &NaturalnessArgs, speeds: &[f32]) -> Result<Vec<Walker>> {
    (0..args.seeds)
        .into_par_iter()
        .map(|seed| {
            let config = WalkConfig {
                steps: args.steps as usize,
                seed: u64::from(seed) + 1,
                variation: 1.0,
                // Every recording's speed comes up equally often, in an order that folds of seeds do not follow.
                speed_mps: Some(speeds[(seed as usize * 5) % speeds.len()]),
                turn_rate_radps: 0.0,
                direction_rad: 0.0,
                frame_rate_hz: None,
                from_standing: false,
                gait: footfall_synth::GaitChoice::Auto,
            };
            let walk = synthesize(model, &model.skeleton, &config)
                .with_context(|| args.judged.model.display().to_string())?;
            let contacts = detect_contacts(&walk.clip, &ContactConfig::from_frame(0));
            let walks = segment_walks(&walk.clip, &contacts);
            Ok(Walker {
                name: format!("seed {}", config.seed),
                clips: vec![(walk.clip, walks)],
            })
        })
        .collect()
}
