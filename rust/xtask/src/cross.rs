//! Builds of the library for other platforms than this machine's, without their SDKs.
//!
//! `cargo-zigbuild` links with zig, which brings the C libraries of Linux, Windows and macOS. Android's it does not bring: there `rust-lld` links ([`android`]).

mod android;
mod macos;
mod zig;

pub(crate) use android::offers as android_offers;
pub(crate) use macos::names as macos_names;
pub(crate) use zig::Zig;

use crate::library::MACOS_UNIVERSAL;
use crate::{paths, process};
use anyhow::{Context as _, Result};
use std::process::Command;

/// `cargo build` for a target, to which the package and the profile are still to be added, and the folder in the target folder that it builds into.
///
/// # Errors
/// When what the target needs cannot be had.
pub(crate) fn cargo(target: &str) -> Result<(Command, String)> {
    add_target(target)?;
    if target.ends_with("-linux-android") {
        return Ok((android::cargo(target)?, target.to_owned()));
    }
    let zig = Zig::provision()?;
    let mut cargo = zig.cargo();
    cargo.args(["zigbuild", "--target", zig_target(target)]);
    if target.ends_with("-apple-darwin") {
        macos::link_frameworks(&mut cargo)?;
    }
    Ok((cargo, folder(target).to_owned()))
}

/// Has rustup fetch the standard library for a target; other installations of Rust bring what they bring.
///
/// # Errors
/// When rustup cannot have it.
pub(crate) fn add_target(target: &str) -> Result<()> {
    if paths::on_path(&["rustup"]).is_none() {
        return Ok(());
    }
    let targets = match target {
        MACOS_UNIVERSAL => &macos::TARGETS[..],
        _ => &[target.split('.').next().unwrap_or(target)],
    };
    process::read(
        Command::new("rustup")
            .args(["--quiet", "target", "add"])
            .args(targets),
    )
    .with_context(|| format!("Rust's standard library for {target} is not available"))
    .map(drop)
}

/// `cargo-zigbuild`'s name of a target.
fn zig_target(target: &str) -> &str {
    match target {
        MACOS_UNIVERSAL => "universal2-apple-darwin",
        _ => target,
    }
}

/// A target without the glibc at its end, as cargo names the folder.
fn folder(target: &str) -> &str {
    zig_target(target).split('.').next().unwrap_or(target)
}

/// Variable in which cargo looks for one of a target's settings.
fn variable(target: &str, setting: &str) -> String {
    let target = target.replace('-', "_").to_uppercase();
    format!("CARGO_TARGET_{target}_{setting}")
}

/// Cargo in the workspace, with what a build for `target` needs to link.
fn plain(target: &str) -> Command {
    let mut cargo = process::cargo();
    cargo.args(["build", "--target", target]);
    cargo
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_as_cargo_names_them() {
        assert_eq!(
            folder("x86_64-unknown-linux-gnu.2.31"),
            "x86_64-unknown-linux-gnu"
        );
        assert_eq!(folder("universal-apple-darwin"), "universal2-apple-darwin");
        assert_eq!(
            variable("aarch64-linux-android", "LINKER"),
            "CARGO_TARGET_AARCH64_LINUX_ANDROID_LINKER"
        );
    }
}
