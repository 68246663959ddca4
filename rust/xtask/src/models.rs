//! `cargo xtask models`: makes the models that the add-on ships from the motion data.

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the data are when `FOOTFALL_DATA` does not say so, from the repository's root.
const DATA: &str = "../shared/data";
const WALK: &str = "addons/footfall/models/walk.footfall";

/// Trains every shipped model anew.
///
/// # Errors
/// When the data are not there or training fails.
pub(crate) fn command() -> Result<()> {
    let root = paths::repository_root();
    let index = data_folder(&root)?.join("index.csv");
    fs::create_dir_all(root.join("addons/footfall/models"))
        .context("cannot create the folder for models")?;
    let mut cargo = process::cargo();
    // From the root with relative paths: the model records the command, which should read the same everywhere.
    cargo
        .current_dir(&root)
        .args([
            "run",
            "--quiet",
            "--locked",
            "--release",
            "--manifest-path",
            "rust/Cargo.toml",
        ])
        .args(["--package", "footfall_cli", "--", "train", "--corpus"])
        .arg(&index)
        .args([
            "--where",
            "category=neutral_walk",
            "--where",
            "path=cmu/*",
            "--describe",
            "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), neutral walks",
            "-o",
            WALK,
        ]);
    if let Some(commit) = current_commit(&root) {
        cargo.env("FOOTFALL_COMMIT", commit);
    }
    process::run(&mut cargo)?;
    eprintln!("{WALK} is made from the data: the tests check it, then commit it");
    Ok(())
}

/// The commit that the models are made with, as their provenance records it; `None` outside a checkout.
fn current_commit(root: &Path) -> Option<String> {
    let output = Command::new("git")
        .current_dir(root)
        .args(["rev-parse", "--short=12", "HEAD"])
        .output()
        .ok()?;
    let commit = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| commit.trim().to_owned())
}

fn data_folder(root: &Path) -> Result<PathBuf> {
    let named = env::var_os("FOOTFALL_DATA")
        .filter(|value| !value.is_empty())
        .map(PathBuf::from);
    let folder = named.unwrap_or_else(|| PathBuf::from(DATA));
    if !root.join(&folder).join("index.csv").is_file() {
        bail!(
            "{} holds no index.csv: let FOOTFALL_DATA name the folder with the motion data",
            folder.display()
        );
    }
    Ok(folder)
}
