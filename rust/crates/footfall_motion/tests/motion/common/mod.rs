//! Walkers and recordings that the tests share.
#![expect(
    clippy::unwrap_used,
    reason = "a test without its files has nothing to say"
)]

pub(crate) mod natural;
pub(crate) mod rigs;
pub(crate) mod walker;

use footfall_tests::data::recordings;
use footfall_tests::skips::current_test;
use std::path::{Path, PathBuf};

/// The folder of recordings, if it is there.
pub(crate) fn data_folder() -> Option<PathBuf> {
    recordings(&current_test())
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
