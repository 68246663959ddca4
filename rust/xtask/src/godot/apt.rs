//! Godot from Debian's package archive, unpacked into the cache. Nothing is installed on the system and no rights are needed.
//!
//! The machine's own apt names the archive and the key that signs it. A private apt state then asks that archive for the suite
//! whose Godot is new enough, downloads the packages with all that they need, and `dpkg -x` unpacks them side by side. As they
//! are newer than the machine's own C library, Godot is patched to name the loader and the libraries that came along ([`patched`]).

mod archive;
mod patched;

pub(super) use archive::Archive;

use crate::apt::Apt;
use crate::{fetch, paths, process};
use anyhow::{Context as _, Result, bail};
use archive::Architecture;
use patched::Patcher;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The suite of Debian whose Godot is at least 4.6.
const SUITE: &str = "forky";
/// Godot, its export template and what makes games of it start here, and software rendering for machines without a graphics card.
const PACKAGES: [&str; 9] = [
    "godot",
    "godot-template-release",
    "patchelf",
    "libgl1-mesa-dri",
    "libegl1",
    "libgl1",
    "libglx-mesa0",
    "mesa-vulkan-drivers",
    "libvulkan1",
];
/// Path of the export template, from the cache folder.
pub(super) const RELEASE_TEMPLATE: &str = "root/usr/bin/godot-template-release";
/// Script that starts Godot, from the cache folder.
const STARTER: &str = "godot";

/// Downloads and unpacks; what an interrupted run had finished is kept. Returns the script that starts Godot.
pub(super) fn fetch(archive: &Archive, cache: &Path) -> Result<PathBuf> {
    unpack(archive, archive.architecture, &PACKAGES, cache).context("about 750 MB are needed")?;
    write_starter(archive.architecture, cache)
}

/// Godot for arm64 in a folder with all that it needs besides a kernel, as an emulator takes it; returns the root of its files.
///
/// # Errors
/// When it is not available.
pub(super) fn arm64(cache: &Path) -> Result<PathBuf> {
    let architecture = &archive::ARM64;
    let root = unpack(&Archive::find(cache)?, architecture, &["godot"], cache)?;
    // Programs name the loader in a folder that packages leave to the system.
    let link = root.join("lib");
    if !link.exists() {
        link_folder("usr/lib", &link).with_context(|| format!("cannot make {}", link.display()))?;
    }
    Ok(root)
}

#[cfg(unix)]
fn link_folder(to: &str, link: &Path) -> Result<()> {
    Ok(std::os::unix::fs::symlink(to, link)?)
}

#[cfg(not(unix))]
fn link_folder(_to: &str, _link: &Path) -> Result<()> {
    bail!("Debian's programs run on Linux only")
}

/// Downloads packages of the suite with all that they need, and unpacks them into the folder that is returned.
fn unpack(
    archive: &Archive,
    architecture: &Architecture,
    names: &[&str],
    cache: &Path,
) -> Result<PathBuf> {
    let state = cache.join("apt");
    let mut apt = Apt::bare(&state)?;
    let source = state.join("footfall.sources");
    fs::write(&source, archive.source())
        .with_context(|| format!("cannot write {}", source.display()))?;
    apt.option(&format!("Dir::Etc::SourceList={}", source.display()));
    apt.option("Dir::Etc::SourceParts=/dev/null");
    apt.option(&format!("APT::Architecture={}", architecture.debian));
    // Else the machine's own is among them.
    apt.option(&format!("APT::Architectures={}", architecture.debian));

    eprintln!("asking {} for Debian's suite {SUITE} …", archive.site);
    process::read(apt.get().arg("update")).with_context(|| {
        format!(
            "cannot read the suite {SUITE} of {}; check the network connection",
            archive.site
        )
    })?;
    let packages = apt.packages(names)?;
    apt.download(names, &packages)?;
    let root = cache.join("root");
    apt.unpack(&packages, &root, "unpacking Godot")?;
    Ok(root)
}

/// Brings what an earlier version of this program unpacked to how it is unpacked now; nothing is fetched.
///
/// # Errors
/// When files of the cache cannot be changed.
pub(super) fn refresh(cache: &Path) -> Result<()> {
    let architecture = Architecture::of_host()?;
    let starter = fs::read_to_string(cache.join(STARTER)).unwrap_or_default();
    if starter != starter_script(architecture) {
        write_starter(architecture, cache)?;
    }
    Ok(())
}

/// Makes Godot start with its own loader and libraries, and writes the script that starts it; the script comes last, for it says that
/// the rest is done.
fn write_starter(architecture: &'static Architecture, cache: &Path) -> Result<PathBuf> {
    let root = cache.join("root");
    for part in [architecture.loader, "usr/bin/godot"] {
        if !root.join(part).exists() {
            bail!("the packages do not hold {part}: Debian's layout has changed");
        }
    }
    let patcher = Patcher::new(&root, architecture);
    patcher.libraries()?;
    patcher.program(&root.join("usr/bin/godot"))?;
    let starter = cache.join(STARTER);
    let partial = cache.join("godot.partial");
    fs::write(&partial, starter_script(architecture))
        .with_context(|| format!("cannot write {}", partial.display()))?;
    fetch::make_executable(&partial)?;
    fs::rename(&partial, &starter)
        .with_context(|| format!("cannot write {}", starter.display()))?;
    Ok(starter)
}

fn starter_script(architecture: &Architecture) -> String {
    let libraries = architecture.libraries;
    format!(
        "#!/bin/sh\n\
         # Written by `cargo xtask godot`: starts Debian's Godot with the drivers that came with it.\n\
         root=\"$(dirname -- \"$(readlink -f -- \"$0\")\")/root\"\n\
         LIBGL_DRIVERS_PATH=\"$root/{libraries}/dri\" exec \"$root/usr/bin/godot\" \"$@\"\n"
    )
}

/// A command that starts a game which was exported with Debian's template. It needs the loader and the libraries that the template came
/// with, so a copy of it is made beside it that names them (its other files are linked): started through the loader it would not find its data.
pub(super) fn game(cache: &Path, game: &Path) -> Result<Command> {
    let root = cache.join("root");
    let architecture = Architecture::of_host()?;
    let folder = game.with_extension("started");
    paths::make_empty(&folder)?;
    let home = game.parent().context("a game without a folder")?;
    for entry in fs::read_dir(home).with_context(|| format!("cannot read {}", home.display()))? {
        let file = entry?.path();
        if let Some(name) = file.file_name().filter(|_| file.is_file()) {
            fs::hard_link(&file, folder.join(name))
                .with_context(|| format!("cannot link {}", file.display()))?;
        }
    }
    let copy = folder.join(game.file_name().context("a game without a name")?);
    Patcher::new(&root, architecture).program(&copy)?;
    let mut command = Command::new(copy);
    command.env(
        "LIBGL_DRIVERS_PATH",
        root.join(architecture.libraries).join("dri"),
    );
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use archive::ARCHITECTURES;

    #[test]
    fn the_starter_uses_the_drivers_that_came_along() {
        let script = starter_script(&ARCHITECTURES[0]);
        assert!(script.contains("usr/lib/x86_64-linux-gnu/dri"));
        assert!(script.ends_with("exec \"$root/usr/bin/godot\" \"$@\"\n"));
    }
}
