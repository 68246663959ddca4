//! Requests to a walker.

use footfall_core::rotation::wrap_angle;
use glam::Vec2;

/// Speed and turn rate below which the walker stands.
pub(crate) const STANDING_SPEED_MPS: f32 = 0.1;
const STANDING_TURN_RATE_RADPS: f32 = 0.05;

/// Fastest speed of a run, m/s.
pub(crate) const FASTEST_RUN_MPS: f32 = 6.0;

/// Fastest turn rate of a walk.
const MAX_TURN_RATE_RADPS: f32 = 3.5;

/// Units of a turn rate that is sent to peers over a network, in a rad/s.
pub(crate) const TURN_UNITS: f32 = 36.0;

/// Requested gait.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GaitChoice {
    /// Automatic: runs above about 2 m/s, where walking costs people more.
    #[default]
    Auto,
    /// Walks at any speed.
    Walk,
    /// Runs at any speed, except in the steps in which it starts and stops.
    Run,
}

/// Requests to a walker. A walker with a foot in the air responds at once if enough of the step is left, otherwise with the next
/// step; a runner does so in the first half of its stance. Runners that are to stop, walkers in less than full detail and those of a
/// [`DynamicsModel`](footfall_model::DynamicsModel) always respond with the next step.
///
/// A speed and turn rate near zero stop the walker within two steps; it stands until one of them rises. Turning without
/// speed turns on the spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Speed over the ground, m/s.
    pub speed_mps: f32,
    /// Turn rate, rad/s, positive to the left.
    pub turn_rate_radps: f32,
    /// Direction of travel relative to the facing direction: 0 forwards, π/2 to the left, ±π backwards. Steps sideways and backwards
    /// are shorter than forward steps: an adult reaches about 1.6 m/s sideways and 2.0 m/s backwards, whatever speed is requested.
    pub direction_rad: f32,
    /// Choice between walking and running, if the model has both.
    pub gait: GaitChoice,
    /// Depth of the crouch, from 0, upright, to 1, as low as the model's people; applies at once. A crouching walker is as slow as they are.
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

    /// Velocity of the walk, to the left and forwards relative to the facing direction.
    pub(crate) fn velocity(self) -> Vec2 {
        let direction = wrap_angle(finite_or(self.direction_rad, 0.0));
        if direction == 0.0 {
            return self.speed() * Vec2::Y;
        }
        self.speed() * Vec2::new(direction.sin(), direction.cos())
    }

    /// Turn rate of the walk: within bounds, and 0 for a non-finite request.
    pub(crate) fn turn_rate(self) -> f32 {
        finite_or(self.turn_rate_radps, 0.0).clamp(-MAX_TURN_RATE_RADPS, MAX_TURN_RATE_RADPS)
    }

    /// Speed of the walk.
    pub(crate) fn speed(self) -> f32 {
        finite_or(self.speed_mps, 0.0).clamp(0.0, FASTEST_RUN_MPS)
    }

    /// Returns true when neither travel nor turning is requested, so that the walker stands.
    pub fn is_standing(self) -> bool {
        finite_or(self.speed_mps, 0.0) < STANDING_SPEED_MPS
            && finite_or(self.turn_rate_radps, 0.0).abs() < STANDING_TURN_RATE_RADPS
    }
}

fn finite_or(value: f32, otherwise: f32) -> f32 {
    if value.is_finite() { value } else { otherwise }
}

/// Returns a turn rate as peers over a network know it, rad/s.
pub(crate) fn sent_turn_rate(turn_rate: f32) -> f32 {
    (TURN_UNITS * turn_rate).round() / TURN_UNITS
}
