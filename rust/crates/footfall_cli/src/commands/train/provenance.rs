//! Provenance of a model, for its file.

use super::{TrainArgs, WindowsArg};
use footfall_model::Provenance;
use footfall_motion::corpus::{Corpus, Where};
use std::collections::BTreeSet;
use std::path::Path;

/// The column of an index that states the terms of each recording.
const LICENSE_COLUMN: &str = "license";

/// Corpus, terms and command; the trainer fills in the counts. `others` are the recordings of what the model knows beside the walk.
pub(super) fn of(corpus: &Corpus, others: &[Option<&Corpus>], args: &TrainArgs) -> Provenance {
    let conditions: Vec<String> = args.conditions.iter().map(ToString::to_string).collect();
    let command = command(args, &name_of(&args.corpus), &conditions);
    let mut described = describe(
        corpus,
        &args.corpus,
        &args.conditions,
        args.describe.as_deref(),
        command,
    );
    if args.describe.is_none() {
        for (behaviour, conditions) in further(args) {
            if !conditions.is_empty() {
                let conditions: Vec<String> = conditions.iter().map(ToString::to_string).collect();
                let conditions = conditions.join(" and ");
                described
                    .corpus
                    .extend(["; ", behaviour, " where ", &conditions]);
            }
        }
    }
    let others = others.iter().copied().flatten();
    let all = others.flat_map(|corpus| &corpus.clips).chain(&corpus.clips);
    described.terms = terms(all.filter_map(|clip| clip.row.column(LICENSE_COLUMN)));
    described
}

/// Behaviours beside the walk, and the conditions on their recordings.
fn further(args: &TrainArgs) -> [(&'static str, &[Where]); 4] {
    [
        ("standing", &args.standing),
        ("running", &args.running),
        ("jumping", &args.jumping),
        ("crouching", &args.crouching),
    ]
}

/// The terms that recordings come under, each once.
fn terms<'a>(stated: impl Iterator<Item = &'a str>) -> String {
    let terms: BTreeSet<&str> = stated.filter(|terms| !terms.is_empty()).collect();
    if terms.is_empty() {
        return "not stated by the index".to_owned();
    }
    terms.into_iter().collect::<Vec<_>>().join("; ")
}

/// Description of the recordings that are chosen from an index, in the user's words if there are some, and their terms. Names of files come
/// without their folders, so that a model reveals nothing about the machine that made it.
pub(in crate::commands) fn describe(
    corpus: &Corpus,
    index: &Path,
    conditions: &[Where],
    words: Option<&str>,
    command: String,
) -> Provenance {
    let conditions: Vec<String> = conditions.iter().map(ToString::to_string).collect();
    let index = name_of(index);
    let described = match (words, conditions.is_empty()) {
        (Some(words), _) => words.to_owned(),
        (None, true) => format!("all of {index}"),
        (None, false) => format!("{index} where {}", conditions.join(" and ")),
    };
    let clips = corpus.clips.iter();
    Provenance {
        corpus: described,
        terms: terms(clips.filter_map(|clip| clip.row.column(LICENSE_COLUMN))),
        command,
        commit: std::env::var("FOOTFALL_COMMIT").unwrap_or_default(),
        ..Provenance::default()
    }
}

fn command(args: &TrainArgs, index: &str, conditions: &[String]) -> String {
    let mut words = vec!["footfall train --corpus".to_owned(), index.to_owned()];
    for condition in conditions {
        words.push(format!("--where '{condition}'"));
    }
    for (behaviour, conditions) in further(args) {
        for condition in conditions {
            words.push(format!("--{behaviour} '{condition}'"));
        }
    }
    words.extend(args.knees.words());
    words.push(format!("--fps {}", args.fps));
    words.push(format!(
        "--windows {}",
        match args.windows {
            WindowsArg::Paper => "paper",
            WindowsArg::Compact => "compact",
        }
    ));
    words.push(format!("--iterations {}", args.iterations));
    words.push(format!("-o {}", name_of(&args.output)));
    words.join(" ")
}

/// A file's name without its folder.
pub(in crate::commands) fn name_of(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
