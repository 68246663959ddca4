//! `cargo xtask bevy`: the example in Bevy, tested and shown in pictures.

use crate::vulkan::Vulkan;
use crate::{contact_sheet, paths, process};
use anyhow::{Result, bail};
use std::process::Command;

/// Runs the example's tests, and leaves pictures of its walk in `rust/target/bevy`.
///
/// # Errors
/// When it cannot be built, a test fails, or nothing can be drawn.
pub(crate) fn command() -> Result<()> {
    process::run(&mut cargo("test"))?;
    let vulkan = Vulkan::provision()?;
    let folder = paths::target_folder().join("bevy");
    paths::make_empty(&folder)?;
    let mut example = cargo("run");
    example.args(["--", "--pictures"]).arg(&folder);
    process::run(vulkan.given_to(&mut example))?;
    let pictures = contact_sheet::pictures(&folder)?;
    if pictures.is_empty() {
        bail!("the example rendered no pictures in {}", folder.display());
    }
    let sheet = folder.join("contact_sheet.png");
    contact_sheet::write(&pictures, &sheet)?;
    eprintln!("{} pictures in {}", pictures.len(), folder.display());
    println!("{}", sheet.display());
    Ok(())
}

/// A command of cargo in the example's own workspace.
fn cargo(name: &str) -> Command {
    let mut cargo = process::cargo();
    cargo
        .args([name, "--locked", "--manifest-path"])
        .arg(paths::workspace().join("bevy_example/Cargo.toml"));
    cargo
}
