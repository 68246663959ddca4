//! Making a style of recordings, on a thread of its own.

use super::clip_source::Clip;
use footfall_model::{GaitModel, GaitStyle, Provenance};
use footfall_motion::files::write_atomic;
use footfall_train::Recordings;
use footfall_train::TrainError;
use footfall_train::job::{Job, Reporter};
use std::path::PathBuf;
use std::sync::Arc;

/// What to make.
pub(super) struct Order {
    /// The walk that is adapted.
    pub(super) base: Arc<GaitModel>,
    /// Recordings of the style.
    pub(super) recordings: Vec<Clip>,
    /// What the style is called.
    pub(super) name: String,
    /// How many steps are taken from them at most.
    pub(super) steps: usize,
    /// Where it is written.
    pub(super) file: PathBuf,
}

/// A style that was made and written.
pub(super) struct Made {
    pub(super) base: Arc<GaitModel>,
    pub(super) style: Arc<GaitStyle>,
}

impl Order {
    /// Starts to make it.
    pub(super) fn start(self) -> Job<Result<Made, String>> {
        // The dock looks for news in every frame.
        let wake = || {};
        Job::start("making a style", wake, move |reporter| self.make(reporter))
    }

    fn make(self, reporter: &mut Reporter) -> Result<Made, String> {
        let message = |error: TrainError| error.to_string();
        let count = self.recordings.len();
        let mut read = Recordings::default();
        for (done, clip) in self.recordings.iter().enumerate() {
            if reporter.tell("reading", done, count).is_break() {
                return Err(TrainError::Cancelled.to_string());
            }
            read.0.push((self.name.clone(), clip.read()?));
        }
        let made_from = Provenance {
            corpus: "recordings chosen in the Godot editor".to_owned(),
            terms: "not stated".to_owned(),
            command: "the style dock of the Footfall add-on".to_owned(),
            ..Provenance::default()
        };
        let adapted = read
            .adapt(&self.base, &self.name, self.steps, made_from, reporter)
            .map_err(message)?;
        // Whoever cancelled by now wants no file.
        if reporter.tell("writing", 0, 1).is_break() {
            return Err(TrainError::Cancelled.to_string());
        }
        let bytes = adapted
            .style
            .to_bytes()
            .map_err(|error| error.to_string())?;
        if let Some(folder) = self.file.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        write_atomic(&self.file, &bytes)
            .map_err(|error| format!("{}: {error}", self.file.display()))?;
        Ok(Made {
            base: self.base,
            style: Arc::new(adapted.style),
        })
    }
}
