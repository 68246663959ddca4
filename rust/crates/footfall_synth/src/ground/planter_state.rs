//! Feet, hips and heading as they are carried from step to step.

use super::flight::Airborne;
use super::lean::Lean;
use super::strafe::Strafe;
use footfall_ik::Plant;
use glam::{Vec2, Vec3};

/// State that goes from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlanterState {
    pub(crate) plants: [Plant; 2],
    pub(crate) hips: Vec3,
    /// Velocity of the hips in the last frame, m/s; none before the first step.
    pub(crate) hips_velocity: Option<Vec3>,
    pub(crate) heading: f32,
    pub(crate) turn_rate: f32,
    pub(crate) ground_position: Vec3,
    pub(crate) ground_velocity: Option<Vec3>,
    /// Factor on the legs' reach at the end of the last step.
    pub(crate) stride: f32,
    /// Strafe of the last step.
    pub(crate) strafe: Strafe,
    /// Shift of both feet with which it landed in balance, to the left and forwards.
    pub(crate) balance: Vec2,
    /// The foot that took off in the last step, if that was one of a run.
    pub(crate) airborne: Option<Airborne>,
    /// Lean of the trunk.
    pub(crate) lean: Lean,
}
