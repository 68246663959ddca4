//! `cargo xtask library`: the add-on's library, built and put where `footfall.gdextension` looks for it.
//!
//! There are two flavours. The editor's (`libfootfall_godot.editor.so` and its like) holds the class docs and the dock;
//! exported games load the plain one. Both share every compiled crate but `footfall_godot`; as it is released, the plain one shares none.

mod platform;

use crate::{cross, paths, process};
use anyhow::{Context as _, Result};
use clap::Args;
use platform::Platform;
use std::env;
use std::env::consts::ARCH;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The target that stands for both of macOS's architectures in one file.
pub(crate) const MACOS_UNIVERSAL: &str = "universal-apple-darwin";

/// Linker script of libraries as games ship them, in the workspace.
const SCRIPT: &str = "crates/footfall_godot/shipped.ld";
/// Exports of the library for Windows, in the workspace. Without them zig exports every function, so that none can be dropped.
const EXPORTS: &str = "crates/footfall_godot/windows.def";
/// Level of the package whose one function fills the engine's method table. At level z LLVM's outliner, which arm64 alone has, takes more than a quarter of an hour for it; elsewhere level z makes
/// the library 0.6 MB smaller.
const METHOD_TABLE: &str = r#"profile.shipped.package.godot-ffi.opt-level="s""#;

/// Feature of the editor's flavour that the other one takes where it is not released: `godot`, which takes minutes to compile, then serves both. No game reads the docs.
const CLASS_DOCS: &str = "godot/register-docs";

/// Settings of the editor's flavour for Android, macOS and Windows, whose linkers keep much code that nothing calls.
const CROSS_EDITOR: [&str; 4] = [
    "--config",
    r#"profile.release.lto="thin""#,
    "--config",
    r#"profile.release.strip="symbols""#,
];

/// Settings of a build of the library.
#[derive(Args, Debug, Clone, Default)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the command line"
)]
pub(crate) struct Options {
    /// Build without optimisation, quickly.
    #[arg(long)]
    pub(crate) debug: bool,
    /// Build the flavour for exported games, too.
    #[arg(long)]
    pub(crate) all: bool,
    /// Build that flavour as it is released: two fifths of the size, in minutes more.
    #[arg(long, requires = "all", conflicts_with = "debug")]
    pub(crate) shipped: bool,
    /// Build for another platform: a target triple, or `universal-apple-darwin`.
    #[arg(long)]
    pub(crate) target: Option<String>,
    /// Compile C and link with zig, which is fetched: for every platform from this one. A Linux target may end in the oldest
    /// glibc that it has to run with, as `x86_64-unknown-linux-gnu.2.31` does.
    #[arg(long, requires = "target")]
    pub(crate) cross: bool,
}

/// One way to build the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flavour {
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

/// Builds the library and puts it into `addons/footfall/bin`.
///
/// # Errors
/// When the platform is unknown, the build fails or the file cannot be put in place.
pub(crate) fn build(options: &Options) -> Result<()> {
    // The editor's flavour comes last: it is what the next build most likely wants again.
    let flavours: &[Flavour] = if options.all {
        &[Flavour::Game, Flavour::Editor]
    } else {
        &[Flavour::Editor]
    };
    for &flavour in flavours {
        let shipped = build_flavour(flavour, options)?;
        eprintln!("{} flavour: {}", flavour.name(), shipped.display());
    }
    Ok(())
}

/// Builds one flavour and puts it into `addons/footfall/bin`; returns the file there.
///
/// # Errors
/// As [`build`].
pub(crate) fn build_flavour(flavour: Flavour, options: &Options) -> Result<PathBuf> {
    let platform = Platform::of(options.target.as_deref())?;
    let built = match options.target.as_deref() {
        Some(target) if options.cross => {
            let (cargo, folder) = cross::cargo(target)?;
            run(cargo, &folder, flavour, options, &platform)?
        }
        Some(MACOS_UNIVERSAL) => build_universal(flavour, options, &platform)?,
        target => build_one(flavour, options, target, &platform)?,
    };
    let shipped = paths::addon().join(platform.shipped(flavour));
    replace(&built, &shipped)?;
    Ok(shipped)
}

/// Place in `addons/footfall/bin` of a target's library, whether it is there or not.
///
/// # Errors
/// When the add-on is not built for the target.
pub(crate) fn place(flavour: Flavour, target: &str) -> Result<PathBuf> {
    let platform = Platform::of(Some(target))?;
    Ok(paths::addon().join(platform.shipped(flavour)))
}

fn build_one(
    flavour: Flavour,
    options: &Options,
    target: Option<&str>,
    platform: &Platform,
) -> Result<PathBuf> {
    let mut cargo = process::cargo();
    cargo.arg("build");
    if let Some(target) = target {
        cargo.args(["--target", target]);
        if let Some((variable, linker)) = debian_linker(target)
            && env::var_os(variable).is_none()
            && paths::on_path(&[linker]).is_some()
        {
            cargo.env(variable, linker);
        }
    }
    run(cargo, target.unwrap_or(""), flavour, options, platform)
}

/// Runs a build that knows its target and leaves the library in a folder of the target folder.
fn run(
    mut cargo: Command,
    folder: &str,
    flavour: Flavour,
    options: &Options,
    platform: &Platform,
) -> Result<PathBuf> {
    cargo.args(["--locked", "--package", "footfall_godot"]);
    let profile = match flavour {
        _ if options.debug => "dev",
        Flavour::Game if options.shipped => "shipped",
        _ => "release",
    };
    cargo.args(["--profile", profile]);
    if flavour == Flavour::Editor {
        cargo.args(["--features", "editor"]);
    } else if profile != "shipped" {
        cargo.args(["--features", CLASS_DOCS]);
    }
    let workspace = paths::workspace();
    let argument = match platform.system() {
        "windows" if options.cross => Some(workspace.join(EXPORTS).display().to_string()),
        _ if profile == "shipped" => platform.link_argument(&workspace.join(SCRIPT)),
        _ => None,
    };
    if let Some(argument) = argument {
        cargo.env("FOOTFALL_LINK_ARG", argument);
    }
    if profile == "shipped" && is_arm64(options.target.as_deref()) {
        cargo.args(["--config", METHOD_TABLE]);
    }
    let keeps_much = matches!(platform.system(), "android" | "macos" | "windows");
    if flavour == Flavour::Editor && profile == "release" && options.cross && keeps_much {
        cargo.args(CROSS_EDITOR);
    }
    process::run(&mut cargo)?;
    let folder = paths::target_folder().join(folder);
    Ok(folder
        .join(if options.debug { "debug" } else { profile })
        .join(platform.built()))
}

/// Returns true where code for arm64 is built, alone or among others.
fn is_arm64(target: Option<&str>) -> bool {
    let target = target.unwrap_or(ARCH);
    target.starts_with("aarch64") || target == MACOS_UNIVERSAL
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
