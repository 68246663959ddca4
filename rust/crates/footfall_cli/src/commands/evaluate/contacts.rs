//! `footfall evaluate contacts`: the contact detectors beside each other.

mod table;

use crate::motion_input::KneesArgs;
use crate::output;
use anyhow::Result;
use footfall_motion::corpus::Where;
use footfall_train::evaluate::contacts::{ContactsReport, ContactsRequest, evaluate_contacts};
use std::path::PathBuf;

/// Contacts of people's feet, found in three ways, against others
///
/// On motion, person by person (column `subject`): the contacts that `footfall contacts` finds against those of Zeni et al. 2008 within
/// 50 ms, where the person walks straight ahead; and the switches of hip and knee angles against the initial contacts that `footfall
/// contacts` finds, foot by foot, within a tolerance. An event so near an end of the recording that its other half is not seen is left out.
///
/// On sensors: each row of the index is a recording of one sensor on a foot (`path`, an IMU .csv) with its known events
/// (`events`, a .json like `footfall imu events` prints); initial and terminal contacts are matched apart. With --model the bodies that the sensors
/// drive are judged as well, both feet; the column `foot` then says which foot wears the sensor, where the events are of both.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk --leave-one-out --ablate\n  \
    footfall evaluate contacts --sensors sensors.csv")]
#[group(id = "truth", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct ContactsArgs {
    /// Table of the recordings of motion
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Table of the recordings of sensors on feet, with a column `events`
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Model for a sensor on one foot; contacts of the bodies that it reconstructs are judged as well, live and whole
    #[arg(long, value_name = "FOOT.footimu", requires = "sensors")]
    model: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// Choose the detector's limits on the other people for each person who is judged
    #[arg(long, requires = "corpus")]
    leave_one_out: bool,
    /// Switches without the parts that place them, and with the projection residual, beside them
    #[arg(long, requires = "corpus")]
    ablate: bool,
    #[command(flatten)]
    knees: KneesArgs,
    /// Largest difference at which switches or events of sensors count as the same as others, milliseconds
    #[arg(long, default_value_t = ContactsRequest::default().tolerance_ms)]
    tolerance: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Evaluates, and returns the report that is printed as JSON.
fn evaluate(args: &ContactsArgs) -> Result<ContactsReport> {
    let corpus = match &args.corpus {
        Some(index) => Some(args.knees.read_corpus(index, &args.conditions)?),
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
