//! People of an index, and what is wrong with each person's skeleton.
//!
//! A person is a subject with one skeleton: a subject whose clips have several skeletons is several people. A subject that
//! the index marks as unsure with a `?` may be any person, so each of its clips stands for itself. One person under two
//! names is taken for two, and each is found from their own clips; several people under one name with one skeleton are
//! taken for one.

use super::IndexRow;
use crate::recording::read_as_recorded;
use crate::retarget::{RetargetOptions, Retargeted, SkeletonFit};
use crate::skeleton_fit::{FitFinding, find_fit};
use crate::walking_evidence::{Manner, WalkingEvidence};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::iter;
use std::path::{Path, PathBuf};

/// Styles whose clips show a person's knees and head: acted walks bend them on purpose.
const PLAIN: [&str; 2] = ["neutral", "normal"];

/// A person of a corpus.
#[derive(Clone, Debug, PartialEq)]
pub struct Person {
    /// The subject of the index.
    pub subject: String,
    /// The recordings with this person's skeleton, in the order of the index.
    pub paths: Vec<PathBuf>,
    /// The findings about the skeleton.
    pub fit: FitFinding,
}

/// A recording and who is said to be in it.
#[derive(Clone, Copy, Debug)]
pub struct PersonFile<'a> {
    /// The recording.
    pub path: &'a Path,
    /// The person.
    pub subject: &'a str,
    /// The manner that it is said to show.
    pub manner: Manner,
}

/// A clip's part in finding its person.
struct Witness<'a> {
    file: PersonFile<'a>,
    evidence: WalkingEvidence,
}

/// Returns true when an index is unsure who it is.
fn is_unidentified(subject: &str) -> bool {
    subject.contains('?')
}

/// The chosen rows, and all others that show plain walking of the same people.
pub(super) fn rows_of_same_people<'a>(
    all: &'a [IndexRow],
    chosen: &[IndexRow],
) -> Vec<PersonFile<'a>> {
    let paths: BTreeSet<&Path> = chosen.iter().map(|row| row.path.as_path()).collect();
    let subjects: BTreeSet<&str> = chosen.iter().map(IndexRow::subject).collect();
    let files = all.iter().map(|row| PersonFile {
        path: &row.path,
        subject: row.subject(),
        manner: if PLAIN.contains(&row.style()) {
            Manner::Plain
        } else {
            Manner::Acted
        },
    });
    let of_same = |file: &PersonFile<'_>| {
        file.manner == Manner::Plain
            && !is_unidentified(file.subject)
            && subjects.contains(file.subject)
    };
    files
        .filter(|file| paths.contains(file.path) || of_same(file))
        .collect()
}

/// Finds the people in recordings, in the order in which they first appear. Files that cannot be read take no part.
pub fn find_people(files: &[PersonFile<'_>], options: &RetargetOptions) -> Vec<Person> {
    read_people(files, options, |_| false).0
}

/// Recordings as the files have them.
pub(super) type AsRecorded = BTreeMap<PathBuf, Retargeted>;

/// As [`find_people`], with the motion of those files that are to be kept.
pub(super) fn read_people(
    files: &[PersonFile<'_>],
    options: &RetargetOptions,
    keep: impl Fn(&Path) -> bool + Sync,
) -> (Vec<Person>, AsRecorded) {
    let read: Vec<_> = files
        .par_iter()
        .filter_map(|&file| {
            let (motion, evidence) = read_as_recorded(file.path, options).ok()?;
            let kept = keep(file.path).then(|| (file.path.to_owned(), motion));
            Some((Witness { file, evidence }, kept))
        })
        .collect();
    let (witnesses, kept): (Vec<_>, Vec<_>) = read.into_iter().unzip();
    (people_of(witnesses), kept.into_iter().flatten().collect())
}

fn people_of(witnesses: Vec<Witness<'_>>) -> Vec<Person> {
    let mut people: Vec<Vec<Witness<'_>>> = Vec::new();
    for witness in witnesses {
        let of_same = people.iter_mut().find(|person| {
            let first = &person[0];
            first.file.subject == witness.file.subject
                && !is_unidentified(first.file.subject)
                && first.evidence.shares_skeleton_with(&witness.evidence)
        });
        match of_same {
            Some(person) => person.push(witness),
            None => people.push(vec![witness]),
        }
    }
    people.into_iter().flat_map(people_of_one_name).collect()
}

/// The person whom the clips of a name and skeleton show. A clip in which the joints of all together would stretch a leg beyond its length
/// shows another person on a foreign skeleton, and stands for itself.
fn people_of_one_name(clips: Vec<Witness<'_>>) -> Vec<Person> {
    let person = Person::from_clips(&clips);
    let Some(correction) = person.fit.hip_centres.verdict.correction() else {
        return vec![person];
    };
    let (own, others): (Vec<_>, Vec<_>) = clips
        .into_iter()
        .partition(|clip| correction.suits(&clip.evidence));
    if own.is_empty() || others.is_empty() {
        return vec![person];
    }
    let others = others.into_iter().map(|clip| Person::from_clips(&[clip]));
    iter::once(Person::from_clips(&own)).chain(others).collect()
}

impl Person {
    /// At least one clip.
    fn from_clips(clips: &[Witness<'_>]) -> Self {
        let plain: Vec<&WalkingEvidence> = clips
            .iter()
            .filter(|clip| clip.file.manner != Manner::Acted)
            .map(|clip| &clip.evidence)
            .collect();
        let is_labelled = clips
            .iter()
            .all(|clip| clip.file.manner != Manner::Unlabelled);
        let manner = if is_labelled {
            Manner::Plain
        } else {
            Manner::Unlabelled
        };
        Self {
            subject: clips[0].file.subject.to_owned(),
            fit: find_fit(&plain, manner),
            paths: clips.iter().map(|clip| clip.file.path.to_owned()).collect(),
        }
    }
}

/// Options under which one of the recordings is read: with its person's skeleton put right where that is known.
pub fn options_of(people: &[Person], path: &Path, options: &RetargetOptions) -> RetargetOptions {
    let person = people
        .iter()
        .find(|person| person.paths.iter().any(|own| own == path));
    let known = person.map(|person| SkeletonFit::Known(person.fit));
    RetargetOptions {
        fit: known.unwrap_or(options.fit),
        ..options.clone()
    }
}
