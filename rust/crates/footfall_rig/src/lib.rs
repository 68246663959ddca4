//! Between a game and the walkers: a game's own rig as the canonical body and back, and crowds of walkers.
//!
//! [`RestRig`] has the bones of a character as they rest, and [`joint_bones`] finds the joints among them. [`RigBinding`] measures the body and moves
//! poses between the two, through the [`Bones`] of any engine. [`crowd`] walks thousands: who they are, where they go and how, and how each is to be drawn. [`root_motion`] hands a
//! character's travel to an engine's two clocks.

pub mod crowd;
pub mod root_motion;

mod binding;
mod joints;
mod rest_body;
mod rest_rig;

pub use binding::{BindingError, Bones, LayerWeights, RigBinding, relative_size};
pub use joints::{MappedBones, MissingJoints, joint_bones};
pub use rest_rig::RestRig;
