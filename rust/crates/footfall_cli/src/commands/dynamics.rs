//! `footfall dynamics`: gait as a switching system.

mod switches;

use anyhow::Result;
use clap::Subcommand;

/// Gait as two systems that switch when a foot lands
#[derive(Debug, clap::Args)]
pub(crate) struct DynamicsArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Switches(switches::SwitchesArgs),
}

pub(crate) fn run(args: &DynamicsArgs) -> Result<()> {
    match &args.what {
        What::Switches(args) => switches::run(args),
    }
}
