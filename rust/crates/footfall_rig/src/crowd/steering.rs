//! Steering: how a walker comes to go in a direction.

use glam::Vec2;

/// Rate of turning towards the desired direction: rad/s for each radian of difference, and its limit.
const TURN_GAIN: f32 = 1.6;
const MAX_TURN_RADPS: f32 = 1.3;
/// Difference from the desired direction beyond which a walker slows down to turn, radians, with a radian of difference for all of its speed.
const SLOWING_FROM_RAD: f32 = 0.2;
/// Share of the speed that is left in a large turn, where there is space for an arc.
pub(super) const ARC_SPEED: f32 = 0.25;

/// The turn rate towards a direction that is `off` to the left, rad/s.
pub(super) fn turn_rate(off: f32) -> f32 {
    (TURN_GAIN * off).clamp(-MAX_TURN_RADPS, MAX_TURN_RADPS)
}

/// The share of its speed, at least this one, with which a walker goes while it turns to a direction that is `off` to the left.
pub(super) fn turning_speed(off: f32, least: f32) -> f32 {
    (1.0 + SLOWING_FROM_RAD - off.abs()).clamp(least, 1.0)
}

/// The unit vector of a heading.
pub(super) fn direction(heading: f32) -> Vec2 {
    Vec2::new(heading.sin(), heading.cos())
}
