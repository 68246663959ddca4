//! A display to draw on: the user's own, or a virtual one (`Xvfb`) with software OpenGL where there is none.

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Packages of a virtual display on Debian-like systems.
const PACKAGES: [&str; 3] = ["xvfb", "xauth", "libgl1-mesa-dri"];

/// Display that a window appears on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Display {
    /// On the user's screen.
    Screen,
    /// On a display in memory, by way of this `xvfb-run`.
    Virtual(PathBuf),
}

impl Display {
    /// Returns whether the user sees nothing of it.
    pub(crate) fn is_virtual(&self) -> bool {
        matches!(self, Self::Virtual(_))
    }

    /// A command that starts `program` on this display, with `size` in pixels for one in memory.
    pub(crate) fn command(&self, program: &std::path::Path, size: (u32, u32)) -> Command {
        match self {
            Self::Screen => Command::new(program),
            Self::Virtual(xvfb_run) => {
                let mut command = Command::new(xvfb_run);
                command
                    .args(["-a", "-s", &format!("-screen 0 {}x{}x24", size.0, size.1)])
                    .arg(program);
                command
            }
        }
    }
}

/// Finds a display, installing a virtual one where that is needed and allowed.
///
/// # Errors
/// When there is no display and none can be had; the message names the packages to install.
pub(crate) fn ensure() -> Result<Display> {
    let set = |name: &str| env::var_os(name).is_some_and(|value| !value.is_empty());
    if !cfg!(target_os = "linux") || set("DISPLAY") || set("WAYLAND_DISPLAY") {
        return Ok(Display::Screen);
    }
    let missing = missing();
    if !missing.is_empty() {
        install(&missing)?;
    }
    let xvfb_run = paths::on_path(&["xvfb-run"])
        .context("there is no `xvfb-run` on the PATH: install xvfb")?;
    Ok(Display::Virtual(xvfb_run))
}

/// Those packages of a virtual display that are not there.
fn missing() -> Vec<&'static str> {
    let tools = |names: &[&str]| names.iter().all(|name| paths::on_path(&[name]).is_some());
    let there = |package: &str| match package {
        "xvfb" => tools(&["xvfb-run", "Xvfb"]),
        "xauth" => tools(&["xauth"]),
        _ => software_gl(),
    };
    PACKAGES
        .into_iter()
        .filter(|package| !there(package))
        .collect()
}

/// Returns whether the X server has a driver that draws in software; its place differs between distributions and their ages.
fn software_gl() -> bool {
    let folders = fs::read_dir("/usr/lib")
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    folders
        .chain(["/usr/lib".into(), "/usr/lib64".into()])
        .any(|folder| {
            let gallium = fs::read_dir(&folder).into_iter().flatten().flatten();
            folder.join("dri/swrast_dri.so").exists()
                || gallium
                    .map(|entry| entry.file_name())
                    .any(|name| name.to_string_lossy().starts_with("libgallium-"))
        })
}

fn install(packages: &[&str]) -> Result<()> {
    let wanted = packages.join(" ");
    let advice = format!(
        "there is no display, and the one in memory lacks: {wanted}.\n\
         On Debian and Ubuntu: sudo apt-get install {wanted}\n\
         Elsewhere: install Xvfb, xauth and Mesa's software OpenGL, or run this where DISPLAY is set."
    );
    if paths::on_path(&["apt-get"]).is_none() || !is_root() {
        bail!("{advice}");
    }
    eprintln!("no display: installing {wanted} for a virtual one …");
    let apt_get = || {
        let mut command = Command::new("apt-get");
        command
            .env("DEBIAN_FRONTEND", "noninteractive")
            .env("LC_ALL", "C");
        command
    };
    let attempt = || {
        process::read(
            apt_get()
                .args(["install", "-y", "-q=2", "--no-install-recommends"])
                .args(packages),
        )
        .map(drop)
    };
    // Lists that are missing or stale make the first attempt fail: fetch them and try once more.
    if attempt().is_err() {
        process::read(apt_get().args(["update", "-q=2"])).with_context(|| advice.clone())?;
        attempt().with_context(|| advice.clone())?;
    }
    Ok(())
}

fn is_root() -> bool {
    process::read(Command::new("id").arg("-u")).is_ok_and(|said| said.trim() == "0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_virtual_display_wraps_the_program() {
        let display = Display::Virtual("xvfb-run".into());
        let mut command = display.command(Path::new("godot"), (640, 360));
        assert_eq!(
            process::shown(command.arg("--path")),
            "xvfb-run -a -s -screen 0 640x360x24 godot --path"
        );
        assert_eq!(
            process::shown(&Display::Screen.command(Path::new("godot"), (640, 360))),
            "godot"
        );
        assert!(display.is_virtual() && !Display::Screen.is_virtual());
    }
}
