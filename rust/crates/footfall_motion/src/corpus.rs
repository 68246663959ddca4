//! Many recordings at once, selected from an index by its columns; hip joints are found person by person.

mod people;
mod selection;

pub use crate::index_row::IndexRow;
pub use people::{Person, PersonFile, find_people, options_of};
pub use selection::{Where, read_index};

use crate::recording::Recording;
use crate::retarget::{RetargetOptions, Retargeted, SkeletonFit};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A recording that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkippedClip {
    /// The file.
    pub path: PathBuf,
    /// Its line in the index.
    pub line: u64,
    /// Why.
    pub reason: String,
}

/// Outcome of reading the chosen rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CorpusReport {
    /// Rows that meet all conditions.
    pub selected: usize,
    /// Clips among them that could not be used, in the order of the index.
    pub skipped: Vec<SkippedClip>,
    /// The people and the findings about their hip joints; empty where the caller said where these are.
    pub people: Vec<Person>,
}

impl CorpusReport {
    /// Reasons why recordings were left out, in the order of the index; each names its file.
    pub fn reasons(&self) -> Vec<String> {
        let skipped = self.skipped.iter();
        skipped.map(|clip| clip.reason.clone()).collect()
    }
}

/// Recordings selected from an index.
#[derive(Clone, Debug)]
pub struct Corpus {
    /// In the order of the index; at least one.
    pub clips: Vec<Recording>,
    /// Rows that were left out, and reasons.
    pub report: CorpusReport,
}

/// Errors of reading a corpus.
#[derive(Debug, thiserror::Error)]
pub enum CorpusError {
    /// The index cannot be opened or is no CSV file.
    #[error("{}: {source}", index.display())]
    Csv {
        /// The index.
        index: PathBuf,
        /// Fault, with the line if there is one.
        source: csv::Error,
    },
    /// The index lacks a column that is needed.
    #[error(
        "{}, line 1: no column \"{column}\"; its columns are {}",
        index.display(),
        columns.join(", ")
    )]
    MissingColumn {
        /// The index.
        index: PathBuf,
        /// The column that is not there.
        column: String,
        /// Columns that exist.
        columns: Vec<String>,
    },
    /// A row has nothing where a value is needed.
    #[error("{}, line {line}: column \"{column}\" is empty", index.display())]
    EmptyField {
        /// The index.
        index: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The column.
        column: String,
    },
    /// A condition is neither `column=value` nor `column!=value`.
    #[error(
        "\"{0}\" is not a condition; write column=value or column!=value, for example category=neutral_walk or path=walks/*"
    )]
    Condition(String),
    /// No row meets the conditions.
    #[error("{}: no row has {conditions}; column \"{column}\" has {}", index.display(), values.join(", "))]
    NothingSelected {
        /// The index.
        index: PathBuf,
        /// All conditions.
        conditions: String,
        /// The column whose condition leaves nothing.
        column: String,
        /// The values of that column among the rows that meet the conditions before it.
        values: Vec<String>,
    },
    /// All chosen recordings are broken.
    #[error("{}: none of the {count} selected recordings can be used; the first: {first}", index.display())]
    NothingUsable {
        /// The index.
        index: PathBuf,
        /// Number of chosen recordings.
        count: usize,
        /// Fault of the first.
        first: String,
    },
}

impl Corpus {
    /// Reads the recordings of an index that meet all conditions, retargets them and finds contacts and walks.
    ///
    /// # Errors
    /// [`CorpusError`] for an index that cannot be used and for a choice without a usable recording. A single broken
    /// recording is no error: it is listed in the report.
    pub fn read(index: impl AsRef<Path>, conditions: &[Where]) -> Result<Self, CorpusError> {
        Self::read_with(index, conditions, &RetargetOptions::default())
    }

    /// The same with a joint map or a frame rate of one's own.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(
        index: impl AsRef<Path>,
        conditions: &[Where],
        options: &RetargetOptions,
    ) -> Result<Self, CorpusError> {
        let index = index.as_ref();
        let rows = read_index(index)?;
        let chosen = selection::select(index, rows.clone(), conditions)?;
        let selected = chosen.len();
        let (people, mut motions) = match options.fit {
            SkeletonFit::FromRecording => {
                let files = people::rows_of_same_people(&rows, &chosen);
                let paths: BTreeSet<&Path> = chosen.iter().map(|row| row.path.as_path()).collect();
                people::read_people(&files, options, |path| paths.contains(path))
            }
            SkeletonFit::AsRecorded | SkeletonFit::Known(_) => Default::default(),
        };
        let chosen: Vec<_> = chosen
            .into_iter()
            .map(|row| {
                let motion = motions.remove(&row.path);
                (row, motion)
            })
            .collect();
        // In parallel, but collected in order: the same corpus every time.
        let results: Vec<Result<Recording, SkippedClip>> = chosen
            .into_par_iter()
            .map(|(row, motion)| {
                let options = options_of(&people, &row.path, options);
                read_clip(row, motion, &options)
            })
            .collect();
        let mut corpus = Self {
            clips: Vec::with_capacity(selected),
            report: CorpusReport {
                selected,
                skipped: Vec::new(),
                people,
            },
        };
        for result in results {
            match result {
                Ok(clip) => corpus.clips.push(clip),
                Err(skipped) => corpus.report.skipped.push(skipped),
            }
        }
        match corpus.report.skipped.first() {
            Some(first) if corpus.clips.is_empty() => Err(CorpusError::NothingUsable {
                index: index.to_owned(),
                count: selected,
                first: first.reason.clone(),
            }),
            _ => Ok(corpus),
        }
    }
}

/// Reads a clip; its motion as recorded may be at hand already.
fn read_clip(
    row: IndexRow,
    motion: Option<Retargeted>,
    options: &RetargetOptions,
) -> Result<Recording, SkippedClip> {
    let skipped = |reason: String| SkippedClip {
        path: row.path.clone(),
        line: row.line,
        reason,
    };
    let recording = match (motion, options.fit) {
        (Some(mut motion), SkeletonFit::Known(finding)) if finding.is_as_recorded() => {
            motion.report.fit = finding;
            Recording::of_file(&row.path, options, motion)
        }
        _ => Recording::read(&row.path, options),
    };
    match recording {
        Ok(recording) => Ok(Recording { row, ..recording }),
        Err(error) => Err(skipped(error.to_string())),
    }
}
