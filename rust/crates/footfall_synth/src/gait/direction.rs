//! Directions of travel: turn of the pelvis, and longest steps.

use core::f32::consts::FRAC_PI_6;
use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Greatest turn of the pelvis towards the travel, radians: half way between the axes.
const MAX_PELVIS_TURN: f32 = FRAC_PI_6;

/// Speed below which the pelvis turns less, m/s: feet that hardly travel need no room.
const FULL_TURN_SPEED_MPS: f32 = 0.4;

/// Longest steps to the side and backwards, each at a slow and at a quick speed, as shares of the leg. People's are shorter than those forwards. In between they grow with the
/// speed: long slow steps would spread the legs for long, quicker short ones would be too quick. Bandai's actors walk backwards in steps of 0.4 to 0.5 of the leg at 0.5 m/s, of 0.65 to 0.77
/// at 1.1 m/s.
const MAX_SIDE_STEP: [f32; 2] = [0.26, 0.45];
const MAX_BACK_STEP: [f32; 2] = [0.48, 0.74];

/// Those speeds, m/s.
const SLOW_QUICK_MPS: [f32; 2] = [0.3, 1.4];

/// Largest sideways share of the way forwards with which a velocity counts as forwards: such a step can still end the walk.
const STRAIGHT: f32 = 0.2;

/// Turn of the pelvis towards a velocity to the left and forwards, m/s; radians, positive to the left.
///
/// Zero along the axes: the pelvis faces forwards in steps forwards, sideways and backwards.
pub(crate) fn pelvis_turn(velocity_mps: Vec2) -> f32 {
    let direction = velocity_mps.normalize_or_zero();
    let share = smooth_step(velocity_mps.length() / FULL_TURN_SPEED_MPS);
    2.0 * direction.x * direction.y * MAX_PELVIS_TURN * share
}

/// Returns true for a velocity forwards, or nearly so ([`STRAIGHT`]).
pub(super) fn is_forwards(velocity_mps: Vec2) -> bool {
    velocity_mps.y > 0.0 && velocity_mps.x.abs() < STRAIGHT * velocity_mps.y
}

/// Returns true for a velocity to the side rather than forwards or backwards.
pub(super) fn sidles(velocity_mps: Vec2) -> bool {
    velocity_mps.x.abs() > velocity_mps.y.abs()
}

/// Length of a step of this velocity on legs of this length, as a multiple of the longest possible step.
pub(crate) fn overstep(velocity_mps: Vec2, step_secs: f32, leg: f32) -> f32 {
    let step = seen_from_pelvis(velocity_mps) * step_secs / leg;
    let [slow, quick] = SLOW_QUICK_MPS;
    let quickness = ((velocity_mps.length() - slow) / (quick - slow)).clamp(0.0, 1.0);
    let [side, back] =
        [MAX_SIDE_STEP, MAX_BACK_STEP].map(|[short, long]| short + quickness * (long - short));
    Vec2::new(step.x / side, step.y.min(0.0) / back).length()
}

/// Returns the velocity relative to the turned pelvis. Headings are positive to the left, where x points; angles of vectors are from x to y.
pub(crate) fn seen_from_pelvis(velocity_mps: Vec2) -> Vec2 {
    Vec2::from_angle(pelvis_turn(velocity_mps)).rotate(velocity_mps)
}
