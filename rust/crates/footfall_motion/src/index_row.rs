//! Labels of a recording, as an index of a corpus gives them.

use std::path::PathBuf;

/// Labels of a recording: its row of the index.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IndexRow {
    /// Line in the index, from 1; 0 without an index.
    pub line: u64,
    /// The recording; the index gives it relative to itself.
    pub path: PathBuf,
    /// Every column in the order of the index: name and value.
    pub columns: Vec<(String, String)>,
}

impl IndexRow {
    /// The value of a column.
    pub fn column(&self, name: &str) -> Option<&str> {
        self.columns
            .iter()
            .find(|(column, _)| column == name)
            .map(|(_, value)| value.as_str())
    }

    /// Sets the value of a column.
    pub fn set(&mut self, name: &str, value: &str) {
        match self.columns.iter_mut().find(|(column, _)| column == name) {
            Some((_, old)) => value.clone_into(old),
            None => self.columns.push((name.to_owned(), value.to_owned())),
        }
    }

    /// The value of the column `category`.
    pub fn category(&self) -> &str {
        self.column("category").unwrap_or_default()
    }

    /// The value of the column `style`.
    pub fn style(&self) -> &str {
        self.column("style").unwrap_or_default()
    }

    /// The value of the column `subject`.
    pub fn subject(&self) -> &str {
        self.column("subject").unwrap_or_default()
    }
}
