//! Two corpora on one command line, each with conditions of its own.

use crate::motion_input::SkeletonArgs;
use anyhow::{Context as _, Result};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use footfall_motion::corpus::{Corpus, Where};
use std::path::PathBuf;

/// An index and what its rows must meet.
#[derive(Clone, Debug)]
pub(crate) struct CorpusChoice {
    /// The table of the recordings.
    pub(crate) index: PathBuf,
    /// Conditions on its columns.
    pub(crate) conditions: Vec<Where>,
}

impl CorpusChoice {
    /// Reads the recordings.
    pub(crate) fn read(&self, fit: SkeletonArgs) -> Result<Corpus> {
        fit.read_corpus(&self.index, &self.conditions)
    }
}

/// `--real` and `--synthesised`; every `--where` belongs to the corpus that was named last before it.
#[derive(Clone, Debug)]
pub(crate) struct CorpusPair {
    /// Captured people.
    pub(crate) real: CorpusChoice,
    /// Synthesised walks to judge, if they were given.
    pub(crate) synthesised: Option<CorpusChoice>,
}

const REAL: &str = "real";
const SYNTHESISED: &str = "synthesised";
const WHERE: &str = "where";

impl Args for CorpusPair {
    fn augment_args(command: Command) -> Command {
        let index = |name: &'static str, help: &'static str| {
            Arg::new(name)
                .long(name)
                .value_name("INDEX.csv")
                .value_parser(clap::value_parser!(PathBuf))
                .help(help)
        };
        command
            .arg(
                index(
                    REAL,
                    "Table of the real recordings; its column `style` names what they show",
                )
                .required(true),
            )
            .arg(index(
                SYNTHESISED,
                "Table of the synthesised recordings, with the same names of styles",
            ))
            .arg(
                Arg::new(WHERE)
                    .long(WHERE)
                    .value_name("COLUMN=VALUE")
                    .value_parser(|text: &str| text.parse::<Where>())
                    .action(ArgAction::Append)
                    .help("Condition on a column of the table named last before it; repeatable"),
            )
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for CorpusPair {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let path = |name: &str| matches.get_one::<PathBuf>(name).cloned();
        let place = |name: &str| matches.index_of(name);
        let mut real = CorpusChoice {
            index: path(REAL).ok_or_else(|| {
                clap::Error::raw(
                    clap::error::ErrorKind::MissingRequiredArgument,
                    "error: --real is missing\n",
                )
            })?,
            conditions: Vec::new(),
        };
        let mut synthesised = path(SYNTHESISED).map(|index| CorpusChoice {
            index,
            conditions: Vec::new(),
        });
        let conditions = matches.get_many::<Where>(WHERE).unwrap_or_default();
        for (condition, at) in conditions.zip(matches.indices_of(WHERE).unwrap_or_default()) {
            // The corpus named last before the condition; the one named first when none was.
            let before = |name| place(name).filter(|place| *place < at);
            let is_synthesised = match (before(REAL), before(SYNTHESISED)) {
                (None, None) => place(SYNTHESISED) < place(REAL) && synthesised.is_some(),
                (real, synthesised) => synthesised > real,
            };
            match &mut synthesised {
                Some(choice) if is_synthesised => choice.conditions.push(condition.clone()),
                _ => real.conditions.push(condition.clone()),
            }
        }
        Ok(Self { real, synthesised })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The corpora of a pair, read.
pub(crate) struct ReadPair {
    /// Captured people.
    pub(crate) real: Corpus,
    /// Synthesised walks to judge.
    pub(crate) synthesised: Option<Corpus>,
}

impl CorpusPair {
    /// Reads both.
    pub(crate) fn read(&self, fit: SkeletonArgs) -> Result<ReadPair> {
        let real = self.real.read(fit).context("the real recordings")?;
        let synthesised = self
            .synthesised
            .as_ref()
            .map(|choice| choice.read(fit))
            .transpose();
        Ok(ReadPair {
            real,
            synthesised: synthesised.context("the synthesised recordings")?,
        })
    }
}

impl ReadPair {
    /// Files that could not be used, one line each.
    pub(crate) fn skipped(&self) -> Vec<String> {
        [Some(&self.real), self.synthesised.as_ref()]
            .into_iter()
            .flatten()
            .flat_map(|corpus| corpus.report.reasons())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        pair: CorpusPair,
    }

    fn conditions(line: &str) -> (Vec<String>, Vec<String>) {
        let pair = Line::try_parse_from(line.split_whitespace()).unwrap().pair;
        let texts =
            |choice: &CorpusChoice| choice.conditions.iter().map(Where::to_string).collect();
        (
            texts(&pair.real),
            pair.synthesised.as_ref().map(texts).unwrap_or_default(),
        )
    }

    #[test]
    fn a_condition_belongs_to_the_corpus_named_before_it() {
        let both = |real: &[&str], synthesised: &[&str]| {
            let owned = |texts: &[&str]| {
                texts
                    .iter()
                    .map(|text| (*text).to_owned())
                    .collect::<Vec<_>>()
            };
            (owned(real), owned(synthesised))
        };
        for (line, expected) in [
            (
                "x --real a --where b=1 --where c=2",
                both(&["b=1", "c=2"], &[]),
            ),
            (
                "x --real a --where b=1 --synthesised d --where c=2",
                both(&["b=1"], &["c=2"]),
            ),
            (
                "x --synthesised d --where c=2 --real a --where b=1",
                both(&["b=1"], &["c=2"]),
            ),
            (
                "x --where b=1 --real a --synthesised d",
                both(&["b=1"], &[]),
            ),
            (
                "x --where c=2 --synthesised d --real a",
                both(&[], &["c=2"]),
            ),
            ("x --where b=1 --real a", both(&["b=1"], &[])),
        ] {
            assert_eq!(conditions(line), expected, "{line}");
        }
        assert!(Line::try_parse_from(["x", "--synthesised", "d"]).is_err());
        assert!(Line::try_parse_from(["x", "--real", "a", "--where", "b"]).is_err());
    }
}
