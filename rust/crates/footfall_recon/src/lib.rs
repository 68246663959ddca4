//! Runtime: a body from the measurements of one or two inertial sensors (Mousas 2017).
//!
//! Modules in the order of data flow: [`prepared`] lays a model out for the inner loop; `sensor` turns samples into frames, unless `watch` and `wear` find a [`problem`]; [`tracker`] computes the probability of each of
//! the model's frames; [`body`] is their weighted mean, `confidence` its reliability; [`blend`] keeps it continuous; [`ground`] moves it, with steps as long as the wearer's (`travel`), and keeps
//! its feet in place.
//! [`mounting`] finds the mounting of a sensor, [`mod@examine`] its problems. [`reconstructor`] combines all of this for live samples, with a `calibration` to save, [`offline`] for whole recordings.
//! [`Published`] lists the published variants of single parts, for comparison.

pub mod blend;
pub mod body;
mod calibration;
mod confidence;
pub mod examine;
pub mod ground;
pub mod guide;
mod half_life;
mod kernels;
mod manner;
mod measure;
pub mod mounting;
pub mod offline;
pub mod prepared;
pub mod problem;
mod published;
pub mod reconstructor;
mod sensor;
mod shown_behaviour;
mod strangeness;
mod stride_phase;
pub mod tracker;
mod travel;
mod watch;
mod wear;

pub use blend::Blending;
pub use body::{BodyFrame, Course};
pub use examine::{Examination, examine, find_exchange};
pub use guide::{CalibrationGuide, GuideStep};
pub use mounting::{Mounting, MountingError, find_mounting};
pub use offline::{Reconstructed, reconstruct_recording};
pub use prepared::Prepared;
pub use problem::SensorProblem;
pub use published::Published;
pub use reconstructor::{ReconConfig, Reconstructor, SensorState};
pub use stride_phase::StridePhase;
pub use tracker::{Measurement, Tracker, TrackerConfig};
pub use watch::{ProblemSpan, WornRecording};
