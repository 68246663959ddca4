//! A corpus that is encoded once, and the parts of it that are trained on.

use crate::dataset::{EncodeConfig, EncodedRecording};
use crate::error::TrainError;
use crate::sequence::Sequence;
use crate::train::TrainConfig;
use footfall_core::StepPosition;
use footfall_motion::recording::Recording;
use footfall_motion::steps::Walk;
use rayon::prelude::*;

/// Number of recordings, people and steps in sequences, mirrored ones left out.
pub(crate) struct Counts {
    pub(crate) clips: usize,
    pub(crate) subjects: usize,
    pub(crate) steps: usize,
}

/// Encoded recordings: those whose walks are steady throughout first, then those that show an end.
///
/// Walkers have numbers in this order, so that one has the same number in every part. A mirrored walk has the walker after its own.
pub(crate) struct EncodedCorpus<'a> {
    recordings: Vec<EncodedRecording<'a>>,
    steady: usize,
    mirror: bool,
}

impl<'a> EncodedCorpus<'a> {
    /// Encodes all recordings, in parallel.
    ///
    /// # Errors
    /// As [`EncodedRecording::of`].
    pub(crate) fn of(clips: &'a [Recording], config: &TrainConfig) -> Result<Self, TrainError> {
        let encoding = EncodeConfig {
            frame_rate_hz: config.frame_rate_hz,
            windows: config.windows,
        };
        let (steady, edges): (Vec<_>, Vec<_>) = clips.iter().partition(|clip| is_steady(clip));
        let recordings = [steady.as_slice(), &edges].concat();
        Ok(Self {
            recordings: recordings
                .into_par_iter()
                .map(|recording| EncodedRecording::of(recording, &encoding))
                .collect::<Result<_, _>>()?,
            steady: steady.len(),
            mirror: config.mirror,
        })
    }

    /// The steady walks.
    ///
    /// A recording that shows how a walk starts or ends is short of steady steps: it teaches the ends, and only where there is no
    /// other also the middle.
    pub(crate) fn steady(&self) -> (Vec<Sequence>, Counts) {
        let (steady, edges) = self.recordings.split_at(self.steady);
        let found = self.sequences(steady, Clone::clone);
        if found.0.is_empty() {
            return self.sequences(edges, steady_part);
        }
        found
    }

    /// A part of all walks.
    pub(crate) fn all(&self, part: fn(&Walk) -> Walk) -> (Vec<Sequence>, Counts) {
        self.sequences(&self.recordings, part)
    }

    /// The recordings that show every step once.
    pub(crate) fn distinct(mut self) -> Self {
        self.recordings
            .retain(|encoded| encoded.recording().repeats() == 1);
        let is_steady = |encoded: &EncodedRecording<'_>| is_steady(encoded.recording());
        self.steady = self.recordings.iter().filter(|one| is_steady(one)).count();
        self
    }

    /// The part of every walk that `part` cuts out, and its mirror image if the settings ask for it.
    fn sequences(
        &self,
        recordings: &[EncodedRecording<'_>],
        part: fn(&Walk) -> Walk,
    ) -> (Vec<Sequence>, Counts) {
        let mut subjects: Vec<&str> = Vec::new();
        let mut corpus = Vec::new();
        let mut used = 0;
        for encoded in recordings {
            let recording = encoded.recording();
            let walker = number_of(recording.subject(), &mut subjects);
            let walks: Vec<Walk> = recording.walks.iter().map(part).collect();
            let sequences = encoded.walks(&walks, 2 * walker);
            used += usize::from(!sequences.is_empty());
            for sequence in sequences {
                if self.mirror {
                    corpus.push(sequence.mirrored(2 * walker + 1));
                }
                corpus.push(sequence);
            }
        }
        let original = corpus.iter().filter(|sequence| sequence.walker % 2 == 0);
        let counts = Counts {
            clips: used,
            subjects: subjects.len(),
            steps: original.map(|sequence| sequence.steps.len()).sum(),
        };
        (corpus, counts)
    }
}

/// Place of a subject among those seen so far, the last for a new one.
pub(crate) fn number_of<'a>(subject: &'a str, seen: &mut Vec<&'a str>) -> usize {
    seen.iter()
        .position(|known| *known == subject)
        .unwrap_or_else(|| {
            seen.push(subject);
            seen.len() - 1
        })
}

/// Returns true when no walk of a recording starts or stops.
fn is_steady(recording: &Recording) -> bool {
    let is_steady = |walk: &Walk| steady_part(walk).steps.len() == walk.steps.len();
    recording.walks.iter().all(is_steady)
}

/// A walk without the steps in which it starts and stops.
pub(crate) fn steady_part(walk: &Walk) -> Walk {
    let is_edge = |position| matches!(position, StepPosition::First | StepPosition::Last);
    Walk {
        steps: walk
            .steps
            .iter()
            .filter(|step| !is_edge(step.position))
            .copied()
            .collect(),
    }
}
