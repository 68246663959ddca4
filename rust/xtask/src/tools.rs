//! Programs of other projects that check or describe this one, installed once into the cache by the clients of their registries.

use crate::{fetch, paths, process};
use anyhow::{Context as _, Result};
use std::path::PathBuf;
use std::process::Command;

/// Installs a program of a crate; returns its path.
///
/// # Errors
/// When it is not available or does not compile.
pub(crate) fn of_crate(name: &str, version: &str) -> Result<PathBuf> {
    let folder = fetch::once(name, version, |folder| {
        eprintln!("installing {name} {version} …");
        let mut cargo = process::cargo();
        cargo
            .args(["install", "--quiet", "--locked", "--root"])
            .arg(folder)
            .args(["--version", version, name]);
        process::run(&mut cargo)
    })
    .with_context(|| format!("cannot install {name}"))?;
    Ok(program(&folder.join("bin"), name))
}

/// Installs a program of a Go module; returns its path.
///
/// # Errors
/// When there is no Go, or the module is not available.
pub(crate) fn of_go(name: &str, package: &str, version: &str) -> Result<PathBuf> {
    let go = paths::on_path(&["go"])
        .with_context(|| format!("there is no `go` on the PATH, which installs {name}"))?;
    let folder = fetch::once(name, version, |folder| {
        eprintln!("installing {name} {version} …");
        process::run(
            Command::new(go)
                .arg("install")
                .arg(format!("{package}@{version}"))
                .env("GOBIN", folder),
        )
    })
    .with_context(|| format!("cannot install {name}"))?;
    Ok(program(&folder, name))
}

fn program(folder: &std::path::Path, name: &str) -> PathBuf {
    folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}
