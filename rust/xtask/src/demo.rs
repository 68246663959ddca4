//! `cargo demo`: builds the add-on and opens the demo, or leaves pictures of it where there is no display.

use crate::display::{self, Display};
use crate::{contact_sheet, engine_run, godot, library, link, open, paths, process};
use anyhow::{Context as _, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

/// The demo's scenes by topic.
pub(crate) const SCENES: [(&str, &str); 12] = [
    ("town", "res://scenes/town/town.tscn"),
    ("walk", "res://scenes/walk/walk.tscn"),
    ("styles", "res://scenes/styles/styles.tscn"),
    ("layers", "res://scenes/layers/layers.tscn"),
    ("uneven", "res://scenes/uneven/uneven.tscn"),
    ("crowd", "res://scenes/crowd/crowd.tscn"),
    (
        "third_person",
        "res://scenes/third_person/third_person.tscn",
    ),
    ("network", "res://scenes/network/network.tscn"),
    (
        "own_character",
        "res://scenes/own_character/own_character.tscn",
    ),
    ("sensor", "res://scenes/sensor/sensor.tscn"),
    ("live_sensor", "res://scenes/live_sensor/live_sensor.tscn"),
    ("switching", "res://scenes/switching/switching.tscn"),
];

/// Builds all that the demo needs and shows it.
///
/// # Errors
/// When a part cannot be built or had, or the demo leaves no pictures.
pub(crate) fn command() -> Result<()> {
    let stage = Stage::build("demo")?;
    eprintln!("Godot {}", stage.engine.version);
    if !stage.display.is_virtual() {
        eprintln!("the demo runs in a window; close the window to end");
        return process::run(&mut stage.godot());
    }
    let folder = paths::target_folder().join("demo");
    paths::make_empty(&folder)?;
    eprintln!("no display: rendering pictures in software …");
    for (topic, scene) in SCENES {
        let folder = folder.join(topic);
        let pictures = stage.photograph(scene, &[], &[], &folder)?;
        let sheet = folder.join("contact_sheet.png");
        contact_sheet::write(&pictures, &sheet)?;
        eprintln!("{} pictures in {}", pictures.len(), folder.display());
        println!("{}", sheet.display());
    }
    Ok(())
}

/// The demo project, built and imported, and a display to show it on.
pub(crate) struct Stage {
    engine: godot::Engine,
    display: Display,
    project: PathBuf,
}

impl Stage {
    /// Builds the add-on and has Godot import the demo; its log has a name.
    ///
    /// # Errors
    /// When a part cannot be built or had.
    pub(crate) fn build(name: &str) -> Result<Self> {
        library::build(&library::Options::default())?;
        let engine = godot::provision()?;
        link::ensure()?;
        let display = display::ensure()?;
        let project = paths::repository_root().join("demo_project");
        import(&engine, &project, name)?;
        Ok(Self {
            engine,
            display,
            project,
        })
    }

    /// Godot with the demo.
    pub(crate) fn godot(&self) -> Command {
        open::on(&self.engine, &self.display, &self.project)
    }

    /// Lets a scene take pictures of itself; `options` are the engine's, `asked` the scene's.
    ///
    /// # Errors
    /// When the scene fails, or leaves no pictures.
    pub(crate) fn photograph(
        &self,
        scene: &str,
        options: &[&str],
        asked: &[&str],
        folder: &Path,
    ) -> Result<Vec<PathBuf>> {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
        let mut command = self.godot();
        // Time in the scene runs by frames, however long one takes to draw.
        command
            .args([scene, "--fixed-fps", "60"])
            .args(options)
            .args(["--", "--pictures"])
            .arg(folder)
            .args(asked);
        let log = folder.join("godot.log");
        engine_run::judged(&mut command, &log)?;
        let pictures = contact_sheet::pictures(folder)?;
        if pictures.is_empty() {
            bail!(
                "the scene rendered no pictures; Godot's output is in {}",
                log.display()
            );
        }
        Ok(pictures)
    }
}

/// Projects that this run has imported: that takes three seconds each time, and nothing changes them in between.
static IMPORTED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Lets Godot import a project's files, once in a run, so that it knows the add-on and the character.
///
/// # Errors
/// As [`engine_run::judged`].
pub(crate) fn import(engine: &godot::Engine, project: &Path, name: &str) -> Result<()> {
    let mut imported = IMPORTED.lock().unwrap_or_else(PoisonError::into_inner);
    if imported.iter().any(|known| known == project) {
        return Ok(());
    }
    let log = paths::target_folder()
        .join("verify")
        .join(format!("{name}_import.log"));
    eprintln!("importing {} …", project.display());
    let known = project.join(".godot/extension_list.cfg").is_file();
    if !known {
        // The first import only learns of the extension; files that its classes import need a second one.
        engine_run::started(open::headless(engine, project).arg("--import"), &log)?;
    }
    engine_run::judged(open::headless(engine, project).arg("--import"), &log)?;
    imported.push(project.to_path_buf());
    Ok(())
}
