//! Zig and `cargo-zigbuild`, from Python's index: a C compiler and linker for many platforms in one package.

use crate::{fetch, process};
use anyhow::{Context as _, Result};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Versions that are known to work together.
const ZIG: &str = "0.17.1";
const ZIGBUILD: &str = "0.24.1";

/// A zig in the cache.
#[derive(Debug)]
pub(crate) struct Zig {
    folder: PathBuf,
}

impl Zig {
    /// Finds it in the cache, or fetches it.
    ///
    /// # Errors
    /// When it is not available.
    pub(crate) fn provision() -> Result<Self> {
        let packages = [
            format!("ziglang=={ZIG}"),
            format!("cargo-zigbuild=={ZIGBUILD}"),
        ];
        let folder = fetch::once("zig", &packages.join(" "), |folder| {
            for package in &packages {
                fetch::wheel(package, folder)?;
            }
            fetch::make_executable(&program(folder))?;
            fetch::make_executable(&wrapper(folder))
        })
        .context("zig is needed to build for other platforms")?;
        Ok(Self { folder })
    }

    /// Zig itself.
    pub(crate) fn command(&self) -> Command {
        Command::new(program(&self.folder))
    }

    /// Its own library: headers, and sources that it compiles for a target.
    pub(crate) fn library(&self) -> PathBuf {
        self.folder.join("ziglang/lib")
    }

    /// Compiles a program of one C source for a target, as zig names it.
    ///
    /// # Errors
    /// When the compiler fails.
    pub(crate) fn compile(&self, target: &str, source: &Path, program: &Path) -> Result<()> {
        process::read(
            self.command()
                .args([
                    "cc", "-target", target, "-O1", "-Wall", "-Wextra", "-Werror",
                ])
                .arg(source)
                .arg("-o")
                .arg(program),
        )
        .map(drop)
    }

    /// `cargo-zigbuild` in the workspace, with this zig.
    pub(super) fn cargo(&self) -> Command {
        let mut cargo = process::cargo_by(&wrapper(&self.folder));
        cargo.env("CARGO_ZIGBUILD_ZIG_PATH", program(&self.folder));
        cargo
    }
}

fn wrapper(folder: &Path) -> PathBuf {
    folder
        .join(format!("cargo_zigbuild-{ZIGBUILD}.data/scripts"))
        .join(format!("cargo-zigbuild{}", std::env::consts::EXE_SUFFIX))
}

fn program(folder: &Path) -> PathBuf {
    folder
        .join("ziglang")
        .join(format!("zig{}", std::env::consts::EXE_SUFFIX))
}
