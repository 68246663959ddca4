//! Crowds over a network: one that walks on one machine is shown by others, walker by walker and step by step.
//!
//! Whoever [tells](CrowdSender) a crowd sends who is in it, reliably, and unreliably the steps that they take: [`STEP_BYTES`] a walker and step, as many as a budget
//! allows, those first of whom others would err most. A crowd that [follows](super::Crowd::follow) has the same walkers by the same names, and each takes the same
//! steps a little later: drawn by the same chance, begun when they were, and ended where they ended. What is off is walked off with the next steps.
//!
//! Places are those of the crowd's own space, which all machines put in the same place.

mod agent;
mod error;
mod following;
mod led;
mod message;
mod person;
mod sender;
mod start;
mod step;
mod untold;

pub use error::CrowdReplicaError;
pub(super) use following::Following;
pub(super) use led::Led;
pub use message::CrowdMessage;
pub use sender::CrowdSender;
pub use step::STEP_BYTES;
