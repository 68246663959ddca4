//! Errors of generating a walk.

use footfall_core::SkeletonError;
use footfall_model::{ModelError, StyleError};
use footfall_prob::ProbError;

/// Errors of generating a walk.
#[derive(Debug, thiserror::Error)]
pub enum SynthError {
    /// The model's content is invalid.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A style does not fit the model.
    #[error(transparent)]
    Style(#[from] StyleError),
    /// The body cannot walk.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
    /// A setting is not finite.
    #[error("{setting} is {value}; give a finite number")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f32,
    },
    /// The model gives no trajectory.
    #[error("the model gives no trajectory: {0}; train it again with `footfall train`")]
    Inference(#[from] ProbError),
}
