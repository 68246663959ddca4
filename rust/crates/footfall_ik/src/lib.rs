//! Leg inverse kinematics, the standing foot, and feet on real ground.
//!
//! Godot 4.6 has a `TwoBoneIK3D`, but it ignores the target's rotation and does not know contacts. This crate also rotates
//! the ankle, and is the same code in the editor, in tests and on the command line.

pub mod handover;
pub mod leg;
pub mod placement;
pub mod rocker;

pub use leg::{FootTarget, FootTargetx8, Leg, LegSolution, reach_height, solve_leg};
pub use rocker::{Plant, RockerFoot, foot_heading, foot_pitch, foot_pitches, settled_pitch};
