//! `cargo xtask bench`: kernels and crowds on this machine, beside their peers and limits, in one table with all machines that were kept.

mod machine;
mod picture;
mod table;

use crate::{bench_crowd, paths, process};
use anyhow::{Context as _, Result};
use machine::Machine;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Page that shows the kept measurements, and their folder beside it: a measurement and a picture of each machine.
const PAGE: &str = "rust/BENCHMARKS.md";
const FOLDER: &str = "benchmarks";

/// Walkers that crowds are measured with, and whole skeletons.
const INSTANCES: u32 = 10_000;
const SKELETONS: u32 = 1500;

/// Measures, prints the table of this machine and leaves it as a picture. With `keep` the measurement joins those of other machines, and the page is written anew.
///
/// # Errors
/// When something cannot be built, measured, read or written.
pub(crate) fn command(keep: bool) -> Result<()> {
    let kernels = kernels()?;
    let crowds: Value = serde_json::from_str(&bench_crowd::measure(INSTANCES, SKELETONS)?)
        .context("the figures of crowds are no JSON")?;
    let machine = Machine::here(kernels, crowds);
    print!("{}", table::text(&machine));
    if keep {
        let text = serde_json::to_string_pretty(&machine)? + "\n";
        write(&folder().join(machine.file_name("json")), &text)?;
        return page();
    }
    write(
        &paths::target_folder().join("bench.svg"),
        &picture::svg(&machine),
    )
}

/// Writes the page of all machines that were kept, and a picture of each.
///
/// # Errors
/// When a measurement cannot be read, or a file not be written.
pub(crate) fn page() -> Result<()> {
    let machines = machine::kept(&folder())?;
    for machine in &machines {
        let file = folder().join(machine.file_name("svg"));
        write(&file, &picture::svg(machine))?;
    }
    write(
        &paths::repository_root().join(PAGE),
        &table::page(&machines),
    )
}

fn folder() -> PathBuf {
    paths::repository_root().join(PAGE).with_file_name(FOLDER)
}

/// Writes a file and says where.
fn write(file: &Path, text: &str) -> Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
    }
    fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
    eprintln!("{}", file.display());
    Ok(())
}

/// Times of the kernels and of their peers, as `footfall bench --json` prints them.
fn kernels() -> Result<Value> {
    let mut footfall = process::cargo();
    footfall
        .current_dir(paths::repository_root())
        .args(["run", "--quiet", "--locked", "--release"])
        .args(["--manifest-path", "rust/Cargo.toml"])
        .args(["--package", "footfall_cli", "--", "bench", "--json"])
        .args(["--model", "addons/footfall/models/locomotion.footfall"]);
    let figures = process::read(&mut footfall)?;
    serde_json::from_str(&figures).context("`footfall bench --json` printed no JSON")
}
