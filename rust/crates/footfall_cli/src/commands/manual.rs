//! `footfall manual`: pages for `man`.

use super::Cli;
use crate::output;
use anyhow::{Context as _, Result};
use clap::CommandFactory as _;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Write manual pages, one for each command
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall manual ~/.local/share/man/man1\n  \
    footfall manual man && man man/footfall-synth.1")]
pub(crate) struct ManualArgs {
    /// Output folder; created if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    folder: &'a Path,
    pages: Vec<PathBuf>,
}

pub(crate) fn run(args: &ManualArgs) -> Result<()> {
    let folder = &args.folder;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    write_pages(&command, folder, &mut pages)?;
    if args.json {
        return output::print_json(&Report { folder, pages });
    }
    output::note(&format!("{}: {} pages", folder.display(), pages.len()));
    Ok(())
}

fn write_pages(command: &clap::Command, folder: &Path, pages: &mut Vec<PathBuf>) -> Result<()> {
    let man = clap_mangen::Man::new(command.clone());
    let path = folder.join(man.get_filename());
    let mut text = Vec::new();
    man.render(&mut text)
        .with_context(|| path.display().to_string())?;
    output::write_atomic(&path, &text)?;
    pages.push(path);
    for inner in command.get_subcommands() {
        write_pages(inner, folder, pages)?;
    }
    Ok(())
}
