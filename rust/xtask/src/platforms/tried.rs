//! Platforms that the add-on is not built for: what of it compiles there, and where it ends.

use super::Settings;
use super::table::{Column, Row};
use crate::{cross, process};
use anyhow::Result;
use std::process::Command;

/// The engine's web export runs extensions that a certain emscripten links, with a standard library built by a nightly Rust.
pub(super) fn check_web(row: &mut Row, _: &Settings, target: &str) -> Result<()> {
    let lacking = "no emscripten 3.1.74, which Godot's web template asks for";
    check(row, target, lacking)
}

/// An iOS library is an archive of Xcode's, with Apple's SDK.
pub(super) fn check_ios(row: &mut Row, _: &Settings, target: &str) -> Result<()> {
    check(row, target, "no Xcode with its SDK")
}

fn check(row: &mut Row, target: &str, lacking: &str) -> Result<()> {
    row.open(Column::Symbols, "nothing is linked");
    row.open(Column::Run, "nothing is linked");
    row.begin(Column::Built);
    cross::add_target(target)?;
    process::run(&mut compile("footfall", target))?;
    row.done("the crate `footfall` compiles");
    let addon = process::captured(compile("footfall_godot", target).env("RUST_BACKTRACE", "0"))?;
    let end = if addon.status.success() {
        "the add-on compiles".to_owned()
    } else {
        ends_at(&String::from_utf8_lossy(&addon.stderr))
    };
    row.open(Column::Linked, &format!("{lacking}; {end}"));
    Ok(())
}

fn compile(package: &str, target: &str) -> Command {
    let mut cargo = process::cargo();
    cargo.args(["check", "--locked", "--quiet", "--package", package]);
    cargo.args(["--target", target]);
    cargo
}

/// The crate at which a build ended, as cargo names it in backquotes.
fn ends_at(said: &str) -> String {
    let named = |line: &str| {
        let failed = line.contains("could not compile `")
            || line.contains("failed to run custom build command for `");
        let name = line.split('`').nth(1)?.split(' ').next()?;
        failed.then(|| format!("the add-on ends at the crate `{name}`"))
    };
    said.lines()
        .find_map(named)
        .unwrap_or_else(|| "the add-on does not compile".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crate_at_which_a_build_ends_is_named() {
        let said =
            "warning: unused\nerror: could not compile `mio` (lib) due to 27 previous errors\n";
        assert_eq!(ends_at(said), "the add-on ends at the crate `mio`");
        let said = "error: failed to run custom build command for `ring v0.17.14`\n";
        assert_eq!(ends_at(said), "the add-on ends at the crate `ring`");
        assert_eq!(ends_at("killed"), "the add-on does not compile");
    }
}
