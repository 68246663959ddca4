//! `cargo xtask library`: the add-on's library, built and put where `footfall.gdextension` looks for it.
//!
//! There are two flavours. The editor's (`libfootfall_godot.editor.so` and its like) holds the class docs and the dock;
//! exported games load the plain one. Both share every compiled crate but `godot` and `footfall_godot`.

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use clap::Args;
use std::env;
use std::env::consts::{ARCH, OS};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The target that stands for both of macOS's architectures in one file.
const MACOS_UNIVERSAL: &str = "universal-apple-darwin";

/// Settings of a build of the library.
#[derive(Args, Debug, Clone, Default)]
pub(crate) struct Options {
    /// Build without optimisation, quickly.
    #[arg(long)]
    pub(crate) debug: bool,
    /// Build the flavour for exported games, too.
    #[arg(long)]
    pub(crate) all: bool,
    /// Build that flavour as it is released: two thirds of the size, in minutes more.
    #[arg(long, requires = "all", conflicts_with = "debug")]
    pub(crate) shipped: bool,
    /// Build for another platform: a target triple, or `universal-apple-darwin`.
    #[arg(long)]
    pub(crate) target: Option<String>,
}

/// One way to build the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flavour {
    Editor,
    Game,
}

impl Flavour {
    fn name(self) -> &'static str {
        match self {
            Self::Editor => "editor",
            Self::Game => "game",
        }
    }
}

/// Name of a library on a platform, and its place in the add-on.
#[derive(Debug, PartialEq, Eq)]
struct Platform {
    folder: &'static str,
    prefix: &'static str,
    suffix: &'static str,
}

impl Platform {
    /// The platform of a target triple; of this machine without one.
    fn of(target: Option<&str>) -> Result<Self> {
        let host = format!("{ARCH}-{OS}");
        let target = target.unwrap_or(&host);
        let arm = target.starts_with("aarch64");
        let (folder, prefix, suffix) = match target {
            _ if target.contains("android") && arm => ("android-arm64", "lib", "so"),
            _ if target.contains("linux") && !target.contains("android") => (
                if arm { "linux-arm64" } else { "linux-x86_64" },
                "lib",
                "so",
            ),
            _ if target.contains("windows") => (
                if arm {
                    "windows-arm64"
                } else {
                    "windows-x86_64"
                },
                "",
                "dll",
            ),
            _ if target.contains("darwin") || target.contains("macos") => {
                ("macos-universal", "lib", "dylib")
            }
            _ => bail!(
                "the add-on is not built for {target}: Linux, Windows, macOS or Android on arm64"
            ),
        };
        Ok(Self {
            folder,
            prefix,
            suffix,
        })
    }

    /// Cargo's name of the library.
    fn built(&self) -> String {
        format!("{}footfall_godot.{}", self.prefix, self.suffix)
    }

    /// Its path in the add-on, from `addons/footfall`.
    fn shipped(&self, flavour: Flavour) -> PathBuf {
        let name = match flavour {
            Flavour::Editor => format!("{}footfall_godot.editor.{}", self.prefix, self.suffix),
            Flavour::Game => self.built(),
        };
        Path::new("bin").join(self.folder).join(name)
    }
}

/// Builds the library and puts it into `addons/footfall/bin`.
///
/// # Errors
/// When the platform is unknown, the build fails or the file cannot be put in place.
pub(crate) fn build(options: &Options) -> Result<()> {
    let platform = Platform::of(options.target.as_deref())?;
    // The editor's flavour comes last: it is what the next build most likely wants again.
    let flavours: &[Flavour] = if options.all {
        &[Flavour::Game, Flavour::Editor]
    } else {
        &[Flavour::Editor]
    };
    for &flavour in flavours {
        let built = if options.target.as_deref() == Some(MACOS_UNIVERSAL) {
            build_universal(flavour, options, &platform)?
        } else {
            build_one(flavour, options, options.target.as_deref(), &platform)?
        };
        let shipped = paths::addon().join(platform.shipped(flavour));
        replace(&built, &shipped)?;
        eprintln!("{} flavour: {}", flavour.name(), shipped.display());
    }
    Ok(())
}

fn build_one(
    flavour: Flavour,
    options: &Options,
    target: Option<&str>,
    platform: &Platform,
) -> Result<PathBuf> {
    let mut folder = paths::target_folder();
    let mut cargo = process::cargo();
    cargo.args(["build", "--locked", "--package", "footfall_godot"]);
    if let Some(target) = target {
        cargo.args(["--target", target]);
        folder.push(target);
        if let Some((variable, linker)) = debian_linker(target)
            && env::var_os(variable).is_none()
            && paths::on_path(&[linker]).is_some()
        {
            cargo.env(variable, linker);
        }
    }
    if flavour == Flavour::Editor {
        cargo.args(["--features", "editor"]);
    }
    let profile = match flavour {
        _ if options.debug => "dev",
        Flavour::Game if options.shipped => "shipped",
        _ => "release",
    };
    cargo.args(["--profile", profile]);
    folder.push(if options.debug { "debug" } else { profile });
    process::run(&mut cargo)?;
    Ok(folder.join(platform.built()))
}

/// The linker for another architecture as Debian names it, and the variable in which cargo looks for it.
fn debian_linker(target: &str) -> Option<(&'static str, &'static str)> {
    let foreign = target == "aarch64-unknown-linux-gnu" && ARCH != "aarch64";
    foreign.then_some((
        "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER",
        "aarch64-linux-gnu-gcc",
    ))
}

fn build_universal(flavour: Flavour, options: &Options, platform: &Platform) -> Result<PathBuf> {
    let mut parts = Vec::new();
    for target in ["x86_64-apple-darwin", "aarch64-apple-darwin"] {
        parts.push(build_one(flavour, options, Some(target), platform)?);
    }
    let joined = paths::target_folder().join(platform.built());
    process::run(
        Command::new("lipo")
            .arg("-create")
            .arg("-output")
            .arg(&joined)
            .args(&parts),
    )?;
    Ok(joined)
}

/// Copies beside and renames, so that a running editor keeps the file that it has open.
fn replace(source: &Path, destination: &Path) -> Result<()> {
    let folder = destination.parent().context("the library needs a folder")?;
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let fresh = destination.with_extension("fresh");
    fs::copy(source, &fresh)
        .with_context(|| format!("cannot copy {} to {}", source.display(), fresh.display()))?;
    fs::rename(&fresh, destination).with_context(|| {
        format!(
            "cannot replace {}: close the Godot editor that has it open",
            destination.display()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_named_as_the_gdextension_file_names_them() {
        let shipped = |target, flavour| {
            Platform::of(Some(target))
                .unwrap()
                .shipped(flavour)
                .display()
                .to_string()
        };
        let editor = Flavour::Editor;
        assert_eq!(
            shipped("x86_64-unknown-linux-gnu", editor),
            "bin/linux-x86_64/libfootfall_godot.editor.so"
        );
        assert_eq!(
            shipped("x86_64-unknown-linux-gnu", Flavour::Game),
            "bin/linux-x86_64/libfootfall_godot.so"
        );
        assert_eq!(
            shipped("aarch64-unknown-linux-gnu", Flavour::Game),
            "bin/linux-arm64/libfootfall_godot.so"
        );
        assert_eq!(
            shipped("x86_64-pc-windows-gnu", editor),
            "bin/windows-x86_64/footfall_godot.editor.dll"
        );
        assert_eq!(
            shipped(MACOS_UNIVERSAL, Flavour::Game),
            "bin/macos-universal/libfootfall_godot.dylib"
        );
        assert_eq!(
            shipped("aarch64-linux-android", Flavour::Game),
            "bin/android-arm64/libfootfall_godot.so"
        );
        assert!(Platform::of(Some("wasm32-unknown-unknown")).is_err());
        assert!(Platform::of(None).is_ok());
    }
}
