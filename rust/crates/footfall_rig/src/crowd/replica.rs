//! Crowds over a network: a crowd that walks on one machine is repeated on others, walker by walker and step by step.
//!
//! The [sender](CrowdSender) sends its walkers reliably, and their steps unreliably: [`STEP_BYTES`] for each step, as many as a budget allows, and first those
//! without which peers would have the largest errors. A crowd that [follows](super::Crowd::follow) has the same walkers by the same names. Each takes the same steps a
//! little later: drawn from the same random numbers, with the same beginning and the same end. The next steps walk off any error.
//!
//! Places are in the crowd's own space, which must have the same place in the world on all machines.

mod agent;
mod early;
mod error;
mod following;
mod led;
mod message;
mod pending;
mod person;
mod sender;
mod start;
mod step;

pub use error::CrowdReplicaError;
pub(super) use following::Following;
pub(super) use led::LedWalker;
pub use message::CrowdMessage;
pub use sender::CrowdSender;
pub use step::STEP_BYTES;
