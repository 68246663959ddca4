//! Offline: a corpus of walks becomes a model.
//!
//! Modules in suggested reading order: [`sequence`] (what is trained on), [`average`] (the hidden semi-Markov model),
//! [`differences`] (speed, walkers and steps).

pub mod average;
pub mod differences;
pub mod error;
pub mod progress;
pub mod sequence;

pub use error::TrainError;
pub use progress::Progress;
