//! Offline: training of models on a corpus of walks.
//!
//! Modules in suggested reading order: [`train`] (all steps of training in one function), [`dataset`] and [`sequence`] (training
//! data), [`normalise`], [`average`] (the hidden semi-Markov model), [`differences`] (speed, walkers and steps), [`contexts`] (the ends of a walk);
//! [`adapt`] (a style from a dozen steps); [`dynamics`] (switching models); [`imu`] (sensor models); [`standing`], [`jumping`] and [`crouching`]; [`recordings`], [`model_file`] (input of tools) and [`job`] (background work for windows); and [`evaluate`], which evaluates the results.

pub mod adapt;
mod arm_swing;
pub mod average;
mod average_body;
mod averages;
mod beside;
pub mod contexts;
pub mod crouching;
pub mod dataset;
pub mod differences;
pub mod dynamics;
mod encoded;
pub mod error;
pub mod evaluate;
pub mod fine_motion;
pub mod imu;
pub mod job;
pub mod jumping;
mod level_heads;
pub mod model_file;
pub mod normalise;
pub mod progress;
pub mod recordings;
mod running;
pub mod sequence;
pub mod standing;
mod step_hsmm;
pub mod train;
pub mod training_comparison;
mod trunk_pitch;
pub mod walker_adaptive;

pub use adapt::{AdaptConfig, AdaptMethod, Adapted, adapt_style, shows_steps};
pub use average::EmConfig;
pub use contexts::ContextReport;
pub use error::TrainError;
pub use model_file::{ReadModelError, read_model_file};
pub use progress::Progress;
pub use recordings::read_recordings;
pub use running::learn_running;
pub use train::{TrainConfig, Trained, train_average};
pub use training_comparison::{HeldOutWalker, TrainingComparison, compare_training};
