//! Things fetched once into the cache outside the repository, by the ordinary clients of their registries.

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of the cache that `make` fills once. One of another `version`, or one that a run left half made, is made anew.
///
/// # Errors
/// When there is no cache, or when `make` fails.
pub(crate) fn once(
    name: &str,
    version: &str,
    make: impl FnOnce(&Path) -> Result<()>,
) -> Result<PathBuf> {
    let folder = paths::cache(name)?;
    let parent = folder.parent().context("a cache without a folder")?;
    fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
    // Two runs at once would spoil each other's half-made files; the second one waits and then finds all done.
    let lock = File::create(folder.with_extension("lock"))
        .with_context(|| format!("cannot write into {}", parent.display()))?;
    lock.lock()
        .with_context(|| format!("cannot lock {}", parent.display()))?;
    let marker = folder.join("finished");
    if fs::read_to_string(&marker).is_ok_and(|finished| finished == version) {
        return Ok(folder);
    }
    paths::make_empty(&folder)?;
    make(&folder)?;
    fs::write(&marker, version).with_context(|| format!("cannot write {}", marker.display()))?;
    Ok(folder)
}

/// Unpacks a package of Python's index into a folder; pip itself checks what it downloads.
///
/// # Errors
/// When there is no Python with pip, or the package is not available for this machine.
pub(crate) fn wheel(requirement: &str, folder: &Path) -> Result<()> {
    let python = paths::on_path(&["python3", "python"])
        .context("there is no `python3` on the PATH: install Python with pip")?;
    let download = folder.join("download");
    eprintln!("downloading {requirement} …");
    process::read(
        Command::new(python)
            .args(["-m", "pip", "download", "--quiet", "--no-deps"])
            .args(["--only-binary", ":all:", "--dest"])
            .arg(&download)
            .arg(requirement),
    )
    .with_context(|| format!("cannot fetch {requirement} with pip"))?;
    let wheel = only_file(&download)?;
    let archive = File::open(&wheel).with_context(|| format!("cannot read {}", wheel.display()))?;
    zip::ZipArchive::new(archive)
        .and_then(|mut archive| archive.extract(folder))
        .with_context(|| format!("cannot unpack {}", wheel.display()))?;
    fs::remove_dir_all(&download).with_context(|| format!("cannot remove {}", download.display()))
}

/// The one file of a folder.
fn only_file(folder: &Path) -> Result<PathBuf> {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .with_context(|| format!("cannot read {}", folder.display()))?
        .flatten()
        .map(|entry| entry.path())
        .collect();
    match (entries.pop(), entries.is_empty()) {
        (Some(file), true) => Ok(file),
        _ => bail!("one file was expected in {}", folder.display()),
    }
}

/// Lets a file be started.
///
/// # Errors
/// When its rights cannot be changed.
#[cfg(unix)]
pub(crate) fn make_executable(file: &Path) -> Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    fs::set_permissions(file, fs::Permissions::from_mode(0o755))
        .with_context(|| format!("cannot make {} executable", file.display()))
}

/// Lets a file be started, as every file may be here.
///
/// # Errors
/// Never.
#[cfg(not(unix))]
pub(crate) fn make_executable(_file: &Path) -> Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_made_once_and_anew_for_another_version_or_after_a_failure() {
        let name = format!("test_{}", std::process::id());
        let mut made = 0;
        let mut make = |version: &str, fail: bool| {
            once(&name, version, |folder| {
                made += 1;
                fs::write(folder.join(format!("left_by_{made}")), "")?;
                anyhow::ensure!(!fail, "as the test demands");
                Ok(())
            })
        };
        make("1", true).unwrap_err();
        make("1", false).unwrap();
        make("1", false).unwrap();
        let folder = make("2", false).unwrap();
        assert_eq!(made, 3);
        assert!(folder.join("left_by_3").exists() && !folder.join("left_by_2").exists());
        fs::remove_dir_all(&folder).unwrap();
        fs::remove_file(folder.with_extension("lock")).unwrap();
    }
}
