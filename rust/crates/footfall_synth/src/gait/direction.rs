//! Directions of travel: turn of the pelvis, and longest steps.

use core::f32::consts::FRAC_PI_6;
use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Greatest turn of the pelvis towards the travel, radians: half way between the axes.
const MAX_PELVIS_TURN: f32 = FRAC_PI_6;

/// Speed below which the pelvis turns less, m/s: feet that hardly travel need no room.
const FULL_TURN_SPEED_MPS: f32 = 0.4;

/// Longest steps to the side and backwards, as shares of the leg. People's are shorter than those forwards.
const MAX_SIDE_STEP: f32 = 0.38;
const MAX_BACK_STEP: f32 = 0.6;

/// Increase of the longest step to the side between these speeds, m/s: quicker steps alone would be too quick.
const LONGER_SIDE_STEP: f32 = 0.07;
const LONGER_MPS: [f32; 2] = [1.0, 1.4];

/// Turn of the pelvis towards a velocity to the left and forwards, m/s; radians, positive to the left.
///
/// Zero along the axes: the pelvis faces forwards in steps forwards, sideways and backwards.
pub(crate) fn pelvis_turn(velocity_mps: Vec2) -> f32 {
    let direction = velocity_mps.normalize_or_zero();
    let share = smooth_step(velocity_mps.length() / FULL_TURN_SPEED_MPS);
    2.0 * direction.x * direction.y * MAX_PELVIS_TURN * share
}

/// Length of a step of this velocity on legs of this length, as a multiple of the longest possible step.
pub(crate) fn overstep(velocity_mps: Vec2, step_secs: f32, leg: f32) -> f32 {
    let step = seen_from_pelvis(velocity_mps) * step_secs / leg;
    let fast = (velocity_mps.length() - LONGER_MPS[0]) / (LONGER_MPS[1] - LONGER_MPS[0]);
    let side = MAX_SIDE_STEP + LONGER_SIDE_STEP * fast.clamp(0.0, 1.0);
    Vec2::new(step.x / side, step.y.min(0.0) / MAX_BACK_STEP).length()
}

/// Returns the velocity relative to the turned pelvis. Headings are positive to the left, where x points; angles of vectors are from x to y.
pub(crate) fn seen_from_pelvis(velocity_mps: Vec2) -> Vec2 {
    Vec2::from_angle(pelvis_turn(velocity_mps)).rotate(velocity_mps)
}
