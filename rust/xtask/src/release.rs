//! `cargo xtask release`: everything of a release that this machine can make, in one folder.
//!
//! The add-on with the libraries of all platforms, the demo as a game, the changelog's section, notices and a bill of materials, and the checksums of
//! all of them.

mod changelog;
mod demo;

use crate::library::Options;
use crate::{addon, audit, library, paths, platforms, process, tools};
use anyhow::{Context as _, Result, bail};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const CARGO_SBOM: &str = "0.10.0";
/// File of the checksums.
const SUMS: &str = "SHA256SUMS";

/// Switches of a release.
#[derive(Args, Debug)]
pub(crate) struct Settings {
    /// Build nothing: take the libraries that are in `addons/footfall/bin`.
    #[arg(long)]
    packed: bool,
}

/// Makes the release; its folder is the last line of stdout.
///
/// # Errors
/// When a check or a build fails; all builds are tried first.
pub(crate) fn command(settings: &Settings) -> Result<()> {
    audit::command()?;
    if !settings.packed {
        libraries()?;
    }
    let version = version()?;
    let folder = paths::target_folder().join(format!("footfall-{version}"));
    paths::make_empty(&folder)?;
    let file = |name: &str| folder.join(name.replace("VERSION", &version));
    write(&file("CHANGES.md"), &changes(&version)?)?;
    write(&file("THIRD_PARTY.md"), &addon::third_party()?)?;
    write(&file("footfall-VERSION.cdx.json"), &bill_of_materials()?)?;
    addon::archive(&file("footfall-addon-VERSION.zip"))?;
    demo::archive(&version, &folder)?;
    write(&file(SUMS), &checksums(&folder)?)?;
    println!("{}", folder.display());
    Ok(())
}

/// Builds both flavours for every platform that users are promised.
fn libraries() -> Result<()> {
    let mut failed = Vec::new();
    for (name, target) in platforms::promised() {
        let options = Options {
            all: true,
            shipped: true,
            target: Some(target.to_owned()),
            cross: true,
            ..Options::default()
        };
        if let Err(error) = library::build(&options) {
            eprintln!("{name}: {error:#}");
            failed.push(name);
        }
    }
    if !failed.is_empty() {
        bail!(
            "no library for {}. `cargo xtask release --packed` makes a release without them",
            failed.join(", ")
        );
    }
    Ok(())
}

/// The version that the workspace has.
fn version() -> Result<String> {
    let metadata = process::metadata()?;
    let packages = metadata["packages"]
        .as_array()
        .map_or(&[][..], Vec::as_slice);
    packages
        .iter()
        .find(|package| package["name"] == "footfall_godot")
        .and_then(|package| package["version"].as_str())
        .map(str::to_owned)
        .context("cargo knows no version of footfall_godot")
}

fn changes(version: &str) -> Result<String> {
    let file = paths::workspace().join("CHANGELOG.md");
    let text =
        fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    changelog::section(&text, version)
}

/// Parts of the add-on's library, in the format `CycloneDX`.
fn bill_of_materials() -> Result<String> {
    let program = tools::of_crate("cargo-sbom", CARGO_SBOM)?;
    process::read(
        Command::new(program)
            .current_dir(paths::workspace())
            .args(["sbom", "--cargo-package", "footfall_godot"])
            .args(["--output-format", "cyclone_dx_json_1_6"]),
    )
}

/// A line for each file of a folder, as `sha256sum` prints and checks them.
fn checksums(folder: &Path) -> Result<String> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .with_context(|| format!("cannot read {}", folder.display()))?
        .flatten()
        .map(|entry| entry.path())
        .filter(|file| !file.ends_with(SUMS))
        .collect();
    files.sort();
    let line = |file: &PathBuf| {
        let bytes = fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        Ok(format!("{}  {name}\n", addon::sha256(&bytes)))
    };
    files.iter().map(line).collect()
}

fn write(file: &Path, text: &str) -> Result<()> {
    fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_has_its_checksum_and_the_list_has_none() {
        let folder = std::env::temp_dir().join(format!("footfall_sums_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for name in ["b.zip", "a.md", SUMS] {
            fs::write(folder.join(name), name).unwrap();
        }
        let sums = checksums(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<&str> = sums.lines().map(|line| &line[66..]).collect();
        assert_eq!(names, ["a.md", "b.zip"]);
        assert!(sums.starts_with(&addon::sha256(b"a.md")));
    }
}
