//! Replicas: a walker of one machine makes the same steps on others, over a network.
//!
//! A walk follows from a seed and its controls, so little has to be sent: a [`WalkIdentity`] once and after each change, reliably, and updates of
//! [`UPDATE_BYTES`] as often as the game likes, which may be lost. An update contains the number of the current step, its controls and its end.
//! [`WalkSender`] makes both. [`WalkFollower`] drives a [`GaitGenerator`](crate::GaitGenerator) by them with a small delay that hides late and lost updates: each
//! step has the draw, the beginning, the controls and the end of the sender's. Remaining differences are
//! walked off with the next steps, without moving standing feet.
//!
//! Places are those of a space that all machines share, such as the level.

mod clock;
mod error;
mod follower;
mod gate;
mod identity;
mod led;
mod numbering;
mod queue;
mod sender;
mod update;

pub use clock::{ReplicaClock, haste};
pub use error::ReplicaError;
pub use follower::{Followed, WalkFollower};
pub use identity::WalkIdentity;
pub use numbering::next_number;
pub use sender::WalkSender;
pub use update::UPDATE_BYTES;
