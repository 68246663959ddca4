//! A small program that loads the library as Godot does and calls its entry point (`host.c`), for systems on which no Godot runs here.

use crate::cross::Zig;
use crate::{paths, process};
use anyhow::{Context as _, Result, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Version of Godot with which the library works, and one that it has to refuse.
const GOOD: [&str; 3] = ["4", "6", "3"];
const OLD: [&str; 3] = ["4", "5", "0"];

/// Compiles the host for a target as zig names it.
///
/// # Errors
/// When zig is not available or fails.
pub(super) fn compile(target: &str, suffix: &str) -> Result<PathBuf> {
    let folder = paths::target_folder().join("platforms");
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let program = folder.join(format!("host-{target}{suffix}"));
    let source = paths::workspace().join("xtask/src/platforms/host.c");
    Zig::provision()?.compile(target, &source, &program)?;
    Ok(program)
}

/// Has the host load the library: it must answer a Godot of its version, and refuse an older one. `start` makes the command that starts the host.
///
/// # Errors
/// When it is not loaded, or answers otherwise.
pub(super) fn ask(start: impl Fn() -> Command, library: &Path) -> Result<String> {
    let run = |version: [&str; 3]| {
        let mut command = start();
        command.arg(library).arg("footfall_init").args(version);
        // The backtrace of a panic would not help here.
        command.env("RUST_BACKTRACE", "0");
        process::captured(&mut command)
    };
    let good = run(GOOD)?;
    let said = String::from_utf8_lossy(&good.stdout);
    ensure!(
        good.status.success() && said.contains("answer 1"),
        "the library does not answer Godot {} ({}): {said}{}",
        GOOD.join("."),
        good.status,
        String::from_utf8_lossy(&good.stderr)
    );
    let old = run(OLD)?;
    let refused =
        !old.status.success() && !String::from_utf8_lossy(&old.stdout).contains("answer 1");
    ensure!(
        refused,
        "the library does not refuse Godot {}",
        OLD.join(".")
    );
    Ok(format!(
        "entry point answers Godot {}, refuses {}",
        GOOD.join("."),
        OLD[..2].join(".")
    ))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &'static str) -> impl Fn() -> Command {
        move || {
            let mut command = Command::new("sh");
            command.args(["-c", script, "host"]);
            command
        }
    }

    #[test]
    fn a_library_has_to_answer_one_version_and_refuse_the_other() {
        let library = Path::new("library");
        let right = "case $4 in 6) echo answer 1;; *) echo answer 0; exit 1;; esac";
        let said = ask(shell(right), library).unwrap();
        assert_eq!(said, "entry point answers Godot 4.6.3, refuses 4.5");
        for (script, problem) in [
            ("echo answer 1", "does not refuse Godot 4.5.0"),
            ("echo cannot load >&2; exit 2", "cannot load"),
            ("echo answer 0; exit 1", "does not answer Godot 4.6.3"),
        ] {
            let error = ask(shell(script), library).unwrap_err().to_string();
            assert!(error.contains(problem), "{error}");
        }
    }
}
