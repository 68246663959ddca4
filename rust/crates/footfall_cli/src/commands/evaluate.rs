//! `footfall evaluate`: the papers' tables on the user's own data.

mod contacts;
mod dynamics;
mod imu;
mod judged;
mod naturalness;
mod orientation;
mod response;
mod standing;
mod style;
mod training;

use anyhow::Result;
use clap::Subcommand;

/// Evaluate models and detectors: the papers' tables on your own data
#[derive(Debug, clap::Args)]
pub(crate) struct EvaluateArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Contacts(contacts::ContactsArgs),
    Dynamics(dynamics::DynamicsArgs),
    Imu(imu::ImuArgs),
    Naturalness(naturalness::NaturalnessArgs),
    Orientation(orientation::OrientationArgs),
    Response(response::ResponseArgs),
    Standing(standing::StandingArgs),
    Style(style::StyleArgs),
    Training(training::TrainingArgs),
}

pub(crate) fn run(args: &EvaluateArgs) -> Result<()> {
    match &args.what {
        What::Contacts(args) => contacts::run(args),
        What::Dynamics(args) => dynamics::run(args),
        What::Imu(args) => imu::run(args),
        What::Naturalness(args) => naturalness::run(args),
        What::Orientation(args) => orientation::run(args),
        What::Response(args) => response::run(args),
        What::Standing(args) => standing::run(args),
        What::Style(args) => style::run(args),
        What::Training(args) => training::run(args),
    }
}
