//! `cargo xtask bench-crowd`: what crowds cost in headless Godot, beside what the engine costs without them.

use crate::{engine_run, godot, library, link, open, paths};
use anyhow::{Context as _, Result};

/// Builds the library, runs the measurement and prints its JSON object.
///
/// # Errors
/// As [`measure`].
pub(crate) fn command(instances: u32, skeletons: u32) -> Result<()> {
    println!("{}", measure(instances, skeletons)?);
    Ok(())
}

/// Builds the library, runs the measurement and returns its JSON object.
///
/// # Errors
/// When something cannot be built or had, or Godot fails.
pub(crate) fn measure(instances: u32, skeletons: u32) -> Result<String> {
    library::build(&library::Options::default())?;
    let engine = godot::provision()?;
    link::ensure()?;
    let project = paths::repository_root().join("tests/godot");
    crate::demo::import(&engine, &project, "tests")?;
    let log = paths::target_folder().join("verify/bench_crowd.log");
    let said = engine_run::judged(
        open::headless(&engine, &project)
            .args(["res://bench/crowd_bench.tscn", "--"])
            .args([instances.to_string(), skeletons.to_string()]),
        &log,
    )?;
    let figures = said
        .lines()
        .find_map(|line| line.strip_prefix("BENCH "))
        .context("the measurement printed no figures")?;
    Ok(figures.to_owned())
}
