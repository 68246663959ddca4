//! `footfall imu`: inertial sensors on a body.

mod events;
mod monitor;
mod reconstruct;
mod simulate;
mod synchronous;
mod train;

pub(in crate::commands) use reconstruct::read_calibration;
pub(in crate::commands) use train::KeptArgs;

use anyhow::{Context as _, Result};
use clap::Subcommand;
use footfall_core::Site;
use footfall_imu::{ImuRecording, check_recording, csv};
use std::path::Path;

/// Bodies and gait events from one or two inertial sensors
#[derive(Debug, clap::Args)]
pub(crate) struct ImuArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Simulate(simulate::SimulateArgs),
    Train(train::ImuTrainArgs),
    Reconstruct(reconstruct::ReconstructArgs),
    Events(events::EventsArgs),
    Monitor(monitor::MonitorArgs),
}

pub(crate) fn run(args: &ImuArgs) -> Result<()> {
    match &args.what {
        What::Simulate(args) => simulate::run(args),
        What::Train(args) => train::run(args),
        What::Reconstruct(args) => reconstruct::run(args),
        What::Events(args) => events::run(args),
        What::Monitor(args) => monitor::run(args),
    }
}

/// A site by its name, for clap.
pub(in crate::commands) fn parse_site(name: &str) -> Result<Site, String> {
    Site::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Site::ALL.into_iter().map(Site::name).collect();
        format!("unknown site; the sites are {}", names.join(", "))
    })
}

/// Reads a recording and checks units, axes and rate; errors name the file.
fn read_recording(path: &Path) -> Result<ImuRecording> {
    let recording = csv::read(path)?;
    check_recording(&recording).with_context(|| path.display().to_string())?;
    Ok(recording)
}
