//! `cargo xtask export`: the demo as a game that players start.

use crate::godot::Engine;
use crate::{demo, engine_run, godot, library, link, open, paths};
use anyhow::{Context as _, Result, bail};
use std::env::consts::{ARCH, OS};
use std::fs;
use std::path::{Path, PathBuf};

/// The preset's name.
const PRESET: &str = "Footfall";
/// Frames that the exported game looks into each of its scenes when it is started for a check.
const FRAMES: &str = "20";

/// Exports the demo and starts it once; `shipped` with the library as it is released.
///
/// # Errors
/// When the demo cannot be exported here, or what was exported does not run.
pub(crate) fn command(shipped: bool) -> Result<()> {
    library::build(&library::Options {
        all: true,
        shipped,
        ..library::Options::default()
    })?;
    let engine = godot::provision()?;
    let game = export(&engine)?;
    start(&engine, &game)?;
    println!("{}", game.display());
    Ok(())
}

/// Exports the demo with the release template at hand; the library's game flavour must be built. Returns the executable.
///
/// # Errors
/// When this is no Linux, or Godot fails.
pub(crate) fn export(engine: &Engine) -> Result<PathBuf> {
    if OS != "linux" {
        bail!("the demo is exported on Linux only: elsewhere use Project, Export in the editor");
    }
    link::ensure()?;
    let project = paths::repository_root().join("demo_project");
    demo::import(engine, &project, "demo")?;
    let folder = paths::target_folder().join("export");
    let game = folder.join(format!("footfall_demo.{ARCH}"));
    let log = paths::target_folder().join("verify/export.log");
    make(engine, &project, &game, &log)?;
    Ok(game)
}

/// Exports a project, as it is, to an executable in a folder of its own, which is made anew.
///
/// # Errors
/// When Godot fails or reports an error.
pub(crate) fn make(engine: &Engine, project: &Path, game: &Path, log: &Path) -> Result<()> {
    let folder = game.parent().context("a game without a folder")?;
    let presets = project.join("export_presets.cfg");
    fs::write(&presets, preset(engine.release_template.as_deref()))
        .with_context(|| format!("cannot write {}", presets.display()))?;
    paths::make_empty(folder)?;
    let exported = engine_run::quiet(
        open::headless(engine, project)
            .args(["--export-release", PRESET])
            .arg(game),
        log,
    );
    fs::remove_file(&presets).with_context(|| format!("cannot remove {}", presets.display()))?;
    exported?;
    for file in [game, &game.with_extension("pck")] {
        if !file.is_file() {
            bail!(
                "Godot exported no {}; its output is in {}",
                file.display(),
                log.display()
            );
        }
    }
    Ok(())
}

/// Starts the exported game without a window; it looks into every scene and quits.
///
/// # Errors
/// When it does not start, complains, or a scene does not load.
pub(crate) fn start(engine: &Engine, game: &Path) -> Result<()> {
    let log = paths::target_folder().join("verify/exported_demo.log");
    let said = engine_run::judged(
        godot::exported_game(engine, game)?
            .args(["--headless", "--audio-driver", "Dummy", "--fixed-fps", "60"])
            .args(["--", "--every-scene", FRAMES]),
        &log,
    )?;
    if !said.contains("DEMO OK") {
        bail!("the exported demo failed: {}", log.display());
    }
    Ok(())
}

/// An export preset for this machine. Without a template it is the official one, which the editor has installed.
fn preset(template: Option<&Path>) -> String {
    let architecture = if ARCH == "aarch64" { "arm64" } else { ARCH };
    let template = template.map_or_else(String::new, |file| file.display().to_string());
    format!(
        r#"[preset.0]

name="{PRESET}"
platform="Linux"
runnable=true
dedicated_server=false
custom_features=""
export_filter="all_resources"
include_filter=""
exclude_filter=""
export_path=""
script_export_mode=2

[preset.0.options]

custom_template/debug=""
custom_template/release="{template}"
debug/export_console_wrapper=0
binary_format/embed_pck=false
binary_format/architecture="{architecture}"
texture_format/s3tc_bptc=true
texture_format/etc2_astc=false
"#
    )
}
