//! Builds for Android without its NDK.
//!
//! `rust-lld` links against stubs of the system's libraries ([`stubs`]), in which there is what the official engine takes from them, so that a
//! symbol that Android does not offer is an error of the linker. The unwinder, which an NDK links into every library, is compiled from
//! zig's copy of LLVM's ([`unwinder`]). zig also compiles C: Android and musl agree on what the crates' few sources need of types.

mod engine;
mod stubs;
mod unwinder;

use super::{Zig, plain, variable};
use crate::fetch;
use anyhow::{Context as _, Result, bail};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Raised when the folder is filled in another way.
const LAYOUT: &str = "3";

/// `cargo build` for one of Android's architectures.
///
/// # Errors
/// When zig or the engine cannot be had, or what is to be linked cannot be made.
pub(super) fn cargo(target: &str) -> Result<Command> {
    let architecture = architecture(target)?;
    let zig = Zig::provision()?;
    let engine = engine::provision()?;
    let folder = fetch::once(&format!("android-{architecture}"), &version(), |folder| {
        stubs::write(&zig, architecture, &engine, folder)?;
        unwinder::compile(&zig, architecture, folder)?;
        scripts(&zig, architecture, folder)
    })
    .context("cannot make what libraries for Android are linked with")?;
    let mut cargo = plain(target);
    let c_target = target.replace('-', "_");
    cargo
        .env(variable(target, "LINKER"), "rust-lld")
        .env(format!("CC_{c_target}"), folder.join("cc"))
        .env(format!("AR_{c_target}"), folder.join("ar"));
    let flags = serde_json::json!([
        "-Clinker-flavor=ld.lld",
        format!("-Lnative={}", folder.display()),
        "-Clink-arg=--no-undefined",
        // Newer Androids load libraries by pages of 16 kB.
        "-Clink-arg=-zmax-page-size=16384",
    ]);
    cargo.arg("--config");
    cargo.arg(format!("target.{target}.rustflags={flags}"));
    Ok(cargo)
}

/// Names that Android offers to a library.
///
/// # Errors
/// When the engine that they are taken from cannot be had.
pub(crate) fn offers(target: &str) -> Result<BTreeSet<String>> {
    let names = stubs::names(architecture(target)?, &engine::provision()?)?;
    Ok(names.into_values().flatten().collect())
}

/// An architecture as zig names it; also in the engine's archive, for which see [`engine::libraries`].
fn architecture(target: &str) -> Result<&'static str> {
    match target {
        "aarch64-linux-android" => Ok("aarch64"),
        "x86_64-linux-android" => Ok("x86_64"),
        _ => bail!("{target} is not built here: aarch64-linux-android or x86_64-linux-android"),
    }
}

fn version() -> String {
    [LAYOUT, engine::ARTEFACT, &stubs::MORE.join(" ")].join(" ")
}

/// zig's name of what C sources are compiled for.
fn zig_target(architecture: &str) -> String {
    format!("{architecture}-linux-musl")
}

/// Compiler and archiver for build scripts, which pass a target of their own that zig does not know.
fn scripts(zig: &Zig, architecture: &str, folder: &Path) -> Result<()> {
    let program = zig.command().get_program().to_owned();
    let (zig, target) = (program.display(), zig_target(architecture));
    let drop_target = "for word; do shift; case \"$word\" in --target=*) ;; *) set -- \"$@\" \"$word\" ;; esac; done";
    for (name, text) in [
        (
            "cc",
            format!("#!/bin/sh\n{drop_target}\nexec \"{zig}\" cc -target {target} \"$@\"\n"),
        ),
        ("ar", format!("#!/bin/sh\nexec \"{zig}\" ar \"$@\"\n")),
    ] {
        let file = folder.join(name);
        fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
        fetch::make_executable(&file)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_androids_are_refused_by_name() {
        let error = architecture("armv7-linux-androideabi").unwrap_err();
        assert!(error.to_string().contains("armv7-linux-androideabi"));
        assert_eq!(architecture("x86_64-linux-android").unwrap(), "x86_64");
    }
}
