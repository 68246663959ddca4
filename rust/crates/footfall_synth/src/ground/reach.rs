//! Reach of a leg.

use footfall_core::lanes::f32x8;
use glam::Vec3;

/// Returns the factors on the reach of a swinging leg that yields progressively between two lengths; a sudden stretch would snap the knee.
pub(super) fn yielding(reach: f32x8, [from, most]: [f32x8; 2]) -> f32x8 {
    let room = most - from;
    let beyond = (reach - from).fast_max(f32x8::ZERO);
    let yielded = from + room * (f32x8::ONE - (-beyond / room).exp());
    reach.simd_gt(from).bitselect(yielded / reach, f32x8::ONE)
}

/// Returns the shift over the ground that brings the end of a leg within reach of the hip.
pub(super) fn within_reach(ankle_from_hip: Vec3, reach: f32) -> Vec3 {
    let level = Vec3::new(ankle_from_hip.x, 0.0, ankle_from_hip.z);
    let level_reach = (reach * reach - ankle_from_hip.y.powi(2)).max(0.0).sqrt();
    level.clamp_length_max(level_reach) - level
}
