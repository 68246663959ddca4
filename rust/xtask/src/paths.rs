//! Paths in the repository and in the user's cache.

use anyhow::{Context as _, Result};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The repository's root, found from this crate's manifest.
pub(crate) fn repository_root() -> PathBuf {
    // `cargo run` names the manifest of the checkout at hand; the built-in path is for a binary that is started by itself.
    let manifest = env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    let root = manifest.join("../..");
    root.canonicalize().unwrap_or(root)
}

/// The cargo workspace, `rust/`.
pub(crate) fn workspace() -> PathBuf {
    repository_root().join("rust")
}

/// Cargo's target folder, which `CARGO_TARGET_DIR` may move.
pub(crate) fn target_folder() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(
        || workspace().join("target"),
        |folder| workspace().join(folder),
    )
}

/// The folder of the add-on that users copy.
pub(crate) fn addon() -> PathBuf {
    repository_root().join("addons/footfall")
}

/// The folder outside the repository that keeps a fetched Godot: `${XDG_CACHE_HOME:-~/.cache}/footfall/godot`.
///
/// # Errors
/// As [`cache`].
pub(crate) fn godot_cache() -> Result<PathBuf> {
    cache("godot").context("or let GODOT name a Godot of at least 4.6")
}

/// A folder outside the repository that keeps something fetched.
///
/// # Errors
/// When neither a cache nor a home folder is known.
pub(crate) fn cache(name: &str) -> Result<PathBuf> {
    let set = |name: &str| {
        env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    let cache = set("XDG_CACHE_HOME").filter(|folder| folder.is_absolute());
    let cache = if cfg!(windows) {
        cache.or_else(|| set("LOCALAPPDATA"))
    } else {
        cache
    };
    cache
        .or_else(|| set("HOME").map(|home| home.join(".cache")))
        .map(|folder| folder.join("footfall").join(name))
        .context("no cache folder: set HOME or XDG_CACHE_HOME")
}

/// Makes a folder with nothing in it, whatever was there.
///
/// # Errors
/// When what was there cannot be removed, or the folder cannot be created.
pub(crate) fn make_empty(folder: &Path) -> Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot clear {}", folder.display()))?;
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))
}

/// The first executable of one of these names on the PATH.
pub(crate) fn on_path(names: &[&str]) -> Option<PathBuf> {
    let folders: Vec<PathBuf> = env::split_paths(&env::var_os("PATH")?).collect();
    names.iter().find_map(|name| {
        folders
            .iter()
            .map(|folder| folder.join(format!("{name}{}", env::consts::EXE_SUFFIX)))
            .find(|file| is_executable(file))
    })
}

#[cfg(unix)]
fn is_executable(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    file.metadata()
        .is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(file: &Path) -> bool {
    file.is_file()
}
