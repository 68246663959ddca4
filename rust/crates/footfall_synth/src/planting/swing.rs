//! The swinging foot: from where it stood to where it lands, along the generated path.

use super::StepTiming;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{exp_map, log_map};
use footfall_ik::{FootTarget, RockerFoot};
use glam::Vec3;

/// Least clearance of the sole in the middle of the swing, metres.
const CLEARANCE_M: f32 = 0.012;

/// Over how many metres the foot yields to that clearance.
const CLEARANCE_SOFTNESS_M: f32 = 0.004;

/// How fast the disagreement from the last stance dies away, per swing.
const SETTLE_RATE: f32 = 8.0;

/// A foot lands at most this fast, m/s: people brake their swing before the heel strikes.
const MAX_LANDING_MPS: f32 = 1.2;

/// Part of the swing by which a foot is free of how it stood.
const FREED_BY: f32 = 0.3;

/// Over this time at most a faster foot is braked, seconds.
const BRAKING_SECS: f32 = 0.16;

/// What planted and generated foot disagree about, from the foot's last frame on the ground to its next first.
pub(super) struct Swing {
    first: usize,
    frames: f32,
    position: Correction,
    rotation: Correction,
    /// The toes' own rotation.
    toes: Correction,
    /// By how much the foot would land too fast, metres a frame, and over how many frames it is braked.
    excess: Vec3,
    braking: f32,
}

/// A correction at both ends of the swing, and how fast it changes when the foot leaves the ground (per swing).
struct Correction {
    start: Vec3,
    departure: Vec3,
    end: Vec3,
}

impl Correction {
    /// A critically damped farewell to the start, and a smooth approach to the end.
    fn at(&self, s: f32) -> Vec3 {
        let farewell = self.start + (self.departure + self.start * SETTLE_RATE) * s;
        farewell * (-SETTLE_RATE * s).exp() + self.end * smooth_step(s)
    }
}

impl Swing {
    /// `ends`: the planted and the free foot one frame before the swing, at its start and at its end; `arrival`: where the free
    /// foot is one frame before the end.
    pub(super) fn new(
        ends: &[(FootTarget, FootTarget); 3],
        arrival: Vec3,
        timing: &StepTiming,
        frame_secs: f32,
    ) -> Self {
        let first = timing.terminal;
        let frames = (timing.frames - first).max(1) as f32;
        let correction = |difference: &dyn Fn(&FootTarget, &FootTarget) -> Vec3| {
            let [before, start, end] = ends
                .each_ref()
                .map(|(planted, free)| difference(planted, free));
            Correction {
                start,
                departure: (start - before) * frames,
                end,
            }
        };
        // Captured toes are too noisy to follow, as most marker sets guess them: from their bend at the end of the stance
        // they go to that of the landing, which is none where the heel lands first.
        let toes = correction(&|planted, _| log_map(planted.foot.inverse() * planted.toes));
        // The corrections have come to rest by then.
        let landing = ends[2].1.ankle - arrival;
        Self {
            first,
            frames,
            excess: landing - landing.clamp_length_max(MAX_LANDING_MPS * frame_secs),
            braking: (BRAKING_SECS / frame_secs).min(frames),
            position: correction(&|planted, free| planted.ankle - free.ankle),
            rotation: correction(&|planted, free| log_map(planted.foot * free.foot.inverse())),
            toes,
        }
    }

    /// How far the foot has come away from how it stood, from 0 to 1.
    pub(super) fn freed(&self, index: usize) -> f32 {
        smooth_step((index - self.first) as f32 / (FREED_BY * self.frames))
    }

    /// The foot at a frame of the step, from where it would be free.
    pub(super) fn guide(&self, index: usize, free: &FootTarget, foot: &RockerFoot) -> FootTarget {
        let s = (index - self.first) as f32 / self.frames;
        let rotation = (exp_map(self.rotation.at(s)) * free.foot).normalize();
        let mut target = FootTarget {
            ankle: free.ankle + self.position.at(s),
            foot: rotation,
            toes: rotation * exp_map(self.toes.at(s)),
        };
        // Ahead at first, so as to arrive slower.
        let left = self.frames - (index - self.first) as f32;
        let b = (1.0 - left / self.braking).max(0.0);
        target.ankle += self.excess * (self.braking * b * b * (1.0 - b));
        let clearance = CLEARANCE_M * (PI * s).sin().powi(2);
        let softness = CLEARANCE_SOFTNESS_M * (PI * s).sin() + 1e-6;
        let short = (clearance - foot.lowest_point(&target)) / softness;
        // Beyond these the soft maximum is the hard one to the last digit that shows.
        target.ankle.y += softness
            * match short {
                short if short > 10.0 => short,
                short if short < -10.0 => 0.0,
                short => short.exp().ln_1p(),
            };
        target
    }
}
