//! `img2webp` of libwebp, which makes moving pictures.
//!
//! Looked for on the PATH, then in the cache; on Debian it is fetched into the cache from the machine's own archive (1 MB), as Mono is.

use crate::{apt, paths, shared_libraries};
use anyhow::{Context as _, Result};
use std::path::Path;
use std::process::Command;

const PACKAGES: [&str; 1] = ["webp"];
const PROGRAM: &str = "img2webp";
/// One of its libraries, in the folder of all of them.
const LIBRARY: &str = "libwebpdemux.so.2";

/// Finds `img2webp`, or fetches it.
///
/// # Errors
/// Reason why it is missing and cannot be obtained.
pub(crate) fn provision() -> Result<Command> {
    if paths::on_path(&[PROGRAM]).is_some() {
        return Ok(Command::new(PROGRAM));
    }
    let root = apt::in_cache("webp", &PACKAGES, |root| unpacked(root).is_some())
        .context("there is no `img2webp`: install libwebp's programs")?;
    unpacked(&root).context("the packages hold no `img2webp`")
}

/// The program of a folder that packages were unpacked into. Libraries that the system lacks came along.
fn unpacked(root: &Path) -> Option<Command> {
    let program = root.join("usr/bin").join(PROGRAM);
    let mut command = Command::new(&program);
    if let Some(folder) = shared_libraries::folder_of(LIBRARY, root) {
        shared_libraries::looked_for_in(&mut command, &folder);
    }
    program.is_file().then_some(command)
}
