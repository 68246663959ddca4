//! Controls that the current step follows.

use super::request::StepControls;
use glam::Vec2;

/// Smaller changes of the controls wait for the next step, m/s and rad/s.
const NEW_VELOCITY_MPS: f32 = 0.2;
const NEW_TURN_RATE_RADPS: f32 = 0.35;

/// Controls that a step was planned for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AppliedControls {
    pub(crate) velocity_mps: Vec2,
    pub(crate) turn_rate: f32,
    pub(crate) stops: bool,
    /// True for a step with a foothold on the ground, whose length may have been adapted: it is not replanned.
    pub(crate) stretched: bool,
}

impl AppliedControls {
    pub(crate) fn of(controls: &StepControls) -> Self {
        Self {
            velocity_mps: controls.velocity_mps,
            turn_rate: controls.turn_rate,
            stops: controls.amplitude.to < 1.0,
            stretched: false,
        }
    }

    /// Returns true when the controls differ so much that they cannot wait for the next step.
    pub(crate) fn differs_from(&self, controls: &StepControls) -> bool {
        let other = Self::of(controls);
        self.velocity_mps.distance(other.velocity_mps) > NEW_VELOCITY_MPS
            || (self.turn_rate - other.turn_rate).abs() > NEW_TURN_RATE_RADPS
            || self.stops != other.stops
    }
}
