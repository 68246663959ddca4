//! Provenance of a model.

use serde::{Deserialize, Serialize};

/// Provenance of a model, and its terms: stored in every file, shown by `footfall inspect`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Training data, in words a reader understands.
    pub corpus: String,
    /// Terms of the data, as the corpus states them.
    pub terms: String,
    /// The command that made it.
    pub command: String,
    /// The commit of this project that it was made with; empty when unknown.
    pub commit: String,
    /// Number of clips used.
    pub clips: usize,
    /// Number of different subjects in them.
    pub subjects: usize,
    /// Number of steps used, mirrored ones not counted.
    pub steps: usize,
}
