//! The demo as a game for players, in an archive.

use crate::{export, godot};
use anyhow::{Context as _, Result};
use std::env::consts::{ARCH, OS};
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

/// Exports the demo for this machine, starts it once, and packs it into a folder; says so where it cannot be exported.
///
/// # Errors
/// When the game does not run, or is not to be packed.
pub(super) fn archive(version: &str, folder: &Path) -> Result<()> {
    if OS != "linux" {
        eprintln!("no demo in this release: it is exported on Linux only");
        return Ok(());
    }
    let engine = godot::provision()?;
    if engine.release_template.is_none() {
        eprintln!("no demo in this release: this Godot came without an export template");
        return Ok(());
    }
    let game = export::export(&engine)?;
    export::start(&engine, &game)?;
    // What Debian's template makes takes its libraries from the system: only one as new as Debian's has them.
    let needs = if godot::is_debians(&engine)? {
        "-debian"
    } else {
        ""
    };
    let archive = folder.join(format!("footfall-demo-{version}-linux-{ARCH}{needs}.zip"));
    let home = game.parent().context("a game without a folder")?;
    pack(home, &archive)
}

/// Writes the files of a folder into an archive, the ones that can be started so that they can be.
fn pack(folder: &Path, archive: &Path) -> Result<()> {
    let output =
        File::create(archive).with_context(|| format!("cannot write {}", archive.display()))?;
    let mut zip = zip::ZipWriter::new(BufWriter::new(output));
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .with_context(|| format!("cannot read {}", folder.display()))?
        .flatten()
        .map(|entry| entry.path())
        .filter(|file| file.is_file())
        .collect();
    files.sort();
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let options = SimpleFileOptions::default()
            .last_modified_time(zip::DateTime::default())
            .unix_permissions(0o755);
        zip.start_file(format!("footfall_demo/{name}"), options)?;
        zip.write_all(
            &fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?,
        )?;
    }
    zip.finish()?.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_game_is_packed_with_its_data_and_can_be_started() {
        let folder = std::env::temp_dir().join(format!("footfall_demo_{}", std::process::id()));
        let game = folder.join("export");
        fs::create_dir_all(game.join("started")).unwrap();
        for name in ["game.x86_64", "game.pck"] {
            fs::write(game.join(name), name).unwrap();
        }
        let archive = folder.join("demo.zip");
        pack(&game, &archive).unwrap();
        let mut zip = zip::ZipArchive::new(File::open(&archive).unwrap()).unwrap();
        assert_eq!(zip.len(), 2);
        let mode = zip
            .by_name("footfall_demo/game.x86_64")
            .unwrap()
            .unix_mode();
        assert_eq!(mode.map(|mode| mode & 0o777), Some(0o755));
        fs::remove_dir_all(folder).unwrap();
    }
}
