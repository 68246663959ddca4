//! Rise of the heel: a standing leg at the end of its reach rolls its foot onto the ball, as people's do, before the knee snaps straight or
//! the pelvis drops.

use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, GeneratedLeg};
use super::planter::Planter;
use super::support::MAX_STANCE_EXTENSION;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::lanes::{LANES, Quatx8, Vec3x8, f32x8, smooth_step};
use footfall_core::rotation::from_heading;
use footfall_ik::{Plant, RockerFoot};
use glam::Quat;

/// Fraction of the straight leg beyond which the heel rises instead, and the range over which it sets in.
const RISING_EXTENSION: f32 = 0.997;
const RISING_SOFTNESS: f32 = 0.0014;

/// Time before the end of contact at which a leaving leg begins to bend, seconds, and half of its extra knee flexion by then, radians; without it the knee would snap.
const LEAVING_BEND: f32 = 0.08;
const LEAVING_SECS: f32 = 0.05;

/// The same of a leg that takes off into a flight: a runner's knees stay bent.
const TAKE_OFF_BEND: f32 = 0.18;
const TAKE_OFF_SECS: f32 = 0.1;

/// Limit of the excess stretch, as a multiple of that range, to keep the exponential finite.
const MOST_BEYOND: f32 = 50.0;

/// Multiple of that range by which a shorter leg raises no heel.
const MOST_SHORT: f32 = 5.0;

/// Greatest extra rise of a heel, radians.
const MOST_RISE: f32 = 0.4;

/// Share of the leg's length by which a foot is ahead of its hip just after landing; its heel does not rise then.
const AHEAD: f32 = 0.1;

/// Weights of the rise of a frame and of its neighbours, for smooth changes.
const SMOOTHED: [f32; 3] = [3.0, 2.0, 1.0];

impl Planter {
    /// Raises the heels of bearing feet whose legs are at the end of their reach, and lowers heels that need not be raised any more.
    pub(super) fn raise_heels(
        &self,
        generated: &mut [GeneratedFrame],
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
            let generated = &mut generated[..=last];
            let plant = self.plant(side);
            let level = from_heading(plant.heading);
            let stance = Stance {
                foot: &self.feet[side.index()],
                plant,
                from_level: level.inverse(),
                length: self.leg_lengths[side.index()],
            };
            let leaves = side != timing.leading;
            let flies = side == timing.leading && timing.take_off.is_some();
            let (bend, secs) = if flies {
                (TAKE_OFF_BEND, TAKE_OFF_SECS)
            } else {
                (LEAVING_BEND, LEAVING_SECS)
            };
            let most_extension = |index: usize| {
                let left_secs = last.saturating_sub(index) as f32 * self.frame_secs;
                if (leaves || flies) && left_secs < secs {
                    let left = 1.0 - left_secs / secs;
                    (half_bend + bend * left * left).cos()
                } else {
                    RISING_EXTENSION
                }
            };
            self.stand(side, generated, |leg| (leg.rise > 0.0).then_some(leg.pitch));
            let mut any = false;
            let blocks = generated.chunks_mut(LANES).zip(frames.chunks(LANES));
            for (block, (generated, frames)) in blocks.enumerate() {
                let at = |lane: usize| lane.min(generated.len() - 1);
                let leg = |lane: usize| &generated[at(lane)].legs[side.index()];
                let of_legs = |value: &dyn Fn(&GeneratedLeg) -> f32| {
                    f32x8::new(core::array::from_fn(|lane| value(leg(lane))))
                };
                let level = Quatx8::gather(|lane| frames[at(lane)].level);
                let hips = Vec3x8::gather(|lane| frames[at(lane)].pose.root_position);
                let legs = Legs {
                    level,
                    hip: hips + level * Vec3x8::gather(|lane| leg(lane).hip),
                    ankle: Vec3x8::gather(|lane| leg(lane).target.ankle),
                    pitch: of_legs(&|leg| leg.pitch),
                    rise: of_legs(&|leg| leg.rise),
                };
                let most = core::array::from_fn(|lane| most_extension(block * LANES + lane));
                let rises = stance.rises(&legs, f32x8::new(most));
                any |= rises.simd_gt(f32x8::ZERO).any();
                for (generated, rise) in generated.iter_mut().zip(rises.to_array()) {
                    generated.legs[side.index()].rise = rise;
                }
            }
            if any {
                smooth(generated, side);
                let risen = |leg: &GeneratedLeg| (leg.rise > 0.0).then_some(leg.pitch + leg.rise);
                self.stand(side, generated, risen);
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

/// The leg in eight frames, its foot as generated.
struct Legs {
    level: Quatx8,
    /// Place of the hip joint.
    hip: Vec3x8,
    ankle: Vec3x8,
    pitch: f32x8,
    /// Previous rise of the heel.
    rise: f32x8,
}

impl Stance<'_> {
    /// Returns the rise of the heels beyond the generated pitch that keeps the legs within these shares of their length, radians.
    fn rises(&self, legs: &Legs, most_extension: f32x8) -> f32x8 {
        let reach = legs.ankle - legs.hip;
        let extension = reach.length() * self.length.recip();
        let beyond = (extension - most_extension) * RISING_SOFTNESS.recip();
        let ahead = (legs.level.conjugate() * reach).z * (AHEAD * self.length).recip();
        let share = smooth_step(f32x8::ONE - ahead);
        let some = beyond.simd_ge(f32x8::splat(-MOST_SHORT))
            & legs.pitch.simd_ge(f32x8::ZERO)
            & share.simd_gt(f32x8::ZERO);
        if some.none() {
            return f32x8::ZERO;
        }
        let beyond = beyond.fast_min(f32x8::splat(MOST_BEYOND));
        let less = (f32x8::ONE + beyond.exp()).ln();
        let wanted = extension - share * RISING_SOFTNESS * less;
        // The hips have come down to what a leg with its heel up reaches, and no lower.
        let most = wanted.fast_min(f32x8::splat(MAX_STANCE_EXTENSION));
        let wanted = legs.rise.simd_gt(f32x8::ZERO).bitselect(most, wanted);
        let plant = Vec3x8::splat(self.plant.flat_ankle);
        let from_plant = Quatx8::splat(self.from_level) * (legs.hip - plant);
        let reach = wanted * self.length;
        let pitch = self
            .foot
            .pitches_within_reach(from_plant, reach, legs.pitch);
        let rise = (pitch - legs.pitch)
            .fast_max(f32x8::ZERO)
            .fast_min(f32x8::splat(MOST_RISE));
        some.bitselect(rise, f32x8::ZERO)
    }
}

/// Smooths the rise of a heel in time, less and less towards the ends of its stance.
fn smooth(generated: &mut [GeneratedFrame], side: Side) {
    let side = side.index();
    let last = generated.len() - 1;
    // Rises of the frames before, as they were.
    let mut before = [0.0; 2];
    for index in 0..generated.len() {
        let own = generated[index].legs[side].rise;
        let reach = index.min(last - index).min(before.len());
        let (mut sum, mut weights) = (SMOOTHED[0] * own, SMOOTHED[0]);
        for away in 1..=reach {
            sum += SMOOTHED[away] * (before[away - 1] + generated[index + away].legs[side].rise);
            weights += 2.0 * SMOOTHED[away];
        }
        // No less than its leg lacks, and none for a foot that stands on its heel.
        let leg = &mut generated[index].legs[side];
        leg.rise = if leg.pitch < 0.0 {
            own
        } else {
            own.max(sum / weights)
        };
        before = [own, before[0]];
    }
}
