//! Runtime: poses from a gait model.
//!
//! Every step takes the same way. Each arrow is a type, and each folder takes one to the next:
//!
//! ```text
//! Controls ─► StepRequest ─► StepPlan ─► features ─► PlantedStep ─► Pose
//!            gait/          plan/       trajectory/ ground/        generator.rs
//!            stand, walk    timing,     joints and  root travel,   streaming: the way
//!            or run, pace   durations,  fine detail planted feet,  of every frame
//!                           variation               legs
//! ```
//!
//! `source/` walks this way for a step: a window of three steps of a [`GaitModel`](footfall_model::GaitModel) in a mixture of styles, or two linear systems, which
//! generate features without a plan. [`GaitGenerator`] reads a pose from the planted step in every frame and adds motion of the whole body: `standing/` (sway, breathing)
//! and `moves/` (crouch, jump, push, climb). On top stand `batch/` (whole walks, [`synthesize`]), `crowd/` (thousands of walkers that share buffers) and [`replica`]
//! (walkers over a network).
//!
//! Imports run against the arrows only: a folder knows those before it, never those after it. Three things therefore do not lie where the way first meets them. A
//! body's paces are measured by walking it, so `source/` measures them and `gait/` only holds the table. The travel of the root follows from the planted feet, so it is
//! part of `ground/`, with the legs solved to it; features contain joints only. The remainder of a replanned step is planned from the feet of the step on the ground, so
//! the window carries them back as the origin of the next step.

mod batch;
mod config;
mod controls;
mod crowd;
mod detail;
mod error;
mod footstep;
mod gait;
mod generator;
mod ground;
mod hash;
mod moves;
mod plan;
pub mod replica;
mod rows;
mod source;
mod standing;
mod trajectory;
#[doc(hidden)]
pub mod workload;

pub use batch::{
    LoopedWalk, Move, StandConfig, SwitchingWalkConfig, SynthesizedWalk, WalkConfig, synthesize,
    synthesize_moves, synthesize_standing, synthesize_switching,
};
pub use config::GeneratorConfig;
pub use controls::{Controls, GaitChoice};
pub use crowd::{
    CrowdPose, CrowdWalker, LedAim, LedBeginning, LedStep, SharedPose, StyledBody, Workshop,
};
pub use detail::Detail;
pub use error::SynthError;
pub use footfall_core::GroundTransform;
pub use footstep::Footstep;
pub use gait::Gait;
pub use generator::{GaitGenerator, StateError};
pub use moves::JumpPhase;
pub use source::StyleSpace;
