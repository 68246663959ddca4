//! Runtime: what one or two inertial sensors measure becomes a body (Mousas 2017).
//!
//! Modules in the order in which data flows: [`prepared`] lays a model out for the loop that reads it, `sensor` makes frames of samples, unless a [`problem`] with them or with how it is worn (`watch`, `wear`) speaks against it, [`tracker`] tells how probable each of
//! its frames is, [`body`] is what they say in the mean, `confidence` how well they say it, [`blend`] keeps it continuous, [`ground`] moves it, in steps as long as the wearer's (`travel`), and keeps
//! its feet in place.
//! [`mounting`] finds how a sensor is worn, [`mod@examine`] whether it is worn where it should be; [`reconstructor`] is all of it for samples as they come, with a `calibration` to keep, [`recording`] for a recording as a whole.
//! [`Published`] names what the paper does otherwise, to compare.

pub mod blend;
pub mod body;
mod calibration;
mod confidence;
pub mod examine;
pub mod ground;
pub mod guide;
mod half_life;
mod kernels;
mod measure;
pub mod mounting;
pub mod prepared;
pub mod problem;
mod published;
pub mod reconstructor;
pub mod recording;
mod sensor;
mod shown_behaviour;
pub mod tracker;
mod travel;
mod watch;
mod wear;

pub use blend::Blending;
pub use body::{BodyFrame, Course};
pub use examine::{Examination, examine, find_exchange};
pub use guide::{CalibrationGuide, GuideStep};
pub use mounting::{Mounting, MountingError, find_mounting};
pub use prepared::Prepared;
pub use problem::SensorProblem;
pub use published::Published;
pub use reconstructor::{ReconConfig, Reconstructor, SensorState};
pub use recording::{Reconstructed, reconstruct_recording};
pub use tracker::{Measurement, Tracker, TrackerConfig};
pub use watch::{ProblemSpan, WornRecording};
