//! `footfall dynamics`: gait as a switching system.

mod fit;
mod switches;
mod synth;

pub(super) use fit::SizeArgs;

use anyhow::Result;
use clap::Subcommand;

/// Switching models: gait as two linear systems that switch when a foot lands
#[derive(Debug, clap::Args)]
pub(crate) struct DynamicsArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    Switches(switches::SwitchesArgs),
    Fit(fit::FitArgs),
    Synth(synth::DynamicsSynthArgs),
}

pub(crate) fn run(args: &DynamicsArgs) -> Result<()> {
    match &args.what {
        What::Switches(args) => switches::run(args),
        What::Fit(args) => fit::run(args),
        What::Synth(args) => synth::run(args),
    }
}
