//! Opened files and folders of recordings, each checked in the background.

mod list;
mod scan;

use crate::motion::Motion;
use eframe::egui::Context;
use scan::{Scan, ScanEvent};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Facts about a recording, for the list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Facts {
    pub(crate) frames: usize,
    pub(crate) rate_hz: f64,
    /// Steps in all its walks.
    pub(crate) steps: usize,
    /// The skeleton that it was recorded on.
    pub(crate) skeleton: String,
    /// True when contacts were corrected by hand.
    pub(crate) is_corrected: bool,
}

impl Facts {
    pub(crate) fn of(motion: &Motion) -> Self {
        Self {
            frames: motion.clip().poses.len(),
            rate_hz: motion.clip().frame_rate_hz,
            steps: motion.recording.step_count(),
            skeleton: motion.recording.retargeted.report.map.clone(),
            is_corrected: motion.recording.is_corrected,
        }
    }
}

/// A recording in the list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) name: String,
    /// The index's category, else the folder's name.
    pub(crate) category: String,
    /// The index's subject, else empty.
    pub(crate) subject: String,
    /// `None` until it was read; an error names file and line.
    pub(crate) facts: Option<Result<Facts, String>>,
}

/// Everything that was opened.
#[derive(Default)]
pub(crate) struct Library {
    entries: BTreeMap<PathBuf, Entry>,
    scans: Vec<Scan>,
    search: String,
    category: Option<String>,
    ticked: BTreeSet<PathBuf>,
}

/// Actions of a user on the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ListAction {
    /// Look at this one.
    Open(PathBuf),
    /// Show this one as a ghost beside the other.
    Compare(PathBuf),
}

impl Library {
    /// Adds a file, or all BVH files of a folder and the folders in it.
    pub(crate) fn open(&mut self, context: &Context, path: &Path) {
        self.scans.push(Scan::start(context, path.to_owned()));
    }

    /// Adds a file that another thread reads; [`update`](Self::update) sets its content.
    pub(crate) fn add(&mut self, path: &Path) {
        let entry = scan::entry(path);
        self.entries.entry(path.to_owned()).or_insert(entry);
    }

    /// Takes what the scans found.
    pub(crate) fn poll(&mut self) {
        for scan in &mut self.scans {
            for event in scan.events() {
                match event {
                    ScanEvent::Found(path, entry) => {
                        self.entries.entry(path).or_insert(entry);
                    }
                    ScanEvent::Read(path, facts) => {
                        if let Some(entry) = self.entries.get_mut(&path) {
                            entry.facts = Some(facts);
                        }
                    }
                }
            }
        }
        self.scans.retain(|scan| !scan.has_ended());
    }

    pub(crate) fn is_busy(&self) -> bool {
        !self.scans.is_empty()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Updates the facts of a file after it was looked at or corrected.
    pub(crate) fn update(&mut self, path: &Path, facts: Result<Facts, String>) {
        if let Some(entry) = self.entries.get_mut(path) {
            entry.facts = Some(facts);
        }
    }

    /// The recordings that are ticked and can be used, or all that can when none is ticked.
    pub(crate) fn chosen(&self) -> Vec<(&PathBuf, &Entry)> {
        let usable = |(path, entry): &(&PathBuf, &Entry)| {
            let is_wanted = self.ticked.is_empty() || self.ticked.contains(*path);
            is_wanted && !matches!(entry.facts, Some(Err(_)))
        };
        self.entries.iter().filter(usable).collect()
    }

    /// Number of ticked recordings.
    pub(crate) fn ticked(&self) -> usize {
        self.ticked.len()
    }
}
