//! `cargo xtask bench`: kernels and crowds on this machine, beside their peers and limits, in one table with all machines that were kept.

mod machine;
mod table;

use crate::{bench_crowd, paths, process};
use anyhow::{Context as _, Result};
use machine::Machine;
use serde_json::Value;
use std::fs;

/// Folder of the kept measurements, one file a machine, and the page that shows them.
const KEPT: &str = "rust/benchmarks";
const PAGE: &str = "rust/BENCHMARKS.md";

/// Walkers that crowds are measured with, and whole skeletons.
const INSTANCES: u32 = 10_000;
const SKELETONS: u32 = 1500;

/// Measures, and prints the table of this machine. With `keep` the measurement joins those of other machines, and the page is written anew.
///
/// # Errors
/// When something cannot be built, measured, read or written.
pub(crate) fn command(keep: bool) -> Result<()> {
    let kernels = kernels()?;
    let crowds: Value = serde_json::from_str(&bench_crowd::measure(INSTANCES, SKELETONS)?)
        .context("the figures of crowds are no JSON")?;
    let machine = Machine::here(kernels, crowds);
    print!("{}", table::text(&machine));
    if !keep {
        return Ok(());
    }
    let root = paths::repository_root();
    let folder = root.join(KEPT);
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let file = folder.join(machine.file_name());
    let text = serde_json::to_string_pretty(&machine)? + "\n";
    fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    let page = root.join(PAGE);
    fs::write(&page, table::page(&machine::kept(&folder)?))
        .with_context(|| format!("cannot write {}", page.display()))?;
    eprintln!("{} and {}", file.display(), page.display());
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
