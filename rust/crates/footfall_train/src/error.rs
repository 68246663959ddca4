//! Errors of training.

use footfall_core::{Side, Site, SkeletonError};
use footfall_model::ModelError;
use footfall_motion::recording::RecordingError;
use footfall_prob::ProbError;
use std::path::PathBuf;

/// Errors of training.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// No clip has a usable step.
    #[error("no clip has two consecutive steps; select walks with `--where category=…`")]
    NoSteps,
    /// Nothing was chosen to learn from.
    #[error("no recordings are selected; open or tick some")]
    NoRecordings,
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A model cannot be fitted to one of several recordings.
    #[error("{}: {error}", path.display())]
    Fit {
        /// The recording.
        path: PathBuf,
        /// Fault.
        error: Box<Self>,
    },
    /// Fewer steps in a row than show both feet.
    #[error(
        "{found} steps are too few for a style: it needs two consecutive steps, better six to twelve; use longer walks"
    )]
    TooFewSteps {
        /// Number found.
        found: usize,
    },
    /// A body has a leg or a foot without length.
    #[error("the body cannot be reconstructed: {0}")]
    Skeleton(#[from] SkeletonError),
    /// The base model, or what came of it, makes no sense.
    #[error("the model cannot be used: {0}")]
    Model(#[from] ModelError),
    /// Only one foot was seen stepping.
    #[error("the corpus has no step that begins with the {} foot; add walks of several steps", side.name())]
    MissingSide {
        /// The foot that is missing.
        side: Side,
    },
    /// A step is shorter than the states that must explain it.
    #[error("a step of {frames} frames is too short; train at a higher --fps")]
    StepTooShort {
        /// Frames of the step.
        frames: usize,
    },
    /// The frame rate is not usable.
    #[error("{frame_rate_hz} fps is not a frame rate for training; use 20 to 240")]
    FrameRate {
        /// Value that was asked for.
        frame_rate_hz: f64,
    },
    /// A number of sensors that no model has.
    #[error("{found} sensors are not supported; give one site or two")]
    Sensors {
        /// Value that was asked for.
        found: usize,
    },
    /// Nothing moves long enough, or there is too much.
    #[error("the clips have {found} frames; a sensor model needs 1 to 2000000")]
    ImuFrames {
        /// Number found.
        found: usize,
    },
    /// A sensor's recording that is not of the clip it was given for.
    #[error(
        "no part of the recording moves like the {} of the clip (best correlation {correlation:.2}); give a recording of a sensor worn there that covers the whole clip of a second or more",
        site.name()
    )]
    Unsynchronised {
        /// Site at which the sensor should have been.
        site: Site,
        /// The best that was found.
        correlation: f64,
    },
    /// The caller cancelled the work.
    #[error("cancelled; nothing was written")]
    Cancelled,
    /// Inference failed.
    #[error("the model cannot explain the walk: {0}")]
    Inference(#[from] ProbError),
}
