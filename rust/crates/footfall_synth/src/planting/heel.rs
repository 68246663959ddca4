//! Heels that rise: a standing leg that comes to its end rolls its foot onto the ball, as people's do, before its knee snaps straight or
//! its pelvis drops.

use super::{PlantedFrame, Planter, StepTiming};
use crate::raw::RawFrame;
use footfall_core::Side;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;

/// Fraction of the straight leg beyond which the heel rises instead, and over how much more it comes to do so.
const RISING_EXTENSION: f32 = 0.996;
const RISING_SOFTNESS: f32 = 0.0014;

/// No leg counts as stretched farther, as a multiple of that: its exponential stays a number.
const MOST_BEYOND: f32 = 50.0;

/// How far a heel rises for this at most, radians.
const MOST_RISE: f32 = 0.4;

/// A heel rises for this where the foot is not ahead of the hip by this share of the leg's length: there it has just landed.
const AHEAD: f32 = 0.1;

/// Newton's steps to the pitch: the leg's length is nearly linear in it.
const STEPS: usize = 2;

/// Angle by which a foot is turned to see how its leg gets shorter, radians.
const PROBE: f32 = 1e-2;

impl Planter {
    /// Raises the heels of feet that bear, where their legs are at their end.
    pub(super) fn raise_heels(
        &self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) {
        for (index, (raw, frame)) in raw.iter_mut().zip(frames).enumerate() {
            if timing.leading_bears(index) {
                self.raise_heel(timing.leading, raw, frame);
            }
            if timing.trailing_bears(index) {
                self.raise_heel(timing.leading.other(), raw, frame);
            }
        }
    }

    fn raise_heel(&self, side: Side, raw: &mut RawFrame, frame: &PlantedFrame) {
        let leg = &mut raw.legs[side.index()];
        let length = self.leg_lengths[side.index()];
        let hip = frame.pose.root_position + frame.level * leg.hip;
        let extension = hip.distance(leg.target.ankle) / length;
        let beyond = ((extension - RISING_EXTENSION) / RISING_SOFTNESS).min(MOST_BEYOND);
        let ahead = (frame.level.inverse() * (leg.target.ankle - hip)).z / (AHEAD * length);
        if beyond < -8.0 || ahead >= 1.0 || leg.pitch < 0.0 {
            return;
        }
        let share = smooth_step(1.0 - ahead);
        let wanted = extension - share * RISING_SOFTNESS * beyond.exp().ln_1p();
        let (plant, foot) = (self.plant(side), &self.feet[side.index()]);
        let level = from_heading(plant.heading);
        let reach = |pitch: f32| hip.distance(foot.stand_level(plant, level, pitch).ankle) / length;
        let mut pitch = leg.pitch;
        let mut now = extension;
        for _ in 0..STEPS {
            let slope = (reach(pitch + PROBE) - now) / PROBE;
            if slope >= 0.0 {
                break;
            }
            pitch = (pitch + (wanted - now) / slope).clamp(leg.pitch, leg.pitch + MOST_RISE);
            now = reach(pitch);
        }
        leg.pitch = pitch;
        leg.target = foot.stand_level(plant, level, pitch);
    }
}
