//! Content of a resource: what was read from a file's bytes.

use footfall_model::Provenance;
use godot::prelude::*;
use std::fmt::Display;
use std::sync::Arc;

/// The content of a file, why there is none, or nothing yet.
#[derive(Debug)]
pub(crate) struct Loaded<T>(Option<Result<Arc<T>, String>>);

impl<T> Default for Loaded<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T> Loaded<T> {
    /// Reads the bytes of a file; no bytes are no file.
    pub(crate) fn read<E: Display>(
        data: &PackedByteArray,
        read: impl Fn(&[u8]) -> Result<T, E>,
    ) -> Self {
        let read = || {
            read(data.as_slice())
                .map(Arc::new)
                .map_err(|error| error.to_string())
        };
        Self((!data.is_empty()).then(read))
    }

    /// The content, or what is wrong with it; `empty` when there was no file.
    ///
    /// # Errors
    /// Text for the user that says what is wrong.
    pub(crate) fn content(&self, empty: &str) -> Result<Arc<T>, String> {
        self.0.clone().unwrap_or_else(|| Err(empty.to_owned()))
    }

    /// The problem of the file, or nothing; `empty` when there was no file.
    pub(crate) fn error(&self, empty: &str) -> GString {
        self.content(empty)
            .map_or_else(|error| GString::from(&error), |_| GString::new())
    }

    /// The content in words, or what is wrong with it.
    pub(crate) fn describe(&self, describe: impl Fn(&T) -> String) -> GString {
        match &self.0 {
            Some(Ok(content)) => GString::from(&describe(content)),
            Some(Err(error)) => GString::from(error),
            None => GString::new(),
        }
    }
}

/// The recordings, terms and command that a model was made from, for the inspector.
pub(crate) fn sources(from: &Provenance) -> String {
    format!(
        "Corpus: {}\nTerms: {}\nMade by: {}",
        from.corpus, from.terms, from.command
    )
}
