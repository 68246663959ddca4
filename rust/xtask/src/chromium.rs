//! Chromium, in which tests open the pages for phones and for studies.
//!
//! Looked for on the PATH, then in the cache; on Debian it is fetched into the cache from the machine's own archive (125 MB), as Mono is.

use crate::{apt, fetch, paths, process};
use anyhow::{Context as _, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGES: [&str; 1] = ["chromium"];
/// Names under which tests find a browser (`footfall_tests::browser`).
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// Starts the browser that was unpacked beside its folder. Libraries that the system lacks came along, one of them in a folder of its own.
const STARTER: &str = r#"#!/bin/sh
# Written by `cargo verify`: starts Debian's Chromium with the libraries that came with it.
root="$(dirname -- "$(readlink -f -- "$0")")/../root"
for folder in "$root"/usr/lib/*-linux-gnu "$root"/usr/lib/*-linux-gnu/pulseaudio; do
    LD_LIBRARY_PATH="$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
done
export LD_LIBRARY_PATH
exec "$root/usr/lib/chromium/chromium" "$@"
"#;

/// Finds Chromium, or fetches it.
///
/// # Errors
/// Reason why it is missing and cannot be obtained.
pub(crate) fn provision() -> Result<()> {
    if paths::on_path(&NAMES).is_some() {
        return Ok(());
    }
    let runs = |root: &Path| -> Result<bool> {
        let program = write_starter(root)?;
        let profile = root.with_file_name("profile");
        let shown = process::read(
            Command::new(&program)
                .args(["--headless", "--no-sandbox", "--disable-gpu"])
                .args(["--disable-dev-shm-usage", "--dump-dom"])
                .arg(format!("--user-data-dir={}", profile.display()))
                .arg("data:text/html,<p>a page"),
        );
        let runs = shown.is_ok_and(|page| page.contains("<p>a page"));
        if !runs {
            // Tests take what is there for a browser that runs.
            fs::remove_file(&program)?;
        }
        Ok(runs)
    };
    apt::in_cache("chromium", &PACKAGES, |root| runs(root).unwrap_or(false)).map(drop)
}

/// The folder of the program that was fetched, where one was.
pub(crate) fn fetched() -> Option<PathBuf> {
    let folder = paths::cache("chromium").ok()?.join("bin");
    folder.join(NAMES[0]).is_file().then_some(folder)
}

/// Writes the script that starts the browser of a folder, beside that folder.
fn write_starter(root: &Path) -> Result<PathBuf> {
    let program = root.with_file_name("bin").join(NAMES[0]);
    let folder = program.parent().context("a program without a folder")?;
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    fs::write(&program, STARTER).with_context(|| format!("cannot write {}", program.display()))?;
    fetch::make_executable(&program)?;
    Ok(program)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn the_browser_starts_with_the_libraries_that_came_along() {
        let folder = std::env::temp_dir().join(format!("footfall_chromium_{}", std::process::id()));
        let root = folder.join("root");
        let libraries = root.join("usr/lib/some-linux-gnu");
        let browser = root.join("usr/lib/chromium/chromium");
        fs::create_dir_all(libraries.join("pulseaudio")).unwrap();
        fs::create_dir_all(browser.parent().unwrap()).unwrap();
        fs::write(&browser, "#!/bin/sh\necho \"$1 $LD_LIBRARY_PATH\"\n").unwrap();
        fetch::make_executable(&browser).unwrap();
        let starter = write_starter(&root).unwrap();
        let said = process::read(
            Command::new(starter)
                .arg("--version")
                .env("LD_LIBRARY_PATH", "/own"),
        )
        .unwrap();
        let expected = [
            "usr/lib/some-linux-gnu/pulseaudio:",
            "usr/lib/some-linux-gnu:/own",
        ];
        assert!(said.starts_with("--version /"), "{said}");
        assert!(expected.iter().all(|part| said.contains(part)), "{said}");
        fs::remove_dir_all(folder).unwrap();
    }
}
