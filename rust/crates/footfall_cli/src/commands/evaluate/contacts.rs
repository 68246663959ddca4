//! `footfall evaluate contacts`: the contact detectors beside each other.

mod table;

use crate::motion_input::SkeletonArgs;
use crate::output;
use anyhow::Result;
use footfall_motion::corpus::Where;
use footfall_train::evaluate::contacts::{ContactsReport, ContactsRequest, evaluate_contacts};
use std::path::PathBuf;

/// Compare detected contacts with reference contacts
///
/// Motion, person by person (column `subject`): the contacts of `footfall contacts` against those of Zeni et al. 2008 within
/// 50 ms, where the person walks straight ahead; and the switches of hip and knee angles against the initial contacts of `footfall
/// contacts`, foot by foot, within a tolerance. Events cut off by an end of the recording are not counted.
///
/// Sensors: each row of the index is a recording of one foot sensor (`path`, an IMU .csv) with its known events
/// (`events`, a .json as `footfall imu events` prints it); initial and terminal contacts are matched separately. With --model, the contacts of both feet
/// of the reconstructed bodies are evaluated as well; the column `foot` then names the foot with the sensor, if the events are of both.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk --leave-one-out --ablate\n  \
    footfall evaluate contacts --sensors sensors.csv")]
#[group(id = "truth", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct ContactsArgs {
    /// Index of the motion recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Index of foot sensor recordings, with a column `events`
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Model for a sensor on one foot: also evaluate the contacts of the bodies that it reconstructs, live and whole
    #[arg(long, value_name = "FOOT.footimu", requires = "sensors")]
    model: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// Choose the limits of both detectors for each person on the other people
    #[arg(long, requires = "corpus")]
    leave_one_out: bool,
    /// Add switches without the parts that place them, and with the projection residual
    #[arg(long, requires = "corpus")]
    ablate: bool,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Tolerance for switches and events of sensors, milliseconds
    #[arg(long, default_value_t = ContactsRequest::default().tolerance_ms)]
    tolerance: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Evaluates, and returns the report that is printed as JSON.
fn evaluate(args: &ContactsArgs) -> Result<ContactsReport> {
    let corpus = match &args.corpus {
        Some(index) => Some(args.fit.read_corpus(index, &args.conditions)?),
        None => None,
    };
    Ok(evaluate_contacts(&ContactsRequest {
        recordings: corpus.as_ref().map_or(&[], |corpus| &corpus.clips),
        sensors: args.sensors.as_deref(),
        model: args.model.as_deref(),
        tolerance_ms: args.tolerance,
        leave_one_out: args.leave_one_out,
        ablate: args.ablate,
    })?)
}

pub(crate) fn run(args: &ContactsArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, table::table)
}
