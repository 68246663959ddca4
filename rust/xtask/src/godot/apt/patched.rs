//! Debian's programs made to start by themselves: patched so that they name the loader and the libraries that came along.
//!
//! Started by way of that loader instead, Godot would take the loader for itself, and *Play* in the editor would start the loader.

use super::archive::Architecture;
use crate::{fetch, process};
use anyhow::{Context as _, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Patches programs that were unpacked into `root`, or that were copied from there.
pub(super) struct Patcher<'a> {
    root: &'a Path,
    architecture: &'static Architecture,
}

impl<'a> Patcher<'a> {
    pub(super) fn new(root: &'a Path, architecture: &'static Architecture) -> Self {
        Self { root, architecture }
    }

    /// Search path of the libraries.
    fn library_path(&self) -> String {
        let libraries = self.root.join(self.architecture.libraries);
        [
            libraries.clone(),
            libraries.join("pulseaudio"),
            self.root.join("usr/lib"),
        ]
        .map(|folder| folder.display().to_string())
        .join(":")
    }

    /// `patchelf`, which came along too and so needs the loader itself.
    fn patchelf(&self) -> Command {
        let mut command = Command::new(self.root.join(self.architecture.loader));
        command
            .arg("--library-path")
            .arg(self.library_path())
            .arg(self.root.join("usr/bin/patchelf"));
        command
    }

    /// Makes a program start here.
    ///
    /// # Errors
    /// When it is not to be patched or replaced.
    pub(super) fn program(&self, file: &Path) -> Result<()> {
        let loader = self.root.join(self.architecture.loader);
        replace(file, |copy| {
            let mut patchelf = self.patchelf();
            patchelf
                .arg("--set-interpreter")
                .arg(&loader)
                .args(["--force-rpath", "--set-rpath", &self.library_path()])
                .arg(copy);
            process::read(&mut patchelf).map(drop)
        })?;
        fetch::make_executable(file)
    }

    /// Has libraries that look for others in a folder of the system look where the program does.
    ///
    /// # Errors
    /// When one is not to be patched or replaced.
    pub(super) fn libraries(&self) -> Result<()> {
        let folder = self.root.join(self.architecture.libraries);
        for library in shared_objects(&folder)? {
            // What is no library by its content has no path either.
            let path = process::read(self.patchelf().arg("--print-rpath").arg(&library));
            if path.is_ok_and(|path| !path.trim().is_empty()) {
                replace(&library, |copy| {
                    process::read(self.patchelf().arg("--remove-rpath").arg(copy)).map(drop)
                })?;
            }
        }
        Ok(())
    }
}

/// Changes a copy and puts it in the file's place: programs that run keep what they have open.
fn replace(file: &Path, change: impl Fn(&Path) -> Result<()>) -> Result<()> {
    let copy = file.with_extension("partial");
    fs::copy(file, &copy).with_context(|| format!("cannot copy {}", file.display()))?;
    change(&copy).with_context(|| format!("cannot patch {}", file.display()))?;
    fs::rename(&copy, file).with_context(|| format!("cannot replace {}", file.display()))
}

/// The libraries of a folder, each once: links lead to others of them.
fn shared_objects(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut libraries = Vec::new();
    for entry in
        fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?
    {
        let entry = entry?;
        let name = entry.file_name();
        if entry.file_type()?.is_file() && name.to_string_lossy().contains(".so") {
            libraries.push(entry.path());
        }
    }
    libraries.sort();
    Ok(libraries)
}
