//! A C# compiler and a runtime for what it makes: Mono's, found or fetched.
//!
//! Looked for on the PATH, then in the cache; on Debian it is fetched into the cache from the machine's own archive (7 MB), as Godot is.

use crate::{apt, paths, process};
use anyhow::Result;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGES: [&str; 2] = ["mono-mcs", "mono-runtime"];
/// From the folder that packages are unpacked into.
const RUNTIME: &str = "usr/bin/mono";
const COMPILER: &str = "usr/lib/mono/4.5/mcs.exe";

/// Mono on this machine.
#[derive(Debug)]
pub(crate) enum Mono {
    Installed,
    /// Unpacked into this folder.
    Unpacked(PathBuf),
}

impl Mono {
    /// Finds Mono, or fetches it.
    ///
    /// # Errors
    /// Reason why it is missing and cannot be obtained.
    pub(crate) fn provision() -> Result<Self> {
        if paths::on_path(&["mcs"]).is_some() && paths::on_path(&["mono"]).is_some() {
            return Ok(Self::Installed);
        }
        let runs = |root: &Path| Self::Unpacked(root.to_path_buf()).runs();
        apt::in_cache("mono", &PACKAGES, runs).map(Self::Unpacked)
    }

    /// The C# compiler.
    pub(crate) fn compiler(&self) -> Command {
        match self {
            Self::Installed => Command::new("mcs"),
            Self::Unpacked(root) => self.program(&root.join(COMPILER)),
        }
    }

    /// A program that the compiler made.
    pub(crate) fn program(&self, program: &Path) -> Command {
        let mut command = match self {
            Self::Installed => Command::new("mono"),
            Self::Unpacked(root) => {
                let mut command = Command::new(root.join(RUNTIME));
                // Maps names to native libraries.
                command.env("MONO_CFG_DIR", root.join("etc"));
                command
            }
        };
        command.arg(program);
        command
    }

    fn runs(&self) -> bool {
        process::read(self.compiler().arg("--version")).is_ok()
    }
}
