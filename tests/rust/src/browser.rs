//! A browser for tests of pages.

use std::path::PathBuf;

/// Path of Chromium on this machine; [notes](crate::skips::note) that the test is skipped when it is not there.
pub fn chromium(test: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .flat_map(|folder| {
            ["chromium", "chromium-browser", "google-chrome"].map(|name| folder.join(name))
        })
        .find(|program| program.is_file());
    if found.is_none() {
        let reason = "no Chromium on the path; install Debian's package chromium";
        crate::skips::note(test, reason);
    }
    found
}
