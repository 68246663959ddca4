//! Labels that were not saved when the studio ended, kept to be offered again.

use footfall_core::FrameSpan;
use serde::{Deserialize, Serialize};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};

/// Unsaved labels of a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct UnsavedLabels {
    /// The recording.
    pub(crate) recording: PathBuf,
    frames: usize,
    /// First and last frame of each stance, left and right.
    stances: [Vec<[usize; 2]>; 2],
}

impl UnsavedLabels {
    pub(crate) fn new(recording: &Path, frames: usize, stances: &[Vec<FrameSpan>; 2]) -> Self {
        let pairs = |spans: &Vec<FrameSpan>| -> Vec<[usize; 2]> {
            spans.iter().map(|span| [span.first, span.last]).collect()
        };
        Self {
            recording: recording.to_owned(),
            frames,
            stances: [pairs(&stances[0]), pairs(&stances[1])],
        }
    }

    /// The stances, if the recording still has as many frames and they lie within it.
    pub(crate) fn stances(&self, frames: usize) -> Option<[Vec<FrameSpan>; 2]> {
        if self.frames != frames {
            return None;
        }
        let mut found = [Vec::new(), Vec::new()];
        for (spans, pairs) in found.iter_mut().zip(&self.stances) {
            let mut free = 0;
            for &[first, last] in pairs {
                if first < free || first > last || last >= frames {
                    return None;
                }
                free = last + 1;
                spans.push(FrameSpan { first, last });
            }
        }
        Some(found)
    }
}

fn file_of(folder: &Path, recording: &Path) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    recording.hash(&mut hasher);
    folder.join(format!("unsaved-{:016x}.json", hasher.finish()))
}

/// Keeps labels until they are [forgotten](forget).
pub(crate) fn keep(folder: &Path, kept: &UnsavedLabels) -> Result<(), String> {
    let file = file_of(folder, &kept.recording);
    let text = serde_json::to_vec(kept).map_err(|error| error.to_string())?;
    std::fs::create_dir_all(folder)
        .and_then(|()| footfall_motion::files::write_atomic(&file, &text))
        .map_err(|error| {
            format!(
                "{}: cannot save the recovery file of unsaved labels: {error}",
                file.display()
            )
        })
}

/// Forgets what was kept of a recording.
pub(crate) fn forget(folder: &Path, recording: &Path) {
    // What is not there needs no forgetting.
    drop(std::fs::remove_file(file_of(folder, recording)));
}

/// Everything that was kept; files that make no sense are passed over.
pub(crate) fn read_all(folder: &Path) -> Vec<UnsavedLabels> {
    let Ok(files) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut kept: Vec<UnsavedLabels> = files
        .flatten()
        .filter(|file| file.file_name().to_string_lossy().starts_with("unsaved-"))
        .filter_map(|file| std::fs::read(file.path()).ok())
        .filter_map(|bytes| serde_json::from_slice(&bytes).ok())
        .collect();
    kept.sort_by(|a, b| a.recording.cmp(&b.recording));
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_until_it_is_forgotten() {
        let folder = tempfile::tempdir().unwrap();
        let recording = Path::new("walk.bvh");
        let stances = [vec![FrameSpan { first: 2, last: 9 }], Vec::new()];
        let kept = UnsavedLabels::new(recording, 20, &stances);
        keep(folder.path(), &kept).unwrap();
        std::fs::write(folder.path().join("unsaved-x.json"), "{").unwrap();
        assert_eq!(read_all(folder.path()), std::slice::from_ref(&kept));
        assert_eq!(kept.stances(20), Some(stances));
        assert_eq!(kept.stances(21), None, "the recording has changed");
        forget(folder.path(), recording);
        assert!(read_all(folder.path()).is_empty());
    }
}
