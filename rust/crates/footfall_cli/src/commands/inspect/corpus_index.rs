//! Facts of a corpus index.

use super::fact;
use anyhow::Result;
use footfall_motion::corpus::{IndexRow, read_index};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Facts of an index.
#[derive(Serialize)]
pub(super) struct IndexFacts {
    file: PathBuf,
    clips: usize,
    /// Clips of each.
    categories: BTreeMap<String, usize>,
    styles: BTreeMap<String, usize>,
    subjects: BTreeMap<String, usize>,
    /// Files that the index names but that are not there.
    missing: Vec<PathBuf>,
}

/// Reads an index.
pub(super) fn inspect(path: &Path) -> Result<IndexFacts> {
    let rows = read_index(path)?;
    let count = |value: fn(&IndexRow) -> &str| {
        let mut counts = BTreeMap::new();
        for row in &rows {
            *counts.entry(value(row).to_owned()).or_insert(0) += 1;
        }
        counts
    };
    Ok(IndexFacts {
        file: path.to_owned(),
        clips: rows.len(),
        categories: count(IndexRow::category),
        styles: count(IndexRow::style),
        subjects: count(IndexRow::subject),
        missing: rows
            .iter()
            .filter(|row| !row.path.is_file())
            .map(|row| row.path.clone())
            .collect(),
    })
}

impl IndexFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let list = |counts: &BTreeMap<String, usize>| {
            counts
                .iter()
                .map(|(name, count)| format!("{name} {count}"))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let mut lines = vec![
            fact("index", self.file.display()),
            fact("clips", self.clips),
            fact("categories", list(&self.categories)),
            fact("styles", list(&self.styles)),
            fact("subjects", list(&self.subjects)),
        ];
        lines.extend(
            self.missing
                .iter()
                .map(|path| fact("missing", path.display())),
        );
        lines
    }
}
