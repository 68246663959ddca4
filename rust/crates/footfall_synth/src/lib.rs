//! Runtime: a gait model becomes poses.
//!
//! A step of a gait model is planned (`plan`: durations and means, with chance and speed, from the model's `statistics`) and turned into a smooth trajectory of
//! joint rotations (`trajectory`); a step of a switching model is run by one of its two systems (`switching`). Either is put on
//! the ground (`stage` and `planting`, on `rocker` feet). What the whole body does on top of its steps, crouching and jumping, is in `moves`. [`GaitGenerator`] does so in real time; [`synthesize`] solves a whole walk
//! at once.

mod controls;
mod crowd;
mod detail;
mod error;
mod fine_motion;
mod footing;
mod footstep;
mod gait;
mod generator;
mod jumping;
mod looped;
mod moves;
mod obeyed;
mod pace;
mod plan;
mod planting;
mod raw;
mod recording;
pub mod replica;
mod rest;
mod space;
mod stage;
mod standing;
mod state;
mod statistics;
mod steps;
mod strafe;
mod styled;
mod switching;
mod trajectory;
mod variance;
mod walk;
mod walker;
mod workbench;
#[doc(hidden)]
pub mod workload;
mod worn;

pub use controls::Controls;
pub use crowd::{
    CrowdPose, CrowdWalker, LedAim, LedBeginning, LedStep, SharedPose, StyledBody, Workshop,
};
pub use detail::Detail;
pub use error::SynthError;
pub use footfall_core::GroundTransform;
pub use footstep::Footstep;
pub use gait::{Gait, GaitChoice};
pub use generator::{GaitGenerator, GeneratorConfig};
pub use looped::LoopedWalk;
pub use moves::JumpPhase;
pub use recording::{
    Move, StandConfig, SwitchingWalkConfig, synthesize_moves, synthesize_standing,
    synthesize_switching,
};
pub use space::StyleSpace;
pub use state::StateError;
pub use walk::{SynthesizedWalk, WalkConfig, synthesize};
