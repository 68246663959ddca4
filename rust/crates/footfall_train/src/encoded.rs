//! A corpus that is encoded once, and the parts of it that are trained on.

use crate::dataset::{EncodeConfig, EncodedRecording};
use crate::error::TrainError;
use crate::sequence::Sequence;
use crate::train::TrainConfig;
use footfall_core::{Clip, StepPosition};
use footfall_motion::recording::Recording;
use footfall_motion::steps::{Step, Walk};
use rayon::prelude::*;

/// A foot that walks has come to rest so long after its initial contact, seconds: captured ankles go on at 0.9 m/s then and at 0.4 m/s by this time, as fast as a
/// foot rolls that stands on its heel. A step that was cut at the contact would stop the foot at once, and bend the knee by 7° in a frame where people's bend by 3°.
const REST_SECS: f64 = 0.025;

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
            let cut = |walk| cut_at_rest(part(walk), recording.clip());
            let walks: Vec<Walk> = recording.walks.iter().map(cut).collect();
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

/// The same walk, its steps cut where the foot that has landed is at rest; who falls onto a foot bears on it at once.
fn cut_at_rest(mut walk: Walk, clip: &Clip) -> Walk {
    let rest = (REST_SECS * clip.frame_rate_hz).round() as usize;
    let last = clip.poses.len().saturating_sub(1);
    let mut falls = walk.steps.first().is_some_and(Step::flies);
    for step in &mut walk.steps {
        let lands = |frame: usize, falls: bool| {
            let rest = if falls { 0 } else { rest };
            (frame + rest).min(last.max(frame))
        };
        step.first = lands(step.first, falls);
        falls = step.flies();
        step.end = lands(step.end, falls);
        step.other_terminal = step.other_terminal.map(|frame| frame.max(step.first));
    }
    walk
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

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Side, Skeleton};

    #[test]
    fn steps_are_cut_at_rest_but_not_where_the_body_falls_onto_a_foot() {
        let skeleton = Skeleton::standard();
        let clip = Clip {
            frame_rate_hz: 120.0,
            poses: vec![Pose::rest(&skeleton); 300],
            skeleton,
        };
        let ends = [(0, 60), (60, 120), (120, 180), (180, 299)];
        let steps = ends.into_iter().zip([Side::Left, Side::Right].repeat(2));
        let mut steps: Vec<Step> = steps
            .map(|((first, end), side)| Step::inside(side, first, end))
            .collect();
        steps[0].other_terminal = Some(1);
        steps[1].take_off = Some(110);
        let cut = cut_at_rest(Walk { steps }, &clip).steps;
        let ends: Vec<_> = cut.iter().map(|step| (step.first, step.end)).collect();
        // The second step ends in flight, and the last one with the clip.
        assert_eq!(ends, [(3, 63), (63, 120), (120, 183), (183, 299)]);
        assert_eq!(cut[0].other_terminal, Some(3));
    }
}
