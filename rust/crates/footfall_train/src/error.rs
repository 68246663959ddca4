//! Why training cannot go on.

use footfall_core::{Side, Site, SkeletonError};
use footfall_model::ModelError;
use footfall_motion::recording::RecordingError;
use footfall_prob::ProbError;
use std::path::PathBuf;

/// Why training cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// No clip has a usable step.
    #[error("no clip holds two steps in a row; choose walks with `--where category=…`")]
    NoSteps,
    /// Nothing was chosen to learn from.
    #[error("no recordings; open some, or tick those to use")]
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
        "{found} steps are too few for a style, which needs two in a row and is better with six to twelve; choose longer walks"
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
    #[error("a frame rate of {frame_rate_hz} fps cannot be trained at; use 20 to 240")]
    FrameRate {
        /// Value that was asked for.
        frame_rate_hz: f64,
    },
    /// A number of sensors that no model has.
    #[error("{found} sensors cannot be trained on; name one site or two")]
    Sensors {
        /// Value that was asked for.
        found: usize,
    },
    /// Nothing moves long enough, or there is too much.
    #[error("the clips have {found} frames for a sensor model; choose between 1 and 2000000")]
    ImuFrames {
        /// Number found.
        found: usize,
    },
    /// A sensor's recording that is not of the clip it was given for.
    #[error(
        "no part of the recording moves as the {} of the clip does (correlation {correlation:.2} at best): it must be worn there, and hold the whole clip of a second or more",
        site.name()
    )]
    Unsynchronised {
        /// Site at which the sensor should have been.
        site: Site,
        /// The best that was found.
        correlation: f64,
    },
    /// Whoever asked for the work asked it to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
    /// Inference failed.
    #[error("the walk cannot be explained by the model: {0}")]
    Inference(#[from] ProbError),
}
