//! Checks and tests that `cargo verify` leaves out, and the recordings that it was promised.

use crate::paths;
use anyhow::{Context as _, Result, bail, ensure};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Variable under which tests find the list; `footfall_tests::skips` writes to it.
pub(crate) const LIST: &str = "FOOTFALL_SKIPPED";

/// File with a line for each skipped test: its name, a tabulator, the reason.
pub(crate) fn list() -> PathBuf {
    paths::target_folder().join("verify").join("skipped.txt")
}

/// Begins an empty list.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn begin() -> Result<()> {
    let list = list();
    if let Some(folder) = list.parent() {
        fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    }
    fs::write(&list, "").with_context(|| format!("cannot write {}", list.display()))
}

/// Adds a check that is left out here.
///
/// # Errors
/// When the list cannot be written.
pub(crate) fn note(check: &str, reason: &str) -> Result<()> {
    let list = list();
    eprintln!("{check}: skipped, {reason}");
    let file = fs::OpenOptions::new().create(true).append(true).open(&list);
    file.and_then(|mut file| file.write_all(format!("{check}\t{reason}\n").as_bytes()))
        .with_context(|| format!("cannot write {}", list.display()))
}

/// Lines that say how many were skipped, and for each reason which.
///
/// # Errors
/// When the list cannot be read.
pub(crate) fn summary() -> Result<String> {
    let list = list();
    let text =
        fs::read_to_string(&list).with_context(|| format!("cannot read {}", list.display()))?;
    Ok(summarised(&text))
}

fn summarised(list: &str) -> String {
    let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut count = 0;
    for (test, reason) in list.lines().filter_map(|line| line.split_once('\t')) {
        let tests = by_reason.entry(reason).or_default();
        if !tests.contains(&test) {
            tests.push(test);
            count += 1;
        }
    }
    let mut text = format!("{count} skipped");
    for (reason, tests) in by_reason {
        // Writing to a string does not fail.
        let _written = write!(
            text,
            "\n   {} ({reason}): {}",
            tests.len(),
            tests.join(", ")
        );
    }
    text
}

/// Checks that the recordings are there which a build server was promised: those of the index that `FOOTFALL_DATA` points to.
///
/// # Errors
/// The first file that is missing.
pub(crate) fn check_promised_recordings() -> Result<()> {
    let promised = std::env::var_os("FOOTFALL_DATA").filter(|_| std::env::var_os("CI").is_some());
    promised.map_or(Ok(()), |folder| check_recordings(Path::new(&folder)))
}

fn check_recordings(folder: &Path) -> Result<()> {
    let index = folder.join("index.csv");
    let mut table = csv::Reader::from_path(&index).with_context(|| {
        format!(
            "{} is missing, but FOOTFALL_DATA promises recordings; add it or unset FOOTFALL_DATA",
            index.display()
        )
    })?;
    let headers = table.headers().context("the index has no header")?.clone();
    let Some(column) = headers.iter().position(|name| name == "path") else {
        bail!("{}: no column \"path\"", index.display());
    };
    for (row, record) in table.records().enumerate() {
        let record = record.with_context(|| index.display().to_string())?;
        let file = folder.join(record.get(column).unwrap_or_default());
        ensure!(
            file.is_file(),
            "{}, line {}: {} is missing; add it or unset FOOTFALL_DATA",
            index.display(),
            row + 2,
            file.display()
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_are_counted_once_and_grouped_by_their_reason() {
        let list = "a\tno data\nb\tno browser\na\tno data\nc\tno data\nbroken line\n";
        assert_eq!(
            summarised(list),
            "3 skipped\n   1 (no browser): b\n   2 (no data): a, c"
        );
        assert_eq!(summarised(""), "0 skipped");
    }

    #[test]
    fn a_promise_of_recordings_is_kept_by_every_file_of_the_index() {
        let folder = paths::repository_root().join("tests/data");
        check_recordings(&folder).unwrap();
        let error = check_recordings(&folder.join("rigs")).unwrap_err();
        assert!(format!("{error:#}").contains("index.csv"), "{error:#}");
        let lacking = paths::target_folder().join("lacking_recordings");
        fs::create_dir_all(&lacking).unwrap();
        fs::write(lacking.join("index.csv"), "path,style\nnone.bvh,sad\n").unwrap();
        let error = check_recordings(&lacking).unwrap_err().to_string();
        assert!(
            error.contains("line 2") && error.contains("none.bvh"),
            "{error}"
        );
    }
}
