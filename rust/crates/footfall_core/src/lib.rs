//! The vocabulary that every other crate shares: joints, skeletons, poses, clips, rotations, forward kinematics and
//! foot contacts, sites of sensors.
//!
//! Space and units: metres, seconds, radians; Y up, right-handed; a character faces +Z and its left is +X. Every
//! transform is named `target_from_source`. Nothing here reads a file, a clock or a random number.
//!
//! Modules in suggested reading order: [`joint`], [`skeleton`], [`pose`], [`rotation`], [`clip`], [`contact`],
//! [`step_position`], [`ground`], [`rig`], [`behaviour`], [`phase`], [`site`], [`ease`], [`lanes`], [`hash`].

pub mod behaviour;
pub mod clip;
pub mod contact;
pub mod ease;
pub mod ground;
pub mod hash;
pub mod joint;
pub mod lanes;
pub mod phase;
pub mod pose;
pub mod rig;
pub mod rotation;
pub mod site;
pub mod skeleton;
pub mod step_position;

pub use behaviour::Behaviour;
pub use clip::Clip;
pub use contact::{EventKind, FrameSpan, GaitEvent};
pub use ground::GroundTransform;
pub use joint::{JOINT_COUNT, Joint, Side};
pub use phase::{PhaseKind, PhaseStart};
pub use pose::{ModelPose, Pose, forward_kinematics, forward_kinematics_of};
pub use rig::Rig;
pub use site::Site;
pub use skeleton::{FootShape, Skeleton, SkeletonError};
pub use step_position::StepPosition;
