//! `cargo xtask audit`: the workflows by actionlint, and the dependencies' licences, sources and advisories by cargo-deny.

use crate::{paths, process, tools};
use anyhow::{Context as _, Result, bail};
use std::path::Path;
use std::process::Command;

const ACTIONLINT: (&str, &str) = ("github.com/rhysd/actionlint/cmd/actionlint", "v1.7.12");
const CARGO_DENY: &str = "0.20.2";

/// Checks both.
///
/// # Errors
/// A finding, or a tool that cannot be had.
pub(crate) fn command() -> Result<()> {
    workflows()?;
    dependencies()
}

/// Has actionlint read every workflow.
fn workflows() -> Result<()> {
    let actionlint = tools::of_go("actionlint", ACTIONLINT.0, ACTIONLINT.1)?;
    lint(&actionlint, &paths::repository_root())?;
    eprintln!("actionlint: all workflows pass");
    Ok(())
}

fn lint(actionlint: &Path, folder: &Path) -> Result<()> {
    // Scripts within workflows are read by shellcheck where it is installed: then other machines would judge otherwise.
    process::read(
        Command::new(actionlint)
            .args(["-no-color", "-shellcheck=", "-pyflakes="])
            .current_dir(folder),
    )
    .context("a workflow fails actionlint")
    .map(drop)
}

fn dependencies() -> Result<()> {
    let program = tools::of_crate("cargo-deny", CARGO_DENY)?;
    let check = |what: &[&str]| {
        let mut deny = Command::new(&program);
        deny.current_dir(paths::workspace())
            .args(["--locked", "check", "--hide-inclusion-graph"])
            .args(what);
        process::captured(&mut deny)
    };
    let settled = check(&["bans", "licenses", "sources"])?;
    if !settled.status.success() {
        bail!(
            "the dependencies violate deny.toml:\n{}",
            process::tail(&String::from_utf8_lossy(&settled.stderr), 30)
        );
    }
    eprintln!("cargo-deny: licences, sources and bans pass");
    let advisories = check(&["advisories"])?;
    let said = String::from_utf8_lossy(&advisories.stderr);
    if advisories.status.success() {
        eprintln!("cargo-deny: no advisory concerns the dependencies");
    } else if unreachable(&said) {
        eprintln!(
            "cargo-deny: the database of advisories is not available here; the workflow checks it"
        );
    } else {
        bail!(
            "advisories concern the dependencies:\n{}",
            process::tail(&said, 30)
        );
    }
    Ok(())
}

/// Returns whether the check failed for want of its database.
fn unreachable(said: &str) -> bool {
    said.contains("failed to fetch advisory database")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_database_that_is_out_of_reach_is_told_from_an_advisory() {
        assert!(unreachable(
            "[ERROR] failed to fetch advisory database https://x"
        ));
        assert!(!unreachable("error[vulnerability]: a bug in a crate"));
    }
}
