//! The official engine for Android, from Maven: what it asks of the system, Android offers.

use crate::{fetch, paths, process};
use anyhow::{Context as _, Result, bail};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The engine in Maven's coordinates.
pub(crate) const ARTEFACT: &str = "org.godotengine:godot:4.6.3.stable:aar";
/// The plug-in that fetches it.
const COPY: &str = "org.apache.maven.plugins:maven-dependency-plugin:3.8.1:copy";

/// Finds the engine's libraries in the cache, or fetches them.
///
/// # Errors
/// When there is no Maven, or the engine is not available.
pub(crate) fn provision() -> Result<PathBuf> {
    fetch::once("godot-android", ARTEFACT, |folder| {
        let maven = paths::on_path(&["mvn"]).context(
            "there is no `mvn` on the PATH: install Maven, which fetches Godot's library for Android",
        )?;
        eprintln!("downloading {ARTEFACT} …");
        let download = folder.join("download");
        process::read(
            Command::new(maven)
                .args(["--quiet", "--batch-mode", COPY])
                .arg(format!("-Dartifact={ARTEFACT}"))
                .arg(format!("-DoutputDirectory={}", download.display()))
                .arg(format!(
                    "-Dmaven.repo.local={}",
                    folder.join("repository").display()
                )),
        )
        .with_context(|| format!("cannot fetch {ARTEFACT}"))?;
        unpack(&download, folder)?;
        for part in ["download", "repository"] {
            fs::remove_dir_all(folder.join(part))
                .with_context(|| format!("cannot clear {}", folder.display()))?;
        }
        Ok(())
    })
}

/// The engine's libraries for an architecture.
pub(crate) fn libraries(folder: &Path, architecture: &str) -> [PathBuf; 2] {
    let abi = match architecture {
        "aarch64" => "arm64-v8a",
        other => other,
    };
    ["libgodot_android.so", "libc++_shared.so"].map(|name| folder.join("jni").join(abi).join(name))
}

fn unpack(download: &Path, folder: &Path) -> Result<()> {
    let Some(archive) = fs::read_dir(download)
        .with_context(|| format!("cannot read {}", download.display()))?
        .flatten()
        .next()
    else {
        bail!("Maven fetched nothing");
    };
    let file = File::open(archive.path()).context("cannot read the engine's archive")?;
    let mut archive = zip::ZipArchive::new(file).context("the engine's archive is damaged")?;
    archive
        .extract(folder)
        .context("cannot unpack the engine's archive")
}
