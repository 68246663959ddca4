//! `footfall studio`: the desktop tool.

use anyhow::{Result, bail};
use footfall_studio::StudioOptions;
use std::path::PathBuf;

/// See the motion, make the style: the desktop tool
///
/// Opens recordings and folders of them, corrects contacts, trains walks and styles, designs and mixes styles, hears sensors, and
/// shows the papers' tables. Files may also be dropped on its window.
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
        bail!("{}: there is no such file", missing.display());
    }
    let options = StudioOptions {
        paths: args.paths.clone(),
        data_folder: None,
    };
    footfall_studio::run(options).map_err(anyhow::Error::msg)
}
