//! Conversion between a game's rig and the canonical body, and crowds of walkers.
//!
//! [`RestRig`] holds the bones of a character in the rest pose, and [`joint_bones`] finds the joints among them. [`RigBinding`] measures the body and converts
//! poses between the two, through the [`Bones`] of any engine. [`crowd`] walks thousands of walkers: ids, goals, steps, and levels of detail. [`StandIn`] is the mesh of those who are far away. [`root_motion`] passes a
//! character's travel to an engine's two clocks.

pub mod crowd;
pub mod root_motion;

mod binding;
mod joints;
mod rest_body;
mod rest_rig;
mod stand_in;

pub use binding::{BindingError, Bones, LayerWeights, RigBinding, relative_size};
pub use joints::{MappedBones, MissingJoints, joint_bones};
pub use rest_rig::RestRig;
pub use stand_in::{Facet, StandIn, StandInVertex};
