//! Requests to a walker.

use crate::gait::{FASTEST_RUN_MPS, GaitChoice};
use footfall_core::rotation::wrap_angle;
use glam::Vec2;

/// Slower and turning less than this is standing.
pub(crate) const STANDING_SPEED_MPS: f32 = 0.1;
const STANDING_TURN_RATE_RADPS: f32 = 0.05;

/// Fastest turning that is walked.
const MAX_TURN_RATE_RADPS: f32 = 3.5;

/// Requests to a walker. A walker whose foot is in the air obeys at once, where enough of the step is left; otherwise it takes effect with the next
/// step, as all do of runners, of walkers in less than full detail and of those of a [`DynamicsModel`](footfall_model::DynamicsModel).
///
/// A speed and turn rate near zero stop the walker within two steps; it stands until one of them rises. Turning without
/// speed turns in place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Speed over the ground, m/s.
    pub speed_mps: f32,
    /// Turning, rad/s, positive to the left.
    pub turn_rate_radps: f32,
    /// Direction of travel, relative to where the walker faces: 0 forwards, π/2 to the left, ±π backwards. Steps to the side and backwards
    /// are shorter than those forwards: an adult reaches about 0.65 m/s sideways and 1 m/s backwards, whatever speed is asked for.
    pub direction_rad: f32,
    /// Walking or running, where the model knows both.
    pub gait: GaitChoice,
    /// Depth of the crouch, from 0, upright, to 1, as low as the model's people; takes effect at once. Who crouches goes no faster than those do.
    pub crouch: f32,
}

impl Controls {
    /// Standing still.
    pub const STAND: Self = Self {
        speed_mps: 0.0,
        turn_rate_radps: 0.0,
        direction_rad: 0.0,
        gait: GaitChoice::Auto,
        crouch: 0.0,
    };

    /// The velocity that is walked, to the left and forwards from where the walker faces.
    pub(crate) fn velocity(self) -> Vec2 {
        let direction = wrap_angle(finite_or(self.direction_rad, 0.0));
        if direction == 0.0 {
            return self.speed() * Vec2::Y;
        }
        self.speed() * Vec2::new(direction.sin(), direction.cos())
    }

    /// The turning that is walked: within bounds, and none where it is not finite.
    pub(crate) fn turn_rate(self) -> f32 {
        finite_or(self.turn_rate_radps, 0.0).clamp(-MAX_TURN_RATE_RADPS, MAX_TURN_RATE_RADPS)
    }

    /// The speed that is walked.
    pub(crate) fn speed(self) -> f32 {
        finite_or(self.speed_mps, 0.0).clamp(0.0, FASTEST_RUN_MPS)
    }

    /// Returns true when this asks for neither travel nor turning, so that the walker stands.
    pub fn is_standing(self) -> bool {
        finite_or(self.speed_mps, 0.0) < STANDING_SPEED_MPS
            && finite_or(self.turn_rate_radps, 0.0).abs() < STANDING_TURN_RATE_RADPS
    }
}

fn finite_or(value: f32, otherwise: f32) -> f32 {
    if value.is_finite() { value } else { otherwise }
}
