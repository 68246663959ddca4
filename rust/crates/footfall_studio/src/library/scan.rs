//! Finding and checking recordings.

use super::{Entry, Facts};
use crate::job::{self, Job};
use crate::motion::Motion;
use eframe::egui::Context;
use footfall_motion::corpus::read_index;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};

/// Folders in folders are looked into this deep.
const MOST_DEPTH: usize = 8;

/// Events of a scan.
pub(super) enum ScanEvent {
    /// A recording is there.
    Found(PathBuf, Entry),
    /// It was read.
    Read(PathBuf, Result<Facts, String>),
}

/// A scan on its way.
pub(super) struct Scan {
    receiver: Receiver<ScanEvent>,
    job: Job<()>,
    ended: bool,
}

impl Scan {
    pub(super) fn start(context: &Context, path: PathBuf) -> Self {
        let (sender, receiver) = mpsc::channel();
        let waker = context.clone();
        let job = job::start(context, "looking for recordings", move |reporter| {
            let found = find(&path);
            for (path, entry) in &found {
                drop(sender.send(ScanEvent::Found(path.clone(), entry.clone())));
            }
            waker.request_repaint();
            let total = found.len();
            let read = std::sync::atomic::AtomicUsize::new(0);
            let check = |sender: &mut Sender<ScanEvent>, path: &PathBuf| {
                let facts = Motion::read(path)
                    .map(|motion| Facts::of(&motion))
                    .map_err(|error| error.to_string());
                drop(sender.send(ScanEvent::Read(path.clone(), facts)));
                let done = read.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
                reporter
                    .report("checking recordings", done, total)
                    .is_continue()
            };
            let unread: Vec<&PathBuf> = found
                .iter()
                .filter(|(_, entry)| entry.facts.is_none())
                .map(|(path, _)| path)
                .collect();
            // Each on its own: one that is broken is listed with its error.
            let _is_whole = unread
                .into_par_iter()
                .map_with(sender.clone(), check)
                .all(|goes_on| goes_on);
        });
        Self {
            receiver,
            job,
            ended: false,
        }
    }

    pub(super) fn events(&mut self) -> Vec<ScanEvent> {
        // Asked before the events are taken: what came until then is among them.
        self.ended = self.job.poll().is_some();
        self.receiver.try_iter().collect()
    }

    pub(super) const fn has_ended(&self) -> bool {
        self.ended
    }
}

fn find(path: &Path) -> BTreeMap<PathBuf, Entry> {
    let mut found = BTreeMap::new();
    if path.is_dir() {
        walk(path, 0, &mut found);
        describe(&path.join("index.csv"), &mut found);
    } else if path.file_name().is_some_and(|name| name == "index.csv") {
        let folder = path.parent().unwrap_or(Path::new("."));
        walk(folder, 0, &mut found);
        describe(path, &mut found);
    } else {
        found.insert(path.to_owned(), entry(path));
    }
    found
}

fn walk(folder: &Path, depth: usize, found: &mut BTreeMap<PathBuf, Entry>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        let mut broken = entry(folder);
        broken.facts = Some(Err(format!("{}: cannot be read", folder.display())));
        found.insert(folder.to_owned(), broken);
        return;
    };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() && depth < MOST_DEPTH {
            walk(&path, depth + 1, found);
        } else if path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("bvh"))
        {
            let entry = entry(&path);
            found.insert(path, entry);
        }
    }
}

pub(super) fn entry(path: &Path) -> Entry {
    let name = |path: &Path| {
        path.file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    };
    Entry {
        name: name(path),
        category: path.parent().map_or_else(String::new, name),
        subject: String::new(),
        facts: None,
    }
}

/// An index says what its recordings show.
fn describe(index: &Path, found: &mut BTreeMap<PathBuf, Entry>) {
    let Ok(rows) = read_index(index) else { return };
    for row in rows {
        if let Some(entry) = found.get_mut(&row.path) {
            row.category().clone_into(&mut entry.category);
            row.subject().clone_into(&mut entry.subject);
        }
    }
}
