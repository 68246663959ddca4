//! Heels that rise: a standing leg that comes to its end rolls its foot onto the ball, as people's do, before its knee snaps straight or
//! its pelvis drops.

use super::support::MAX_STANCE_EXTENSION;
use super::{PlantedFrame, Planter, StepTiming};
use crate::raw::{RawFrame, RawLeg};
use footfall_core::Side;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;
use footfall_ik::{Plant, RockerFoot};
use glam::Quat;

/// Fraction of the straight leg beyond which the heel rises instead, and over how much more it comes to do so.
const RISING_EXTENSION: f32 = 0.9965;
const RISING_SOFTNESS: f32 = 0.0014;

/// A leg that leaves the ground begins to bend so long before, seconds, and its knee is bent by twice this more by then, radians: it would snap.
const LEAVING_BEND: f32 = 0.055;
const LEAVING_SECS: f32 = 0.05;

/// No leg counts as stretched farther, as a multiple of that: its exponential stays a number.
const MOST_BEYOND: f32 = 50.0;

/// A leg that is shorter by so many times as much raises no heel.
const MOST_SHORT: f32 = 5.0;

/// Greatest extra rise of a heel, radians.
const MOST_RISE: f32 = 0.4;

/// A heel rises for this where the foot is not ahead of the hip by this share of the leg's length: there it has just landed.
const AHEAD: f32 = 0.1;

/// Weights by which the rise of a frame counts, and those of its neighbours: a leg that comes off its end does so smoothly.
const SMOOTHED: [f32; 3] = [3.0, 2.0, 1.0];

impl Planter {
    /// Raises the heels of feet that bear, where their legs are at their end, and puts those down again that need not be raised any more.
    pub(super) fn raise_heels(
        &self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) {
        let leading = timing.take_off.unwrap_or(timing.frames);
        let trailing = (!timing.airborne).then_some(timing.terminal);
        let stances = [
            (timing.leading, Some(leading)),
            (timing.leading.other(), trailing),
        ];
        // The cosine of half the knee's bend is what is left of the leg's length.
        let half_bend = RISING_EXTENSION.acos();
        for (side, last) in stances {
            let Some(last) = last else { continue };
            let raw = &mut raw[..=last];
            let plant = self.plant(side);
            let level = from_heading(plant.heading);
            let stance = Stance {
                foot: &self.feet[side.index()],
                plant,
                from_level: level.inverse(),
                length: self.leg_lengths[side.index()],
            };
            let leaves = side != timing.leading && !timing.rests;
            let unbent = if leaves {
                half_bend.cos()
            } else {
                RISING_EXTENSION
            };
            self.stand(side, raw, |leg| (leg.rise > 0.0).then_some(leg.pitch));
            let mut any = false;
            for (index, (raw, frame)) in raw.iter_mut().zip(frames).enumerate() {
                let left_secs = (last - index) as f32 * self.frame_secs;
                let most = if leaves && left_secs < LEAVING_SECS {
                    let left = 1.0 - left_secs / LEAVING_SECS;
                    (half_bend + LEAVING_BEND * left * left).cos()
                } else {
                    unbent
                };
                let leg = &mut raw.legs[side.index()];
                leg.rise = stance.rise(leg, frame, most);
                any |= leg.rise > 0.0;
            }
            if any {
                smooth(raw, side);
                let risen = |leg: &RawLeg| (leg.rise > 0.0).then_some(leg.pitch + leg.rise);
                self.stand(side, raw, risen);
            }
        }
    }
}

/// A foot on its plant, and the length of its leg.
struct Stance<'a> {
    foot: &'a RockerFoot,
    plant: &'a Plant,
    /// The rotation into the axes of the plant.
    from_level: Quat,
    length: f32,
}

impl Stance<'_> {
    /// Returns by how much the heel of a foot that stands as generated has to be higher for its leg not to be beyond this share of its length, radians.
    fn rise(&self, leg: &RawLeg, frame: &PlantedFrame, most_extension: f32) -> f32 {
        let ankle = leg.target.ankle;
        let hip = frame.pose.root_position + frame.level * leg.hip;
        let extension = hip.distance(ankle) / self.length;
        let beyond = ((extension - most_extension) / RISING_SOFTNESS).min(MOST_BEYOND);
        if beyond < -MOST_SHORT || leg.pitch < 0.0 {
            return 0.0;
        }
        let ahead = (frame.level.inverse() * (ankle - hip)).z / (AHEAD * self.length);
        let share = smooth_step(1.0 - ahead);
        if share <= 0.0 {
            return 0.0;
        }
        let mut wanted = extension - share * RISING_SOFTNESS * beyond.exp().ln_1p();
        if leg.rise > 0.0 {
            // The hips have come down to what a leg with its heel up reaches, and no lower.
            wanted = wanted.min(MAX_STANCE_EXTENSION);
        }
        let from_plant = self.from_level * (hip - self.plant.flat_ankle);
        let reach = wanted * self.length;
        let pitch = self.foot.pitch_within_reach(from_plant, reach, leg.pitch);
        (pitch - leg.pitch).clamp(0.0, MOST_RISE)
    }
}

/// Smooths the rise of a heel in time, less and less towards the ends of its stance.
fn smooth(raw: &mut [RawFrame], side: Side) {
    let side = side.index();
    let last = raw.len() - 1;
    // Rises of the frames before, as they were.
    let mut before = [0.0; 2];
    for index in 0..raw.len() {
        let own = raw[index].legs[side].rise;
        let reach = index.min(last - index).min(before.len());
        let (mut sum, mut weights) = (SMOOTHED[0] * own, SMOOTHED[0]);
        for away in 1..=reach {
            sum += SMOOTHED[away] * (before[away - 1] + raw[index + away].legs[side].rise);
            weights += 2.0 * SMOOTHED[away];
        }
        // No less than its leg lacks, and none for a foot that stands on its heel.
        let leg = &mut raw[index].legs[side];
        leg.rise = if leg.pitch < 0.0 {
            own
        } else {
            own.max(sum / weights)
        };
        before = [own, before[0]];
    }
}
