//! `img2webp` of libwebp, which makes moving pictures.
//!
//! Looked for on the PATH, then in the cache; on Debian it is fetched into the cache from the machine's own archive (1 MB), as Mono is.

use crate::{apt, paths, process, shared_libraries};
use anyhow::{Context as _, Result};
use std::path::Path;
use std::process::Command;

const PACKAGES: [&str; 1] = ["webp"];
const PROGRAM: &str = "img2webp";
/// A library that comes along where the system lacks it, in the folder of all that do.
const LIBRARY: &str = "libwebpdemux.so.2";

/// Finds `img2webp`, or fetches it.
///
/// # Errors
/// Reason why it is missing and cannot be obtained.
pub(crate) fn provision() -> Result<Command> {
    if paths::on_path(&[PROGRAM]).is_some() {
        return Ok(Command::new(PROGRAM));
    }
    let runs = |root: &Path| process::read(unpacked(root).arg("-version")).is_ok();
    let root = apt::in_cache("webp", &PACKAGES, runs)
        .context("there is no `img2webp`: install libwebp's programs")?;
    Ok(unpacked(&root))
}

/// The program of a folder that packages were unpacked into. Libraries that the system lacks came along.
fn unpacked(root: &Path) -> Command {
    let mut command = Command::new(root.join("usr/bin").join(PROGRAM));
    if let Some(folder) = shared_libraries::folder_of(LIBRARY, root) {
        shared_libraries::looked_for_in(&mut command, &folder);
    }
    command
}
