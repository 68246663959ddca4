//! Wine, which runs Windows programs on Linux: Debian's, unpacked into the cache.

use crate::apt::Apt;
use crate::fetch;
use anyhow::{Context as _, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Wine, and a library that it loads which Debian compiles for Windows.
const PACKAGES: [&str; 2] = ["wine64", "libz-mingw-w64"];
/// Folder of what Wine has in place of Windows's libraries, from the root.
const LIBRARIES: &str = "usr/lib/x86_64-linux-gnu/wine/x86_64-windows";

/// A Wine in the cache.
pub(super) struct Wine {
    folder: PathBuf,
}

impl Wine {
    /// Finds it in the cache, or fetches it.
    ///
    /// # Errors
    /// When Debian's archive does not have it, as newer suites do not for this architecture.
    pub(super) fn provision() -> Result<Self> {
        let folder = fetch::once("wine", &PACKAGES.join(" "), |folder| {
            let root = Apt::fetch(folder, &PACKAGES, "unpacking Wine")?;
            // Debian's Wine looks for both in folders of the system.
            let zlib = root.join("usr/x86_64-w64-mingw32/lib/zlib1.dll");
            copy(&zlib, &root.join(LIBRARIES).join("zlib1.dll"))?;
            let server = root.join("usr/lib/wine/wineserver");
            fs::remove_file(&server)
                .with_context(|| format!("cannot replace {}", server.display()))?;
            copy(&root.join("usr/lib/wine/wineserver64"), &server)?;
            Ok(())
        })?;
        Ok(Self { folder })
    }

    /// A Windows program; the first one makes a Windows folder before it starts.
    pub(super) fn program(&self, program: &Path) -> Command {
        let root = self.folder.join("root");
        let mut command = Command::new(root.join("usr/lib/wine/wine64"));
        command
            .env("WINEPREFIX", self.folder.join("windows"))
            .env("WINEDLLPATH", root.join("usr/lib/x86_64-linux-gnu/wine"))
            .env("WINEDEBUG", "-all")
            // Neither a browser nor a runtime for .NET is asked for.
            .env("WINEDLLOVERRIDES", "mscoree=;mshtml=")
            .env("LD_LIBRARY_PATH", root.join("usr/lib/x86_64-linux-gnu"))
            .arg(program);
        command
    }

    /// Wine's file in place of one of Windows's libraries.
    pub(super) fn library(&self, name: &str) -> PathBuf {
        self.folder
            .join("root")
            .join(LIBRARIES)
            .join(name.to_lowercase())
    }
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::copy(from, to)
        .map(drop)
        .with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))
}
