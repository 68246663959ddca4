//! Location of test data.

use std::path::{Path, PathBuf};

/// The root of the repository.
pub fn repository() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_path_buf()
}

/// A file that the project made and keeps under `tests/data`.
pub fn own_file(name: &str) -> PathBuf {
    repository().join("tests/data").join(name)
}

/// The folder with the recordings: `FOOTFALL_DATA`, else `../shared/data` beside the repository.
///
/// `None` when there is none, which is [noted](crate::skips::note), so that a skipped test does not pass for a run one.
pub fn recordings(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("FOOTFALL_DATA")
        .map_or_else(|| repository().join("../shared/data"), PathBuf::from);
    if folder.join("index.csv").is_file() {
        return Some(folder);
    }
    let reason = "no recordings; set FOOTFALL_DATA to the folder with index.csv";
    crate::skips::note(test, reason);
    None
}

/// The walks under `tests/data`.
pub fn own_recordings() -> [&'static str; 4] {
    [
        "walker_1_slow.bvh",
        "walker_1_fast.bvh",
        "walker_2_slow.bvh",
        "walker_2_fast.bvh",
    ]
}

/// The joints of the canonical body.
pub const JOINT_NAMES: [&str; 22] = {
    let mut names = [""; 22];
    let mut index = 0;
    while index < 22 {
        names[index] = footfall_core::Joint::ALL[index].name();
        index += 1;
    }
    names
};
