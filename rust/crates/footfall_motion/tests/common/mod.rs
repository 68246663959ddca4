//! What the tests on recordings share.
#![allow(
    dead_code,
    clippy::allow_attributes,
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "each test binary uses a part of this"
)]

pub(crate) mod natural;
pub(crate) mod walker;

use std::path::{Path, PathBuf};

/// The folder of recordings, if it is there: `FOOTFALL_DATA`, else `../shared/data` beside the repository.
pub(crate) fn data_folder() -> Option<PathBuf> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let folder = std::env::var_os("FOOTFALL_DATA")
        .map_or_else(|| repository.join("../shared/data"), PathBuf::from);
    if folder.join("index.csv").is_file() {
        return Some(folder);
    }
    println!("skipped: no recordings; set FOOTFALL_DATA to the folder with index.csv");
    None
}

/// Every `.bvh` below a folder, sorted.
pub(crate) fn bvh_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "bvh") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
