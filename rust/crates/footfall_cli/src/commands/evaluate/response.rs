//! `footfall evaluate response`: how quickly does a walker obey, beside how quickly people change?

mod course;
mod report;

use crate::motion_input::{MapArgs, read_file};
use crate::output;
use anyhow::{Context as _, Result};
use course::{COURSE, Trial, run_course};
use footfall_model::GaitModel;
use footfall_train::evaluate::response::Travel;
use footfall_train::read_model_file;
use rayon::prelude::*;
use report::{Report, Take};
use std::path::PathBuf;
use std::sync::Arc;

/// Times that a walker takes to obey, beside those of people
///
/// Hips low-passed at 4 Hz: seconds from the moment of asking until they have 80 % of what was asked for, or stand, and the same by the clock of the
/// motion alone, from standing or 80 % of the speed before. Of takes, every start, stop and reversal that their hips make. And the hips' greatest
/// accelerations (99.9 %), unfiltered.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate response --model locomotion.footfall take1.bvh take2.bvh")]
pub(crate) struct ResponseArgs {
    /// The model
    #[arg(long, value_name = "GAIT.footfall")]
    model: PathBuf,
    /// Captured takes to stand beside it
    #[arg(value_name = "TAKE.bvh")]
    takes: Vec<PathBuf>,
    /// Number of walkers, each asked at several moments of their stride
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    seeds: u32,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &ResponseArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, Report::table)
}

/// The report, as JSON has it.
fn evaluate(args: &ResponseArgs) -> Result<Report> {
    let model = Arc::new(read_model_file(&args.model, GaitModel::from_bytes)?);
    let options = args.map.read(None)?;
    let takes: Vec<Take> = args
        .takes
        .iter()
        .map(|path| {
            let (_, retargeted) = read_file(path, &options)?;
            let (clip, first) = (retargeted.clip, retargeted.first_frame.max(1));
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            Ok(Take::new(&name, &clip, first, &Travel::of(&clip, first)))
        })
        .collect::<Result<_>>()?;
    let trials: Vec<Vec<Trial>> = COURSE
        .par_iter()
        .map(|course| run_course(&model, course, args.seeds))
        .collect::<Result<_>>()
        .with_context(|| args.model.display().to_string())?;
    Ok(Report::new(takes, &trials))
}
