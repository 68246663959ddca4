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

/// A leg that is shorter by so many times as much raises no heel.
const MOST_SHORT: f32 = 5.0;

/// Greatest extra rise of a heel, radians.
const MOST_RISE: f32 = 0.4;

/// A heel rises for this where the foot is not ahead of the hip by this share of the leg's length: there it has just landed.
const AHEAD: f32 = 0.1;

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
        if beyond < -MOST_SHORT || leg.pitch < 0.0 {
            return;
        }
        let ahead = (frame.level.inverse() * (leg.target.ankle - hip)).z / (AHEAD * length);
        let share = smooth_step(1.0 - ahead);
        if share <= 0.0 {
            return;
        }
        let wanted = extension - share * RISING_SOFTNESS * beyond.exp().ln_1p();
        let (plant, foot) = (self.plant(side), &self.feet[side.index()]);
        let level = from_heading(plant.heading);
        let from_plant = level.inverse() * (hip - plant.flat_ankle);
        let pitch = foot.pitch_within_reach(from_plant, wanted * length, leg.pitch);
        leg.pitch = pitch.min(leg.pitch + MOST_RISE);
        leg.target = foot.stand_level(plant, level, leg.pitch);
    }
}
