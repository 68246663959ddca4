//! `cargo verify examples`: the façade's examples, run as a reader runs them.

use crate::{paths, process};
use anyhow::{Context as _, Result, ensure};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Builds and runs each example, and shows how what it prints ends. The façade's own tests judge the outcomes.
///
/// # Errors
/// An example that fails, prints next to nothing, or leaves no file where it should.
pub(crate) fn check() -> Result<()> {
    process::run(process::cargo_without_nodes("build").args(["--quiet", "--examples"]))?;
    let folder = paths::target_folder().join("verify");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let walk = folder.join("walk_once.bvh");
    let model = paths::addon().join("models/locomotion.footfall");
    let sensor = paths::repository_root().join("tests/data/walker_1_slow.right_foot.csv");
    run("walk_once", &[&model, &walk])?;
    let written = fs::read_to_string(&walk)
        .with_context(|| format!("walk_once left no {}", walk.display()))?;
    ensure!(
        written.starts_with("HIERARCHY") && written.contains("MOTION"),
        "{} is no BVH",
        walk.display()
    );
    run("game_loop", &[])?;
    run("replay_sensor", &[&sensor])
}

fn run(example: &str, arguments: &[&Path]) -> Result<()> {
    let program = paths::target_folder()
        .join("debug/examples")
        .join(format!("{example}{}", std::env::consts::EXE_SUFFIX));
    let said = process::read(Command::new(program).args(arguments))?;
    ensure!(
        said.lines().count() > 3,
        "example {example} prints next to nothing:\n{said}"
    );
    eprintln!("{example}:\n{}", process::tail(&said, 4));
    Ok(())
}
