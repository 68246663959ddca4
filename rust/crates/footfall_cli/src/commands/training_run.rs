//! A run of a command that trains: what it reads, what the model's file says of its making, and where it is written.

use crate::motion_input::CorpusArgs;
use crate::output::{self, write_atomic};
use anyhow::Result;
use footfall_model::Provenance;
use footfall_motion::corpus::{Corpus, Where};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The column of an index that states the terms of each recording.
const LICENSE_COLUMN: &str = "license";

/// A run of `train`, `adapt`, `dynamics fit` or `imu train`.
pub(super) struct TrainingRun<'a> {
    corpus: &'a CorpusArgs,
    /// Description of the data in the user's words.
    words: Option<&'a str>,
    output: &'a Path,
    begun: Instant,
}

/// A recording that could not be used, and why.
#[derive(Serialize)]
pub(super) struct Skipped {
    file: PathBuf,
    pub(super) reason: String,
}

impl<'a> TrainingRun<'a> {
    /// Begins a run; its output must not be the index.
    #[expect(clippy::disallowed_methods, reason = "a tool reports its running time")]
    pub(super) fn begin(
        corpus: &'a CorpusArgs,
        words: Option<&'a str>,
        output: &'a Path,
    ) -> Result<Self> {
        let begun = Instant::now();
        output::refuse_overwrite(&[&corpus.index], output)?;
        Ok(Self {
            corpus,
            words,
            output,
            begun,
        })
    }

    /// Seconds since it began.
    pub(super) fn seconds(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Reads the recordings that meet the run's conditions.
    pub(super) fn read(&self) -> Result<Corpus> {
        self.read_where(&self.corpus.conditions)
    }

    /// Reads the recordings that meet conditions. The model may overwrite none of them.
    fn read_where(&self, conditions: &[Where]) -> Result<Corpus> {
        let corpus = self
            .corpus
            .fit
            .read_corpus(&self.corpus.index, conditions)?;
        for clip in &corpus.clips {
            output::refuse_overwrite(&[&clip.row.path], self.output)?;
        }
        Ok(corpus)
    }

    /// The recordings that meet conditions of their own, if some are given.
    pub(super) fn read_further(&self, conditions: &[Where]) -> Result<Option<Corpus>> {
        if conditions.is_empty() {
            return Ok(None);
        }
        self.read_where(conditions).map(Some)
    }

    /// Description of the recordings, their terms, and the command that makes the model: `command`, the corpus and its conditions,
    /// `further` conditions, and `options`. Names of files come without their folders, so that a model reveals nothing about the machine
    /// that made it.
    pub(super) fn provenance(
        &self,
        corpus: &Corpus,
        command: &str,
        further: &[(&str, &[Where])],
        options: &[String],
    ) -> Provenance {
        let mut words = vec![format!(
            "{command} --corpus {}",
            name_of(&self.corpus.index)
        )];
        let own = [("where", self.corpus.conditions.as_slice())];
        for (option, conditions) in own.iter().chain(further) {
            words.extend(conditions.iter().map(|one| format!("--{option} '{one}'")));
        }
        words.extend(self.corpus.fit.words());
        words.extend_from_slice(options);
        words.push(format!("-o {}", name_of(self.output)));
        Provenance {
            corpus: self.described(further),
            terms: terms(&[corpus]),
            command: words.join(" "),
            commit: std::env::var("FOOTFALL_COMMIT").unwrap_or_default(),
            ..Provenance::default()
        }
    }

    /// The recordings in the user's words, else by their conditions.
    fn described(&self, further: &[(&str, &[Where])]) -> String {
        if let Some(words) = self.words {
            return words.to_owned();
        }
        let index = name_of(&self.corpus.index);
        let mut described = if self.corpus.conditions.is_empty() {
            format!("all of {index}")
        } else {
            format!("{index} where {}", joined(&self.corpus.conditions))
        };
        for (behaviour, conditions) in further.iter().filter(|(_, all)| !all.is_empty()) {
            described.extend(["; ", behaviour, " where ", &joined(conditions)]);
        }
        described
    }

    /// Writes the model.
    pub(super) fn write(&self, bytes: &[u8]) -> Result<()> {
        write_atomic(self.output, bytes)
    }
}

fn joined(conditions: &[Where]) -> String {
    let conditions: Vec<String> = conditions.iter().map(ToString::to_string).collect();
    conditions.join(" and ")
}

/// The terms that the recordings of corpora come under, each once.
pub(super) fn terms(corpora: &[&Corpus]) -> String {
    let clips = corpora.iter().flat_map(|corpus| &corpus.clips);
    let terms: BTreeSet<&str> = clips
        .filter_map(|clip| clip.row.column(LICENSE_COLUMN))
        .filter(|terms| !terms.is_empty())
        .collect();
    if terms.is_empty() {
        return "not stated by the index".to_owned();
    }
    terms.into_iter().collect::<Vec<_>>().join("; ")
}

/// A file's name without its folder.
pub(super) fn name_of(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Ends a command that made something: warnings about recordings that were left out and others, then the report as JSON or the lines that it is in words.
pub(super) fn conclude<R: Serialize>(
    json: bool,
    report: &R,
    left_out: impl IntoIterator<Item = impl AsRef<str>>,
    warnings: &[String],
    words: impl FnOnce(&R) -> Vec<String>,
) -> Result<()> {
    output::note_left_out(left_out);
    for warning in warnings {
        output::note(&format!("warning: {warning}"));
    }
    if json {
        return output::print_json(report);
    }
    for line in words(report) {
        output::note(&line);
    }
    Ok(())
}

/// Recordings that a corpus left out.
pub(super) fn skipped(corpus: &Corpus) -> Vec<Skipped> {
    let skipped = corpus.report.skipped.iter();
    skipped
        .map(|skipped| Skipped {
            file: skipped.path.clone(),
            reason: skipped.reason.clone(),
        })
        .collect()
}
