//! Contacts, events and steps as JSON: output of `footfall contacts`, and format of corrections by hand.
//!
//! Corrections are stored beside the recording (`walk.bvh.labels.json` for `walk.bvh`) and replace the detected contacts
//! in everything that reads recordings.

use crate::contacts::Contacts;
use crate::files;
use crate::steps::Walk;
use footfall_core::{Clip, FrameSpan, GaitEvent, Side};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Frame numbers refer to the file, frame 0 included.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactFile {
    /// Frames per second.
    pub fps: f64,
    /// Number of the file's frames.
    pub frames: usize,
    /// First and last frame of each stance of the left foot.
    pub left: Vec<[usize; 2]>,
    /// First and last frame of each stance of the right foot.
    pub right: Vec<[usize; 2]>,
    /// First and last frame of each time in which neither foot bears; missing where one always does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flight: Vec<[usize; 2]>,
    /// Both ends of each stance, in order.
    pub events: Vec<EventEntry>,
    /// Steps with their place in the walk, in order.
    #[serde(default)]
    pub steps: Vec<StepEntry>,
}

/// Errors of reading a file of contacts.
#[derive(Debug, thiserror::Error)]
pub enum ContactFileError {
    /// It cannot be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        source: io::Error,
    },
    /// It does not hold contacts of the recording.
    #[error("{}: {what}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Its fault.
        what: String,
    },
}

/// One gait event.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct EventEntry {
    /// Frame of the recording.
    pub frame: usize,
    /// The same in seconds.
    pub time_s: f64,
    /// `left` or `right`.
    pub foot: String,
    /// `initial_contact` or `terminal_contact`.
    pub kind: String,
}

/// One step: from `foot`'s initial contact to the frame before the other foot's.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct StepEntry {
    /// `left` or `right`: the foot that carries the body.
    pub foot: String,
    /// First frame.
    pub first: usize,
    /// Last frame.
    pub last: usize,
    /// `first`, `second`, `inside`, `last_but_one` or `last`.
    pub position: String,
    /// Number of the walk in the file, from 0.
    pub walk: usize,
}

impl ContactFile {
    /// Creates a file from detected contacts and steps.
    pub fn new(contacts: &Contacts, walks: &[Walk]) -> Self {
        let stances = Side::BOTH.map(|side| contacts.foot(side).stances.as_slice());
        let report = Self::from_spans(
            contacts.frame_rate_hz,
            contacts.frames,
            stances,
            &contacts.events(),
        );
        report.with_steps(walks)
    }

    /// Creates the same with the steps of these walks.
    #[must_use]
    pub fn with_steps(mut self, walks: &[Walk]) -> Self {
        for (index, walk) in walks.iter().enumerate() {
            self.steps.extend(walk.steps.iter().map(|step| StepEntry {
                foot: step.side.name().to_owned(),
                first: step.first,
                last: step.end - 1,
                position: step.position.name().to_owned(),
                walk: index,
            }));
        }
        self
    }

    /// Creates a file from stances and events, without steps.
    pub fn from_spans(
        fps: f64,
        frames: usize,
        stances: [&[FrameSpan]; 2],
        events: &[GaitEvent],
    ) -> Self {
        let [left, right] =
            stances.map(|spans| spans.iter().map(|span| [span.first, span.last]).collect());
        Self {
            fps,
            frames,
            flight: flights(stances),
            left,
            right,
            events: events
                .iter()
                .map(|event| EventEntry {
                    frame: event.frame,
                    time_s: event.frame as f64 / fps,
                    foot: event.side.name().to_owned(),
                    kind: event.kind.name().to_owned(),
                })
                .collect(),
            steps: Vec::new(),
        }
    }

    /// Returns the path of corrected contacts: beside the recording, under its name.
    pub fn beside(recording: &Path) -> PathBuf {
        let mut name = recording.file_name().unwrap_or_default().to_owned();
        name.push(".labels.json");
        recording.with_file_name(name)
    }

    /// Reads a file and checks that it belongs to a clip.
    ///
    /// # Errors
    /// [`ContactFileError`] names the file and what is wrong with it.
    pub fn read(path: &Path, clip: &Clip) -> Result<Self, ContactFileError> {
        let refuse = |what: String| ContactFileError::Content {
            path: path.to_owned(),
            what,
        };
        let text = fs::read_to_string(path).map_err(|source| ContactFileError::Io {
            path: path.to_owned(),
            source,
        })?;
        let file: Self = serde_json::from_str(&text).map_err(|error| {
            refuse(format!(
                "not what `footfall contacts --json` writes: {error}"
            ))
        })?;
        if file.frames != clip.poses.len() {
            return Err(refuse(format!(
                "has contacts of {} frames, but the recording has {}; detect them again with `footfall contacts`",
                file.frames,
                clip.poses.len()
            )));
        }
        for stances in [&file.left, &file.right] {
            let mut free = 0;
            for &[first, last] in stances {
                if first > last || last >= file.frames {
                    return Err(refuse(format!(
                        "the stance [{first}, {last}] does not lie within {} frames",
                        file.frames
                    )));
                }
                if first < free {
                    return Err(refuse(format!(
                        "the stance [{first}, {last}] begins before the one before it has ended; stances come in order"
                    )));
                }
                free = last + 1;
            }
        }
        Ok(file)
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// [`ContactFileError::Io`] names the file.
    pub fn write(&self, path: &Path) -> Result<(), ContactFileError> {
        let io_error = |source| ContactFileError::Io {
            path: path.to_owned(),
            source,
        };
        let mut text = serde_json::to_string(self).map_err(|error| io_error(error.into()))?;
        text.push('\n');
        files::write_atomic(path, text.as_bytes()).map_err(io_error)
    }

    /// Stances of the left and of the right foot.
    pub fn stances(&self) -> [Vec<FrameSpan>; 2] {
        [&self.left, &self.right].map(|spans| {
            spans
                .iter()
                .map(|&[first, last]| FrameSpan { first, last })
                .collect()
        })
    }
}
/// The frames between contacts in which neither foot bears. What comes before the first and after the last is no flight that was seen.
fn flights(stances: [&[FrameSpan]; 2]) -> Vec<[usize; 2]> {
    let mut flights: Vec<[usize; 2]> = Vec::new();
    let mut spans: Vec<&FrameSpan> = stances.into_iter().flatten().collect();
    spans.sort_by_key(|span| span.first);
    let mut borne_until = 0;
    for span in spans {
        if span.first > borne_until && borne_until > 0 {
            flights.push([borne_until, span.first - 1]);
        }
        borne_until = borne_until.max(span.last + 1);
    }
    flights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_lie_between_contacts() {
        let span = |first, last| FrameSpan { first, last };
        let left = [span(0, 10), span(30, 40)];
        let right = [span(8, 20), span(26, 28), span(50, 60)];
        let flights = flights([&left, &right]);
        assert_eq!(flights, [[21, 25], [29, 29], [41, 49]]);
    }
}
