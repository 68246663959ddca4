//! Contacts, events and steps as JSON: what `contacts` prints, `synth --contacts` writes and `sheet --contacts` reads.

use anyhow::{Context as _, Result, ensure};
use footfall_core::{Clip, FrameSpan, GaitEvent, Side};
use footfall_motion::contacts::Contacts;
use footfall_motion::steps::Walk;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// Frame numbers refer to the file, frame 0 included.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ContactReport {
    /// Frames per second.
    pub(crate) fps: f64,
    /// How many frames the file has.
    pub(crate) frames: usize,
    /// First and last frame of each stance of the left foot.
    pub(crate) left: Vec<[usize; 2]>,
    /// First and last frame of each stance of the right foot.
    pub(crate) right: Vec<[usize; 2]>,
    /// Both ends of each stance, in order.
    pub(crate) events: Vec<EventEntry>,
    /// Steps with their place in the walk, in order.
    #[serde(default)]
    pub(crate) steps: Vec<StepEntry>,
}

/// One gait event.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct EventEntry {
    pub(crate) frame: usize,
    pub(crate) time_s: f64,
    /// `left` or `right`.
    pub(crate) foot: String,
    /// `initial_contact` or `terminal_contact`.
    pub(crate) kind: String,
}

/// One step: from `foot`'s initial contact to the frame before the other foot's.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct StepEntry {
    /// `left` or `right`: the foot that carries the body.
    pub(crate) foot: String,
    pub(crate) first: usize,
    pub(crate) last: usize,
    /// `first`, `second`, `inside`, `last_but_one` or `last`.
    pub(crate) position: String,
    /// Which walk of the file, from 0.
    pub(crate) walk: usize,
}

impl ContactReport {
    /// From detected contacts and steps.
    pub(crate) fn new(contacts: &Contacts, walks: &[Walk]) -> Self {
        let stances = Side::BOTH.map(|side| contacts.foot(side).stances.as_slice());
        let report = Self::from_spans(
            contacts.frame_rate_hz,
            contacts.frames,
            stances,
            &contacts.events(),
        );
        report.with_steps(walks)
    }

    /// The same with the steps of these walks.
    pub(crate) fn with_steps(mut self, walks: &[Walk]) -> Self {
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

    /// From stances and events, without steps.
    pub(crate) fn from_spans(
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

    /// Reads a file and checks that it belongs to a clip.
    pub(crate) fn read(path: &Path, clip: &Clip) -> Result<Self> {
        let text = fs::read_to_string(path)
            .with_context(|| format!("{}: cannot read the contacts", path.display()))?;
        let report: Self = serde_json::from_str(&text).with_context(|| {
            format!(
                "{}: not what `footfall contacts --json` writes",
                path.display()
            )
        })?;
        ensure!(
            report.frames == clip.poses.len(),
            "{}: has contacts of {} frames, but the recording has {}; make them anew with `footfall contacts`",
            path.display(),
            report.frames,
            clip.poses.len()
        );
        for [first, last] in report.left.iter().chain(&report.right) {
            ensure!(
                first <= last && *last < report.frames,
                "{}: the stance [{first}, {last}] does not lie within {} frames",
                path.display(),
                report.frames
            );
        }
        Ok(report)
    }

    /// Stances of the left and of the right foot.
    pub(crate) fn stances(&self) -> [Vec<FrameSpan>; 2] {
        [&self.left, &self.right].map(|spans| {
            spans
                .iter()
                .map(|&[first, last]| FrameSpan { first, last })
                .collect()
        })
    }
}
