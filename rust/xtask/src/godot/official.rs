//! The official release of Godot, fetched with the tools that every system has: `curl` and `unzip`, or PowerShell.

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::env::consts::{ARCH, OS};
use std::fs;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const RELEASE: &str = "4.6.3-stable";
const RELEASES: &str = "https://github.com/godotengine/godot/releases/download";

/// Names of the release for one platform.
#[derive(Debug, PartialEq, Eq)]
struct Release {
    /// The part of the archive's name after the version, without `.zip`.
    archive: String,
    /// The program inside the archive.
    program: String,
}

fn release(os: &str, arch: &str) -> Result<Release> {
    let name = format!("Godot_v{RELEASE}");
    let (archive, program) = match (os, arch) {
        ("linux", "x86_64") => (
            format!("{name}_linux.x86_64"),
            format!("{name}_linux.x86_64"),
        ),
        ("linux", "aarch64") => (format!("{name}_linux.arm64"), format!("{name}_linux.arm64")),
        // The console twin waits for the engine and shows its output.
        ("windows", "x86_64") => (
            format!("{name}_win64.exe"),
            format!("{name}_win64_console.exe"),
        ),
        ("windows", "aarch64") => (
            format!("{name}_windows_arm64.exe"),
            format!("{name}_windows_arm64_console.exe"),
        ),
        ("macos", _) => (
            format!("{name}_macos.universal"),
            "Godot.app/Contents/MacOS/Godot".into(),
        ),
        _ => bail!("Godot has no official release for {os} on {arch}"),
    };
    Ok(Release { archive, program })
}

/// Fetches the release into the cache and returns the program. A broken-off download goes on where it stopped.
pub(super) fn fetch(cache: &Path) -> Result<PathBuf> {
    let release = release(OS, ARCH)?;
    let address = format!("{RELEASES}/{RELEASE}/{}.zip", release.archive);
    let archive = cache.join(format!("{}.zip", release.archive));
    if !archive.is_file() {
        let partial = archive.with_extension("zip.partial");
        eprintln!("downloading the official release of Godot {RELEASE} …");
        download(&address, &partial).with_context(|| format!("cannot fetch {address}"))?;
        fs::rename(&partial, &archive)
            .with_context(|| format!("cannot create {}", archive.display()))?;
    }
    let (partial, folder) = (cache.join("release.partial"), cache.join("release"));
    for old in [&partial, &folder] {
        if old.exists() {
            fs::remove_dir_all(old).with_context(|| format!("cannot remove {}", old.display()))?;
        }
    }
    fs::create_dir_all(&partial).with_context(|| format!("cannot create {}", partial.display()))?;
    if let Err(error) = unpack(&archive, &partial) {
        // A damaged archive would fail for ever.
        fs::remove_file(&archive)
            .with_context(|| format!("cannot remove {}", archive.display()))?;
        return Err(error.context("cannot unpack the release; run this again to download it anew"));
    }
    fs::rename(&partial, &folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let program = folder.join(&release.program);
    if !program.is_file() {
        bail!("the release does not hold {}", release.program);
    }
    fs::remove_file(&archive).with_context(|| format!("cannot remove {}", archive.display()))?;
    Ok(program)
}

fn download(address: &str, file: &Path) -> Result<()> {
    let curl =
        paths::on_path(&["curl"]).context("there is no `curl` on this system: install it")?;
    let shown = if std::io::stderr().is_terminal() {
        "--progress-bar"
    } else {
        "-sS"
    };
    process::run(
        Command::new(curl)
            .args([
                "--fail",
                "--location",
                "--retry",
                "3",
                "--continue-at",
                "-",
                shown,
                "--output",
            ])
            .arg(file)
            .arg(address),
    )
}

fn unpack(archive: &Path, folder: &Path) -> Result<()> {
    if cfg!(windows) {
        let quoted = |path: &Path| format!("'{}'", path.display().to_string().replace('\'', "''"));
        let script = format!(
            "Expand-Archive -Force -LiteralPath {} -DestinationPath {}",
            quoted(archive),
            quoted(folder)
        );
        return process::run(
            Command::new("powershell")
                .args(["-NoProfile", "-Command"])
                .arg(script),
        );
    }
    let unzip =
        paths::on_path(&["unzip"]).context("there is no `unzip` on this system: install it")?;
    process::run(
        Command::new(unzip)
            .arg("-q")
            .arg(archive)
            .arg("-d")
            .arg(folder),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_platform_has_its_release() {
        let linux = release("linux", "x86_64").unwrap();
        assert_eq!(linux.archive, linux.program);
        assert!(
            release("linux", "aarch64")
                .unwrap()
                .program
                .ends_with("linux.arm64")
        );
        assert!(
            release("windows", "x86_64")
                .unwrap()
                .program
                .ends_with("_win64_console.exe")
        );
        assert_eq!(
            release("macos", "aarch64").unwrap(),
            release("macos", "x86_64").unwrap()
        );
        assert!(
            release("freebsd", "x86_64")
                .unwrap_err()
                .to_string()
                .contains("freebsd")
        );
    }
}
