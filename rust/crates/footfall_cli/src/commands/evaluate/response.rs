//! `footfall evaluate response`: response times of walkers and of people.

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

/// Measure the response times of a walker, and of people
///
/// With hips low-passed at 4 Hz: seconds from the request until the walker has 80 % of the requested speed, or stands; and the same from the beginning of the
/// motion, that is from standing or 80 % of the speed before. For captured takes: every start, stop and reversal of the hips. Also the greatest
/// accelerations of the hips (99.9 %), unfiltered.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate response --model locomotion.footfall take1.bvh take2.bvh")]
pub(crate) struct ResponseArgs {
    /// The model
    #[arg(long, value_name = "GAIT.footfall")]
    model: PathBuf,
    /// Captured takes for comparison
    #[arg(value_name = "TAKE.bvh")]
    takes: Vec<PathBuf>,
    /// Number of walkers; each gets the request at several phases of its stride
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
