//! `footfall studio`: the desktop tool.

use anyhow::{Result, bail};
use footfall_studio::StudioOptions;
use std::path::PathBuf;

/// Open Footfall Studio, the desktop tool
///
/// The studio opens recordings and folders, corrects contacts, trains walks and styles, designs and mixes styles, connects to sensors, and
/// shows the papers' tables. Files may also be dropped onto its window.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall studio\n  \
    footfall studio walk.bvh\n  \
    footfall studio recordings/")]
pub(crate) struct StudioArgs {
    /// Recordings (.bvh, .csv), models, styles, or folders to open
    #[arg(value_name = "FILE")]
    paths: Vec<PathBuf>,
}

pub(crate) fn run(args: &StudioArgs) -> Result<()> {
    if let Some(missing) = args.paths.iter().find(|path| !path.exists()) {
        bail!("there is no file {}", missing.display());
    }
    let options = StudioOptions {
        paths: args.paths.clone(),
        data_folder: None,
    };
    footfall_studio::run(options).map_err(anyhow::Error::msg)
}
