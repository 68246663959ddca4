//! Runtime: a gait model becomes poses.
//!
//! A step is planned (`plan`: durations and means, with chance and speed), turned into a smooth trajectory of joint
//! rotations (`trajectory`), and put on the ground (`planting`, on `rocker` feet). [`GaitGenerator`] does so in
//! real time; [`synthesize`] solves a whole walk at once.

mod detail;
mod dynamics_walk;
mod error;
mod generator;
mod pace;
mod plan;
mod planting;
mod raw;
mod space;
mod standing;
mod standing_walk;
mod state;
mod trajectory;
mod variance;
mod walk;
mod walker;

pub use detail::Detail;
pub use dynamics_walk::{DynamicsWalkConfig, synthesize_dynamics};
pub use error::SynthError;
pub use generator::{Controls, Footstep, GaitGenerator, GeneratorConfig, GroundTransform};
pub use space::StyleSpace;
pub use state::StateError;
pub use walk::{SynthesizedWalk, WalkConfig, synthesize};
