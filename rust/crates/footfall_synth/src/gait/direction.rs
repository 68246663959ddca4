//! Directions of travel: the turn of the pelvis towards them, and the longest steps in them.

use core::f32::consts::FRAC_PI_6;
use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Greatest turn of the pelvis towards the travel, radians: half way between the axes.
const MAX_PELVIS_TURN: f32 = FRAC_PI_6;

/// Slower than this the pelvis turns less, m/s: feet that hardly travel need no room.
const FULL_TURN_SPEED_MPS: f32 = 0.4;

/// Longest steps to the side and backwards, as shares of the leg. People's are shorter than those forwards.
const MAX_SIDE_STEP: f32 = 0.38;
const MAX_BACK_STEP: f32 = 0.6;

/// Turn of the pelvis towards a velocity to the left and forwards, m/s; radians, positive to the left.
///
/// Not at all along the axes: it faces forwards in steps forwards, sideways and backwards.
pub(crate) fn pelvis_turn(velocity_mps: Vec2) -> f32 {
    let direction = velocity_mps.normalize_or_zero();
    let share = smooth_step(velocity_mps.length() / FULL_TURN_SPEED_MPS);
    2.0 * direction.x * direction.y * MAX_PELVIS_TURN * share
}

/// Length of a step of this velocity on legs of this length, as a multiple of people's steps; at most 1 for one that is possible.
pub(crate) fn overstep(velocity_mps: Vec2, step_secs: f32, leg: f32) -> f32 {
    let step = seen_from_pelvis(velocity_mps) * step_secs / leg;
    Vec2::new(step.x / MAX_SIDE_STEP, step.y.min(0.0) / MAX_BACK_STEP).length()
}

/// Angles of headings are positive to the left, which is where x points; those of vectors are to y.
pub(crate) fn seen_from_pelvis(velocity_mps: Vec2) -> Vec2 {
    Vec2::from_angle(pelvis_turn(velocity_mps)).rotate(velocity_mps)
}
