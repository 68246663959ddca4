//! Errors of evaluating contacts.

use crate::ReadModelError;
use core::fmt::Display;
use footfall_imu::csv::ImuCsvError;
use footfall_motion::corpus::CorpusError;
use std::path::{Path, PathBuf};

/// Errors of evaluating contacts.
#[derive(Debug, thiserror::Error)]
pub enum ContactsError {
    /// A recording, a file of events or a model that cannot be used.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Fault, and the next step to take.
        reason: String,
    },
    /// A row of the index of sensors lacks something.
    #[error("{}, line {line}: {reason}", index.display())]
    Row {
        /// The index.
        index: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Lack, and the next step to take.
        reason: String,
    },
    /// The index of sensors cannot be read.
    #[error(transparent)]
    Index(#[from] CorpusError),
    /// A recording of a sensor cannot be read.
    #[error(transparent)]
    Samples(#[from] ImuCsvError),
    /// The model cannot be read.
    #[error(transparent)]
    ReadModel(#[from] ReadModelError),
}

impl ContactsError {
    /// A fault of a file.
    pub(super) fn file(path: &Path, reason: impl Display) -> Self {
        Self::File {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}
