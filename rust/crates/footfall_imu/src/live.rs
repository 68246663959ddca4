//! Sensors that are worn now: phones and serial devices.
//!
//! Modules in the order in which data flows: a port's thread receives bytes ([`serial`], [`network`], [`phone`]); a format turns them into
//! [`reading`]s, whose units and axes are ours; the [`assembly`] makes samples of readings that come apart, the [`clock`] gives them times, and a
//! [`device`] keeps them for the game, with what is known of its state. [`recorder`] writes them to a file.
//!
//! Everything that comes from outside is bounded: length of a message, messages a second, senders, samples that wait. What is no message of a
//! known form is counted and left out. Nothing here blocks the thread that asks for samples.

pub mod assembly;
pub mod clock;
pub mod device;
pub mod json;
pub mod link;
pub mod network;
pub mod phone;
pub mod reading;
pub mod recorder;
pub mod serial;

pub use device::{Device, DeviceStatus};
pub use link::{Link, LinkState};
pub use reading::{Quantity, Reading};
