//! Walkers over a network: one that is walked on one machine makes the same steps on others.
//!
//! A walk follows from a seed and what is asked of it, so little has to be sent: a [`WalkIdentity`] once and whenever it changes, reliably, and updates of
//! [`UPDATE_BYTES`] as often as the game likes, which may be lost. An update says which step of the walk the walker is in, what that was asked to be, and where it ends.
//! [`WalkSender`] makes both. [`WalkFollower`] walks a [`GaitGenerator`](crate::GaitGenerator) by them, a little later than they come, so that what is late or lost is not missed: each
//! step is drawn by the chance that the sender's was, begins when it did, obeys what it obeyed, and ends where it ended. What is still left between the two is
//! walked off with the next steps; feet that stand are not moved for it.
//!
//! Places are those of a space that all machines share, such as the level.

mod clock;
mod error;
mod follower;
mod gate;
mod identity;
mod led;
mod queue;
mod sender;
mod update;

pub use clock::ReplicaClock;
pub use error::ReplicaError;
pub use follower::{Followed, WalkFollower};
pub use identity::WalkIdentity;
pub use sender::WalkSender;
pub use update::UPDATE_BYTES;
