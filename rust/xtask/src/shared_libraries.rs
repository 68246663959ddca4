//! Shared libraries that were unpacked somewhere else than where a system looks for them.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of a system's libraries that has this one.
pub(crate) fn folder_of(library: &str, root: &Path) -> Option<PathBuf> {
    let libraries = root.join("usr/lib");
    let folders = entries(&libraries).into_iter();
    [libraries.clone(), root.join("usr/lib64")]
        .into_iter()
        .chain(folders)
        .find(|folder| folder.join(library).exists())
}

/// Has a program look for libraries in this folder first.
pub(crate) fn looked_for_in<'a>(command: &'a mut Command, folder: &Path) -> &'a mut Command {
    let before = env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    // An empty name would be the folder that the program is started in.
    let others = env::split_paths(&before).filter(|folder| folder != Path::new(""));
    let folders = std::iter::once(folder.to_path_buf()).chain(others);
    let joined = env::join_paths(folders).unwrap_or_else(|_| folder.into());
    command.env("LD_LIBRARY_PATH", joined)
}

/// Files of a folder in order; none of one that is not there.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let found = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = found.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
