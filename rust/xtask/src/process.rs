//! Running other programs, with errors that say what was run and what it said.

use anyhow::{Context as _, Result, bail};
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// A command as a user would type it.
pub(crate) fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words
        .map(|word| word.to_string_lossy())
        .collect::<Vec<_>>()
        .join(" ")
}

/// Cargo in the workspace: the one that runs this program, where it does.
pub(crate) fn cargo() -> Command {
    cargo_by(Path::new(
        &std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()),
    ))
}

/// A command of cargo for all crates but the nodes', which need Godot; with the same features, so that nothing is built twice.
pub(crate) fn cargo_without_nodes(command: &str) -> Command {
    let mut cargo = cargo();
    cargo.args([command, "--locked", "--workspace", "--exclude"]);
    cargo.args(["footfall_godot", "--features", "footfall/live"]);
    cargo
}

/// Another program in cargo's place, which calls cargo itself.
pub(crate) fn cargo_by(program: &Path) -> Command {
    let mut cargo = Command::new(program);
    cargo.current_dir(crate::paths::workspace());
    // What the cargo that runs this program says of it: build scripts that look at it would run anew, and with them half of all crates be
    // built anew, whenever cargo is called alternately through this program and directly.
    for (name, _) in std::env::vars_os() {
        let name = name.to_string_lossy();
        if ["CARGO_PKG_", "CARGO_MANIFEST_"]
            .iter()
            .any(|own| name.starts_with(own))
        {
            cargo.env_remove(&*name);
        }
    }
    if std::env::var_os("CI").is_some() {
        // What is built once is never built again: what the next build would save, this one would pay for.
        cargo.env("CARGO_INCREMENTAL", "0");
    }
    cargo
}

/// Runs to the end with the terminal's own output, sent to stderr so that stdout stays clean.
///
/// # Errors
/// When the program cannot be started or fails.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let status = command
        .stdout(std::io::stderr())
        .status()
        .with_context(|| {
            format!(
                "cannot start `{}`: is it installed?",
                command.get_program().display()
            )
        })?;
    if !status.success() {
        bail!("`{}` failed ({status})", shown(command));
    }
    Ok(())
}

/// Runs to the end and returns what it wrote to stdout.
///
/// # Errors
/// When the program cannot be started or fails; then with the end of what it wrote.
pub(crate) fn read(command: &mut Command) -> Result<String> {
    let output = captured(command)?;
    if !output.status.success() {
        let said = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        bail!(
            "`{}` failed ({}):\n{}",
            shown(command),
            output.status,
            tail(&said, 15)
        );
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Runs to the end and returns all, whether it failed or not.
///
/// # Errors
/// When the program cannot be started.
pub(crate) fn captured(command: &mut Command) -> Result<Output> {
    command.stdin(Stdio::null()).output().with_context(|| {
        format!(
            "cannot start `{}`: is it installed?",
            command.get_program().display()
        )
    })
}

/// The last lines of a log.
pub(crate) fn tail(log: &str, lines: usize) -> String {
    let all: Vec<&str> = log.trim_end().lines().collect();
    all[all.len().saturating_sub(lines)..].join("\n")
}

/// The workspace as cargo describes it, without its dependencies.
///
/// # Errors
/// When cargo fails or prints no JSON.
pub(crate) fn metadata() -> Result<serde_json::Value> {
    let metadata =
        read(cargo().args(["metadata", "--format-version", "1", "--no-deps", "--locked"]))?;
    serde_json::from_str(&metadata).context("cargo metadata is no JSON")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tail_is_the_end() {
        assert_eq!(tail("a\nb\nc\n", 2), "b\nc");
        assert_eq!(tail("a", 5), "a");
    }

    #[test]
    fn a_missing_program_is_named() {
        let error = read(&mut Command::new("no-such-program-here")).unwrap_err();
        assert!(
            error.to_string().contains("no-such-program-here"),
            "{error}"
        );
    }
}
