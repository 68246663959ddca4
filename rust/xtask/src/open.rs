//! `cargo xtask open`: Godot on a project of the repository, on a display in memory where there is none.

use crate::display::Display;
use crate::godot::Engine;
use crate::{display, godot, link, paths, process};
use anyhow::{Result, bail};
use std::path::Path;
use std::process::Command;

/// The window's size in pixels on a display in memory.
pub(crate) const SIZE: (u32, u32) = (1280, 720);

/// Starts Godot on a project folder, given from the repository's root, and passes the arguments on.
///
/// # Errors
/// When there is no such project, no Godot, no display, or when Godot fails.
pub(crate) fn command(project: &Path, arguments: &[String]) -> Result<()> {
    let folder = paths::repository_root().join(project);
    if !folder.join("project.godot").is_file() {
        bail!("{} holds no project.godot", folder.display());
    }
    let engine = godot::provision()?;
    link::ensure()?;
    let needs_no_window = arguments.iter().any(|argument| argument == "--headless");
    let display = if needs_no_window {
        Display::Screen
    } else {
        display::ensure()?
    };
    process::run(on(&engine, &display, &folder).args(arguments))
}

/// Godot on a project. A display in memory draws in software, which the compatibility renderer can, and is mute.
pub(crate) fn on(engine: &Engine, display: &Display, project: &Path) -> Command {
    let mut command = display.command(&engine.program, SIZE);
    command.arg("--path").arg(project);
    if display.is_virtual() {
        command.args(["--rendering-driver", "opengl3", "--audio-driver", "Dummy"]);
    }
    command
}

/// Godot on a project without any window or sound.
pub(crate) fn headless(engine: &Engine, project: &Path) -> Command {
    let mut command = Command::new(&engine.program);
    command
        .args(["--headless", "--audio-driver", "Dummy", "--path"])
        .arg(project);
    command
}
