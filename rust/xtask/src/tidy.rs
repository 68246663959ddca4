//! `cargo xtask tidy`: the design's invariants, as far as Clippy does not check them (`clippy.toml` of the crates): from `cargo metadata`, the list of files and their lines.

mod dependencies;
mod files;
mod lines;
mod lints;

use crate::{paths, process};
use anyhow::{Context as _, Result, bail};
use std::fmt;
use std::process::Command;

/// One breach of a rule.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Violation {
    /// The file, from the repository's root.
    file: String,
    /// The line, counted from 1; 0 for the whole file.
    line: usize,
    /// Text of the rule.
    rule: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.file, self.rule),
            line => write!(f, "{}:{line}: {}", self.file, self.rule),
        }
    }
}

/// Prints every violation.
///
/// # Errors
/// When there is one, or the repository cannot be read.
pub(crate) fn command() -> Result<()> {
    let violations = check()?;
    for violation in &violations {
        eprintln!("{violation}");
    }
    if !violations.is_empty() {
        bail!(
            "{} breach(es) of the design's rules; rust/ARCHITECTURE.md has the reasons",
            violations.len()
        );
    }
    Ok(())
}

fn check() -> Result<Vec<Violation>> {
    let root = paths::repository_root();
    let metadata = process::metadata()?;
    let mut violations = dependencies::check(&metadata);
    let listed = process::read(Command::new("git").current_dir(&root).args([
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ]))
    .context("tidy reads the list of files from git")?;
    let names: Vec<&str> = listed.split('\0').filter(|name| !name.is_empty()).collect();
    violations.extend(files::top_level(&names));
    let read = |name: &str| std::fs::read_to_string(root.join(name)).ok();
    violations.extend(lints::check(&names, read));
    for name in names {
        let path = root.join(name);
        // A file that was deleted but not yet committed is still listed.
        let Ok(data) = path.symlink_metadata() else {
            continue;
        };
        if data.is_symlink() || data.is_dir() {
            continue;
        }
        violations.extend(files::size(name, data.len()));
        let bytes = std::fs::read(&path).with_context(|| format!("cannot read {name}"))?;
        let Ok(text) = String::from_utf8(bytes) else {
            continue;
        };
        violations.extend(files::machine_paths(name, &text));
        violations.extend(lines::check(name, &text));
    }
    violations.sort();
    Ok(violations)
}
