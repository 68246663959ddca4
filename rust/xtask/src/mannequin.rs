//! `cargo xtask mannequin`: the character of the demo, by the program of `footfall_mannequin`.

use crate::{paths, process};
use anyhow::Result;

/// Writes `demo_project/characters/mannequin.glb`.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn command() -> Result<()> {
    let file = paths::repository_root().join("demo_project/characters/mannequin.glb");
    process::run(
        process::cargo()
            .args([
                "run",
                "--quiet",
                "--locked",
                "--package",
                "footfall_mannequin",
                "--",
            ])
            .arg(file),
    )
}
