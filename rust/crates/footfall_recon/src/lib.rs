//! Runtime: what one or two inertial sensors measure becomes a body (Mousas 2017).
//!
//! Modules in the order in which data flows: [`prepared`] lays a model out for the loop that reads it, `sensor` makes frames of samples, [`tracker`] tells how probable each of
//! its frames is, [`body`] is what they say in the mean, `confidence` how well they say it, [`blend`] keeps it continuous, [`ground`] moves it, in steps as long as the wearer's (`travel`), and keeps
//! its feet in place.
//! [`mounting`] finds how a sensor is worn; [`reconstructor`] is all of it for samples as they come, [`recording`] for a recording as a whole.
//! [`Published`] names what the paper does otherwise, to compare.

pub mod blend;
pub mod body;
mod confidence;
pub mod ground;
mod kernels;
mod measure;
pub mod mounting;
pub mod prepared;
mod published;
pub mod reconstructor;
pub mod recording;
mod sensor;
mod shown_behaviour;
pub mod tracker;
mod travel;

pub use blend::Blending;
pub use body::{BodyFrame, Course};
pub use mounting::{Mounting, MountingError, find_mounting};
pub use prepared::Prepared;
pub use published::Published;
pub use reconstructor::{ReconConfig, Reconstructor, SensorState};
pub use recording::{Reconstructed, reconstruct_recording};
pub use tracker::{Measurement, Tracker, TrackerConfig};
