//! Making a style of recordings, on a thread of its own.

use super::clip_source::Clip;
use footfall_model::{GaitModel, GaitStyle, Provenance};
use footfall_motion::files::write_atomic;
use footfall_motion::recording::Recording;
use footfall_train::job::{Job, Reporter};
use footfall_train::{AdaptConfig, Progress, TrainError, adapt_style, shows_steps};
use std::path::PathBuf;
use std::sync::Arc;

/// Order for a style.
pub(super) struct Order {
    /// The walk that is adapted.
    pub(super) base: Arc<GaitModel>,
    /// Recordings of the style.
    pub(super) recordings: Vec<Clip>,
    /// Name of the style.
    pub(super) name: String,
    /// Largest number of steps to take from them.
    pub(super) steps: usize,
    /// File that the style is written to.
    pub(super) file: PathBuf,
}

/// A style that was made and written.
pub(super) struct Made {
    pub(super) base: Arc<GaitModel>,
    pub(super) style: Arc<GaitStyle>,
    /// Remarks about it, empty when all is well.
    pub(super) remarks: String,
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
        let walks = Walks::read(&self.recordings, &self.name, reporter)?;
        let made_from = Provenance {
            corpus: "recordings chosen in the Godot editor".to_owned(),
            terms: "not stated".to_owned(),
            command: "the style dock of the Footfall add-on".to_owned(),
            ..Provenance::default()
        };
        let config = AdaptConfig::first_steps(self.steps);
        let recordings = &walks.recordings;
        let adapted = adapt_style(
            &self.base, recordings, &self.name, &config, made_from, reporter,
        )
        .map_err(message)?;
        // After a cancellation no file is written.
        if reporter.report("writing", 0, 1).is_break() {
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
            remarks: walks.remarks(&adapted.style),
            style: Arc::new(adapted.style),
        })
    }
}

/// Clips with a walk.
#[derive(Default)]
pub(super) struct Walks {
    pub(super) recordings: Vec<Recording>,
    /// Labels and lengths of the clips without a walk.
    left_out: Vec<String>,
}

impl Walks {
    /// Reads clips of `walker`.
    ///
    /// # Errors
    /// Names the clip that cannot be read; all clips if none holds a walk.
    pub(super) fn read(
        clips: &[Clip],
        walker: &str,
        progress: &mut dyn Progress,
    ) -> Result<Self, String> {
        let mut walks = Self::default();
        for (done, clip) in clips.iter().enumerate() {
            if progress.advance("reading", done, clips.len()).is_break() {
                return Err(TrainError::Cancelled.to_string());
            }
            let recording = clip.read()?;
            if shows_steps(&recording.walks) {
                walks.recordings.push(recording.of_subject(walker));
            } else {
                let secs = recording.round_secs();
                walks
                    .left_out
                    .push(format!("{} ({secs:.1} s)", clip.label()));
            }
        }
        if walks.recordings.is_empty() && !walks.left_out.is_empty() {
            return Err(format!(
                "{} has no two consecutive steps. Choose walking clips with steps of both feet.",
                walks.left_out.join(", ")
            ));
        }
        Ok(walks)
    }

    /// Remarks about the style that was made of them.
    pub(super) fn remarks(&self, style: &GaitStyle) -> String {
        let thin = style
            .thin_warning()
            .map(|warning| format!("A thin style: {warning}."));
        let left_out = (!self.left_out.is_empty()).then(|| {
            format!(
                "Skipped without two consecutive steps: {}.",
                self.left_out.join(", ")
            )
        });
        let remarks: Vec<String> = thin.into_iter().chain(left_out).collect();
        remarks.join(" ")
    }
}
