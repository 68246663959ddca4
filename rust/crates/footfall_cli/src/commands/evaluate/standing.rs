//! `footfall evaluate standing`: does generated standing sway as people do?

mod report;

use super::judged::JudgedArgs;
use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_model::GaitModel;
use footfall_motion::corpus::Corpus;
use footfall_synth::{StandConfig, synthesize_standing};
use footfall_train::evaluate::standing::{StandingMeasures, measure};
use footfall_train::standing::{StandingClip, learn, stretches};
use rayon::prelude::*;
use report::{HeldOut, Report};
use std::sync::Arc;

/// Compare generated standing with captured standing
///
/// Measures the sway of hips and head in place and speed, root mean squares by band and part of the body, knees, and the greatest correlation with an
/// earlier time, over windows of 20 seconds in which people stand at ease on planted feet; and the same for the still pose. With
/// `--leave-one-out`, every person is compared with a model of the others, and with the mean of the others as a reference.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate standing --model walk.footfall --corpus index.csv --where category=idle --leave-one-out")]
pub(crate) struct StandingArgs {
    #[command(flatten)]
    judged: JudgedArgs,
    /// Number of generated people
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u32).range(2..=1000))]
    seeds: u32,
    /// Seconds for which each one stands
    #[arg(long, default_value_t = 100, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(30..=3600))]
    seconds: u32,
    /// Compare every person with a model of the others
    #[arg(long)]
    leave_one_out: bool,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Standing person.
pub(super) struct Person {
    pub(super) name: String,
    pub(super) measures: StandingMeasures,
}

pub(crate) fn run(args: &StandingArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, Report::table)
}

/// The report, as JSON has it.
fn evaluate(args: &StandingArgs) -> Result<Report> {
    let progress = output::Progress::new();
    progress.stage("reading the recordings", 0);
    let (model, corpus) = args.judged.read()?;
    let clips = standing_clips(&corpus);
    let captured = people(&clips);
    if captured.is_empty() {
        bail!(
            "{}: no selected recording has 20 seconds of standing at ease; widen --where",
            args.judged.corpus.display()
        );
    }
    progress.stage("generating", 0);
    let model = Arc::new(model);
    let generated = seeds(&model, args, args.seeds, 1.0)?;
    let still = seeds(&model, args, 2, 0.0)?;
    let held_out = if args.leave_one_out {
        leave_one_out(&model, args, &clips, &captured)?
    } else {
        Vec::new()
    };
    progress.finish();
    Ok(Report::new(&captured, &generated, &still, held_out))
}

pub(super) fn standing_clips(corpus: &Corpus) -> Vec<StandingClip> {
    let clips = corpus.clips.iter();
    clips
        .map(|clip| StandingClip::new(clip.row.subject(), &clip.retargeted))
        .collect()
}

/// Measures of all people who stand long enough.
fn people(clips: &[StandingClip]) -> Vec<Person> {
    let mut names: Vec<&str> = clips.iter().map(|clip| clip.subject.as_str()).collect();
    names.dedup();
    names
        .into_iter()
        .filter_map(|name| {
            let own: Vec<&StandingClip> =
                clips.iter().filter(|clip| clip.subject == name).collect();
            let leg_m = f64::from(own.first()?.clip.skeleton.mean_leg_length());
            let found: Vec<_> = own
                .iter()
                .flat_map(|clip| stretches(&clip.clip, clip.skip_frames))
                .collect();
            let measures = measure(&found, leg_m)?;
            Some(Person {
                name: name.to_owned(),
                measures,
            })
        })
        .collect()
}

/// Generated people, one for each seed, with this amount of motion.
fn seeds(
    model: &Arc<GaitModel>,
    args: &StandingArgs,
    count: u32,
    motion: f32,
) -> Result<Vec<Person>> {
    let made: Vec<Option<Person>> = (1..=count)
        .into_par_iter()
        .map(|seed| {
            let config = StandConfig {
                seconds: f64::from(args.seconds),
                seed: u64::from(seed),
                variation: 1.0,
                motion,
                frame_rate_hz: None,
            };
            let standing = synthesize_standing(model, &model.skeleton, &config)
                .with_context(|| args.judged.model.display().to_string())?;
            let leg_m = f64::from(model.skeleton.mean_leg_length());
            let measures = measure(&stretches(&standing.clip, 0), leg_m);
            Ok::<_, anyhow::Error>(measures.map(|measures| Person {
                name: format!("seed {seed}"),
                measures,
            }))
        })
        .collect::<Result<_>>()?;
    let made: Vec<Person> = made.into_iter().flatten().collect();
    if made.is_empty() {
        bail!(
            "{}: none of the generated people stands at ease by the measures that recordings are judged by; use fewer --style",
            args.judged.model.display()
        );
    }
    Ok(made)
}

/// Each person beside a model of the others, and beside the others themselves.
fn leave_one_out(
    model: &GaitModel,
    args: &StandingArgs,
    clips: &[StandingClip],
    captured: &[Person],
) -> Result<Vec<HeldOut>> {
    let mut held_out = Vec::new();
    for person in captured {
        let rest: Vec<StandingClip> = clips
            .iter()
            .filter(|clip| clip.subject != person.name)
            .cloned()
            .collect();
        let Some(learned) = learn(&rest, model) else {
            continue;
        };
        let without = Arc::new(GaitModel {
            standing: Some(learned.model),
            ..model.clone()
        });
        let generated = seeds(&without, args, args.seeds, 1.0)?;
        let others: Vec<&Person> = captured
            .iter()
            .filter(|other| other.name != person.name)
            .collect();
        let generated: Vec<&Person> = generated.iter().collect();
        held_out.push(HeldOut::new(person, &generated, &others));
    }
    Ok(held_out)
}
