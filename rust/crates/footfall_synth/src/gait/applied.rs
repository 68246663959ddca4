//! Requests that the current step was made to obey.

use super::request::StepControls;
use glam::Vec2;

/// Smaller changes of what is asked for wait for the next step, m/s and rad/s.
const NEW_VELOCITY_MPS: f32 = 0.2;
const NEW_TURN_RATE_RADPS: f32 = 0.35;

/// Requests that a step was made to obey.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AppliedControls {
    pub(crate) velocity_mps: Vec2,
    pub(crate) turn_rate: f32,
    pub(crate) stops: bool,
    /// Set where it has a foothold on the ground, and may be longer or shorter for it: then it stays as it is.
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

    /// Returns whether so much else is asked for that it shall not wait for the next step.
    pub(crate) fn differs_from(&self, controls: &StepControls) -> bool {
        let other = Self::of(controls);
        self.velocity_mps.distance(other.velocity_mps) > NEW_VELOCITY_MPS
            || (self.turn_rate - other.turn_rate).abs() > NEW_TURN_RATE_RADPS
            || self.stops != other.stops
    }
}
