//! Height of a foot that swings to the side or backwards.
//!
//! The toes of a walk forwards hang in the swing. A foot that stays flat on the path of such an ankle would rise by 8 cm at once, so its sole follows a curve of its own, as high as the toes
//! in the walk forwards.

use super::Turner;
use crate::ground::generated::GeneratedFrame;
use crate::plan::StepTiming;
use core::f32::consts::PI;
use footfall_core::Side;
use footfall_core::ease::{smooth_step, soft_min};
use footfall_ik::RockerFoot;
use glam::{Quat, Vec3};

/// Least and greatest height of the sole, as shares of the leg: people who step aside or back lift their feet by 4 to 5 cm.
const LIFT_SHARES: [f32; 2] = [0.036, 0.06];

/// Exponent of the part of the swing: with less than 1 the foot is highest before the middle, as the knee bends while the leg trails.
const EARLY: f32 = 0.7;

/// Part of the swing at which it is highest, a half to the power of 1 / [`EARLY`]; a foot in the air comes down from there after a replanning.
const HIGHEST_AT: f32 = 0.37;

/// Distance over which the lowest point of a sole changes from heel to toes, metres.
const SOLE_SOFTNESS_M: f32 = 0.02;

/// Curve of a swinging sole.
pub(super) struct Lift {
    /// Height of the sole of a flat foot from its ankle, metres.
    flat_m: f32,
    /// Greatest height above the ground, metres.
    highest_m: f32,
    /// Height of the ground under the landing foot above that under the standing one, as the legs of the step have them, metres.
    settling_m: f32,
    /// Part of the swing that is over when the step begins.
    begun: f32,
}

impl Lift {
    /// Returns the curve of the trailing foot in a step as generated.
    pub(super) fn of(
        turner: &Turner<'_>,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
    ) -> Self {
        let (leading, trailing) = (timing.leading, timing.leading.other());
        let foot = &turner.feet[trailing.index()];
        let flat_m = sole_below(foot, 0.0);
        let flat = |index: usize, side: Side| {
            let leg = &generated[index].legs[side.index()];
            leg.flat_ankle(&turner.feet[side.index()]).y
        };
        let highest = (timing.terminal + 1..timing.frames).map(|index| {
            let leg = &generated[index].legs[trailing.index()];
            let sole = leg.ankle.y + sole_below(foot, leg.free_pitch);
            sole - flat_m - flat(index, leading)
        });
        let [least, most] = LIFT_SHARES.map(|share| share * turner.leg_length);
        Self {
            flat_m,
            highest_m: highest.fold(0.0, f32::max).clamp(least, most),
            settling_m: flat(timing.frames, trailing) - flat(timing.frames, leading),
            begun: if timing.airborne { HIGHEST_AT } else { 0.0 },
        }
    }

    /// Returns the height of the sole at part `s` of the swing, from the standing ankle, metres.
    pub(super) fn sole(&self, s: f32) -> f32 {
        let passed = self.begun + (1.0 - self.begun) * s;
        let up = (PI * passed.powf(EARLY)).sin().powi(2);
        self.flat_m + up * self.highest_m + smooth_step(s) * self.settling_m
    }
}

/// Height of the lowest point of a sole at this pitch, seen from the ankle, metres.
pub(super) fn sole_below(foot: &RockerFoot, pitch: f32) -> f32 {
    let tilt = Quat::from_rotation_x(pitch);
    let [heel, _, tip] = foot.sole_points().map(|point| {
        let point = point - foot.ankle_height() * Vec3::Y;
        (tilt * point).y
    });
    soft_min(heel, tip, SOLE_SOFTNESS_M)
}
