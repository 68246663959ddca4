//! Godot from Debian's package archive, unpacked into the cache. Nothing is installed on the system and no rights are needed.
//!
//! The machine's own apt names the archive and the key that signs it. A private apt state then asks that archive for the suite
//! whose Godot is new enough, downloads the packages with all that they need, and `dpkg -x` unpacks them side by side. As they
//! are newer than the machine's own C library, a script starts Godot with the loader that came along.

mod archive;

pub(super) use archive::Archive;

use crate::{process, progress};
use anyhow::{Context as _, Result, bail};
use archive::Architecture;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

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
/// Where the export template is, from the cache folder.
pub(super) const RELEASE_TEMPLATE: &str = "root/usr/bin/godot-template-release";

/// Options that keep apt's state away from the system's.
fn private_state(folder: &Path) -> Result<Vec<String>> {
    for part in ["lists/partial", "cache/archives/partial"] {
        fs::create_dir_all(folder.join(part))
            .with_context(|| format!("cannot write into {}", folder.display()))?;
    }
    let status = folder.join("status");
    if !status.exists() {
        fs::write(&status, "").with_context(|| format!("cannot write {}", status.display()))?;
    }
    let option = |name: &str, part: &str| format!("-o{name}={}", folder.join(part).display());
    Ok(vec![
        option("Dir::State::Lists", "lists"),
        option("Dir::State::Status", "status"),
        option("Dir::State::extended_states", "extended_states"),
        option("Dir::Cache", "cache"),
        "-oAPT::Install-Recommends=false".into(),
        "-oAcquire::Languages=none".into(),
        // The folder is the user's own: apt's download user could not write there.
        "-oAPT::Sandbox::User=".into(),
        "-oDebug::NoLocking=true".into(),
        "-oAcquire::Retries=3".into(),
    ])
}

fn apt_get(options: &[String]) -> Command {
    let mut command = Command::new("apt-get");
    command
        .env("DEBIAN_FRONTEND", "noninteractive")
        .env("LC_ALL", "C")
        .args(options);
    command
}

/// Downloads and unpacks; what an interrupted run had finished is kept. Returns the script that starts Godot.
pub(super) fn fetch(archive: &Archive, cache: &Path) -> Result<PathBuf> {
    let state = cache.join("apt");
    let mut options = private_state(&state)?;
    let source = state.join("footfall.sources");
    fs::write(&source, archive.source())
        .with_context(|| format!("cannot write {}", source.display()))?;
    options.push(format!("-oDir::Etc::SourceList={}", source.display()));
    options.push("-oDir::Etc::SourceParts=/dev/null".into());
    options.push(format!(
        "-oAPT::Architecture={}",
        archive.architecture.debian
    ));

    eprintln!("asking {} for Debian's suite {SUITE} …", archive.site);
    process::read(apt_get(&options).arg("update")).with_context(|| {
        format!(
            "cannot read the suite {SUITE} of {}; is the network there?",
            archive.site
        )
    })?;
    let packages = packages(&options)?;
    let archives = state.join("cache/archives");
    download(&options, &packages, &archives)?;
    unpack(&packages, &archives, cache)?;
    fs::remove_dir_all(&archives)
        .with_context(|| format!("cannot clear {}", archives.display()))?;
    write_starter(archive.architecture, cache)
}

/// One file to fetch.
#[derive(Debug, PartialEq, Eq)]
struct Package {
    file: String,
    bytes: u64,
}

fn packages(options: &[String]) -> Result<Vec<Package>> {
    let said = process::read(
        apt_get(options)
            .args(["install", "-y", "--download-only", "--print-uris", "-qq"])
            .args(PACKAGES),
    )
    .with_context(|| format!("apt finds no way to have {}", PACKAGES.join(", ")))?;
    let packages = parse_uris(&said);
    if packages.is_empty() {
        bail!("apt lists nothing to download: remove the cache's folder `apt` and run this again");
    }
    Ok(packages)
}

/// Lines such as `'<address>' name_1.0_amd64.deb 1234 SHA256:…`.
fn parse_uris(said: &str) -> Vec<Package> {
    let package = |line: &str| {
        let mut words = line
            .strip_prefix('\'')?
            .split_once('\'')?
            .1
            .split_whitespace();
        Some(Package {
            file: words.next()?.to_owned(),
            bytes: words.next()?.parse().ok()?,
        })
    };
    said.lines().filter_map(package).collect()
}

fn download(options: &[String], packages: &[Package], archives: &Path) -> Result<()> {
    let total = packages.iter().map(|package| package.bytes).sum();
    let bar = progress::bytes(total, &format!("downloading {} packages", packages.len()));
    let log = archives.with_file_name("download.log");
    let output =
        fs::File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
    let mut child = apt_get(options)
        .args(["install", "-y", "--download-only", "-q=2"])
        .args(PACKAGES)
        .stdin(Stdio::null())
        .stdout(output.try_clone()?)
        .stderr(output)
        .spawn()
        .context("cannot start `apt-get`")?;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        bar.set_position(bytes_in(archives) + bytes_in(&archives.join("partial")));
        std::thread::sleep(Duration::from_millis(100));
    };
    bar.finish_and_clear();
    if !status.success() {
        let said = fs::read_to_string(&log).unwrap_or_default();
        bail!(
            "the download broke off; run this again to go on where it stopped:\n{}",
            process::tail(&said, 8)
        );
    }
    Ok(())
}

/// The size of the packages that lie in a folder, whole or in part.
fn bytes_in(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else {
        return 0;
    };
    entries
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().contains(".deb"))
        .filter_map(|entry| entry.metadata().ok())
        .map(|data| data.len())
        .sum()
}

/// Unpacks beside the final folder and renames at the end, so that a half-made one is never taken for whole.
fn unpack(packages: &[Package], archives: &Path, cache: &Path) -> Result<()> {
    let (partial, root) = (cache.join("root.partial"), cache.join("root"));
    for folder in [&partial, &root] {
        if folder.exists() {
            fs::remove_dir_all(folder)
                .with_context(|| format!("cannot remove {}", folder.display()))?;
        }
    }
    fs::create_dir_all(&partial).with_context(|| format!("cannot create {}", partial.display()))?;
    let bar = progress::count(packages.len() as u64, "unpacking Godot");
    for package in packages {
        process::read(
            Command::new("dpkg")
                .arg("-x")
                .arg(archives.join(&package.file))
                .arg(&partial),
        )
        .with_context(|| {
            format!(
                "cannot unpack {}: is the disk full? (about 750 MB are needed)",
                package.file
            )
        })?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    fs::rename(&partial, &root).with_context(|| format!("cannot create {}", root.display()))
}

/// Writes the script that starts Godot with its own loader and libraries.
fn write_starter(architecture: &Architecture, cache: &Path) -> Result<PathBuf> {
    let root = cache.join("root");
    for part in [architecture.loader, "usr/bin/godot"] {
        if !root.join(part).exists() {
            bail!("the packages do not hold {part}: Debian's layout has changed");
        }
    }
    let starter = cache.join("godot");
    fs::write(&starter, starter_script(architecture))
        .with_context(|| format!("cannot write {}", starter.display()))?;
    make_executable(&starter)?;
    Ok(starter)
}

fn starter_script(architecture: &Architecture) -> String {
    let Architecture {
        libraries, loader, ..
    } = architecture;
    format!(
        "#!/bin/sh\n\
         # Written by `cargo xtask godot`: starts Debian's Godot with the loader and the libraries that came with it.\n\
         root=\"$(dirname -- \"$(readlink -f -- \"$0\")\")/root\"\n\
         LIBGL_DRIVERS_PATH=\"$root/{libraries}/dri\" exec \"$root/{loader}\" \\\n  \
         --library-path \"$root/{libraries}:$root/{libraries}/pulseaudio:$root/usr/lib\" \"$root/usr/bin/godot\" \"$@\"\n"
    )
}

/// A command that starts a game which was exported with Debian's template. It needs the loader and the libraries that the template came
/// with, so a copy of it is made beside it that names that loader: started through the loader it would not find its data.
pub(super) fn game(cache: &Path, game: &Path) -> Result<Command> {
    let root = cache.join("root");
    let architecture = Architecture::of_host()?;
    let library_path = [
        root.join(architecture.libraries),
        root.join(architecture.libraries).join("pulseaudio"),
        root.join("usr/lib"),
    ]
    .map(|folder| folder.display().to_string())
    .join(":");
    let loader = root.join(architecture.loader);
    let folder = game.with_extension("started");
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .with_context(|| format!("cannot clear {}", folder.display()))?;
    }
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let home = game.parent().context("a game without a folder")?;
    for entry in fs::read_dir(home).with_context(|| format!("cannot read {}", home.display()))? {
        let file = entry?.path();
        if let Some(name) = file.file_name().filter(|_| file.is_file()) {
            fs::copy(&file, folder.join(name))
                .with_context(|| format!("cannot copy {}", file.display()))?;
        }
    }
    let copy = folder.join(game.file_name().context("a game without a name")?);
    process::read(
        Command::new(&loader)
            .arg("--library-path")
            .arg(&library_path)
            .arg(root.join("usr/bin/patchelf"))
            .arg("--set-interpreter")
            .args([&loader, &copy]),
    )
    .context("patchelf cannot change the exported game")?;
    make_executable(&copy)?;
    let mut command = Command::new(copy);
    command.env("LD_LIBRARY_PATH", library_path).env(
        "LIBGL_DRIVERS_PATH",
        root.join(architecture.libraries).join("dri"),
    );
    Ok(command)
}

#[cfg(unix)]
fn make_executable(file: &Path) -> Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    fs::set_permissions(file, fs::Permissions::from_mode(0o755))
        .with_context(|| format!("cannot make {} executable", file.display()))
}

#[cfg(not(unix))]
fn make_executable(_file: &Path) -> Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use archive::ARCHITECTURES;

    #[test]
    fn sizes_and_names_are_read_from_apt() {
        let said = "'http://x/pool/g/godot_4.6%2bds-1_amd64.deb' godot_4.6+ds-1_amd64.deb 1234 SHA256:ab\nNotice: other\n";
        assert_eq!(
            parse_uris(said),
            [Package {
                file: "godot_4.6+ds-1_amd64.deb".into(),
                bytes: 1234
            }]
        );
    }

    #[test]
    fn the_starter_uses_the_loader_that_came_along() {
        let script = starter_script(&ARCHITECTURES[0]);
        assert!(script.contains("exec \"$root/usr/lib64/ld-linux-x86-64.so.2\""));
        assert!(
            script.contains("pulseaudio") && script.ends_with("\"$root/usr/bin/godot\" \"$@\"\n")
        );
    }
}
