//! Turn of the legs and the trunk in one step.

use super::Strafe;
use crate::ground::frame::PlantedFrame;
use crate::ground::generated::{GeneratedFrame, GeneratedLeg};
use crate::plan::StepTiming;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Side};
use footfall_ik::RockerFoot;
use glam::{Vec2, Vec3};

/// Greatest stretch of the standing leg in steps to the side, as a share of its length.
const STANDING_EXTENSION: f32 = 0.97;

/// Greatest stretch of a leg that lands to the side, as a share of its length; and the distance by which its hip is nearer to the foot than twice the widening, as a share
/// of the length.
const LANDING_EXTENSION: f32 = 0.97;
const HIP_SHARE: f32 = 0.06;

/// Least share of a leg's squared length that is left of it from the side.
const LEAST_HEIGHT: f32 = 0.5;

/// Greatest rise of toes and heels in a step backwards, radians, and its factor on that of a step forwards the other way
/// round: toes land steeper than heels do.
const BACKWARD_PITCH: f32 = 0.3;
const BACKWARD_GAIN: f32 = 1.8;

/// Share of the shortness of a swinging leg that is taken back in the middle of a swing to the side or backwards. Its foot stays flat, so its sole is higher than under the hanging toes of a
/// walk forwards: 8 cm instead of the 4 to 5 cm of people who walk backwards.
const LOWERED: f32 = 0.3;

/// Part of the swing after which a foot is independent of its stance.
const FREED_BY: f32 = 0.35;

/// Joints that turn the trunk back to the facing direction.
const BACK: [Joint; 3] = [Joint::Spine, Joint::Chest, Joint::UpperChest];

/// The legs of a body, and the heading under which their walk goes along +Z.
pub(crate) struct Turner<'a> {
    pub(crate) feet: &'a [RockerFoot; 2],
    /// Metres.
    pub(crate) leg_length: f32,
    /// Radians.
    pub(crate) own_facing: f32,
}

/// State of a swinging foot.
#[derive(Clone, Copy)]
struct Swing {
    /// Progress of the foot away from its stance, from 0 to 1.
    freed: f32,
    /// From 0 at the ends of the swing to 1 in its middle.
    middle: f32,
    /// Pitch at the mirrored time of the swing: backward steps swing as forward steps in reverse.
    mirrored: f32,
    /// Pitch at the landing.
    landing: f32,
}

impl Turner<'_> {
    /// Turns a forward step to its direction of travel, after a step turned by `before`.
    pub(crate) fn turn_step(
        &self,
        generated: &mut [GeneratedFrame],
        frames: &mut [PlantedFrame],
        timing: &StepTiming,
        [before, now]: [&Strafe; 2],
    ) {
        let trailing = timing.leading.other();
        let last = timing.frames;
        let swing_frames = (last - timing.terminal) as f32;
        let freed_by = FREED_BY * swing_frames;
        let landing = generated[last].legs[trailing.index()].free_pitch;
        for (index, frame) in frames.iter_mut().enumerate().take(last + 1) {
            let strafe = before.between(now, index as f32 / last as f32);
            let mirrored = (timing.terminal + last).saturating_sub(index).min(last);
            let mirrored = generated[mirrored].legs[trailing.index()].free_pitch;
            let swing = (index > timing.terminal).then(|| Swing {
                freed: smooth_step((index - timing.terminal) as f32 / freed_by),
                middle: (PI * (index - timing.terminal) as f32 / swing_frames)
                    .sin()
                    .powi(2),
                mirrored,
                landing,
            });
            let legs = &mut generated[index].legs;
            let rise =
                self.turn_standing(&strafe, timing.leading, &mut legs[timing.leading.index()]);
            self.turn_trailing(&strafe, trailing, &mut legs[trailing.index()], rise, swing);
            let back = from_heading(-strafe.turn / BACK.len() as f32);
            for joint in BACK {
                let rotation = &mut frame.pose.rotations[joint.index()];
                *rotation = (back * *rotation).normalize();
            }
        }
    }

    /// Turns the standing leg. In sideways steps its foot keeps its distance from the hip, within the reach of the leg.
    /// Returns the rise of the hips.
    fn turn_standing(&self, strafe: &Strafe, side: Side, leg: &mut GeneratedLeg) -> f32 {
        let foot = &self.feet[side.index()];
        let flat = leg.ankle - foot.roll(leg.pitch);
        let length = flat
            .distance(leg.hip)
            .min(STANDING_EXTENSION * self.leg_length);
        let pitch = standing_pitch(strafe, leg.pitch);
        let mut turned = self.turn_place(strafe, side, flat);
        let level = Vec2::new(turned.x - leg.hip.x, turned.z - leg.hip.z).length();
        let down = length * length - level * level;
        let down = down.max(LEAST_HEIGHT * length * length).sqrt();
        let kept = leg.hip.y - down.min(self.landing_height(strafe));
        turned.y += strafe.reach[0].abs().min(1.0) * (kept - turned.y);
        leg.put(turned + foot.roll(pitch), pitch, pitch);
        flat.y - turned.y
    }

    /// Returns the height of a hip above the ankle at which the leg reaches its landing place to the side.
    fn landing_height(&self, strafe: &Strafe) -> f32 {
        let leg = self.leg_length;
        let aside = (2.0 * strafe.widening - HIP_SHARE * leg).max(0.0);
        let height = (LANDING_EXTENSION * leg).powi(2) - aside * aside;
        height.max(LEAST_HEIGHT * leg * leg).sqrt()
    }

    /// Turns the other leg, below risen hips; `swing` is its state while its foot is in the air.
    fn turn_trailing(
        &self,
        strafe: &Strafe,
        side: Side,
        leg: &mut GeneratedLeg,
        rise: f32,
        swing: Option<Swing>,
    ) {
        let foot = &self.feet[side.index()];
        let standing = standing_pitch(strafe, leg.pitch);
        let place = |offset: Vec3| self.turn_place(strafe, side, leg.ankle - offset);
        let mut ankle = place(foot.roll(leg.pitch)) + foot.roll(standing);
        let mut pitch = standing;
        if let Some(swing) = swing {
            let swinging = turned_pitch(strafe, leg.free_pitch, swing.mirrored);
            // Toes that come down as the foot lands would make a flat foot fall.
            let tilted = leg.free_pitch.max(swing.landing.min(0.0));
            let free = place(foot.tilt(tilted)) + foot.tilt(swinging);
            ankle = ankle.lerp(free, swing.freed);
            let lowered = LOWERED * swing.middle * (1.0 - strafe.uprightness());
            ankle = self.lowered(ankle, leg.hip, lowered);
            pitch += swing.freed * (swinging - pitch);
        }
        leg.put(ankle - rise * Vec3::Y, pitch, standing);
    }

    /// Lowers an ankle so that its leg gains this share of what it lacks of a straight one.
    fn lowered(&self, ankle: Vec3, hip: Vec3, share: f32) -> Vec3 {
        let reach = ankle - hip;
        let length = reach.length();
        let longer = length + share * (self.leg_length - length).max(0.0);
        let down = longer * longer - reach.x * reach.x - reach.z * reach.z;
        hip + Vec3::new(reach.x, -down.max(0.0).sqrt(), reach.z)
    }

    /// Returns the target of a flat foot's ankle, relative to the hips. Its excursion is that of the middle of the sole, which is as far ahead of the
    /// hips as behind them in any walk.
    fn turn_place(&self, strafe: &Strafe, side: Side, ankle: Vec3) -> Vec3 {
        let middle = self.feet[side.index()].sole_middle();
        let place = from_heading(self.own_facing) * ankle + middle;
        let out = match side {
            Side::Left => strafe.widening,
            Side::Right => -strafe.widening,
        };
        let turned = Vec3::new(
            place.x + out + strafe.reach[0] * place.z,
            place.y,
            strafe.reach[1] * place.z,
        );
        from_heading(-self.own_facing) * (turned - middle)
    }
}

fn standing_pitch(strafe: &Strafe, forwards: f32) -> f32 {
    turned_pitch(strafe, forwards, -BACKWARD_GAIN * forwards)
}

/// Returns the pitch of a turned foot: reduced in sideways steps, replaced in backward steps.
fn turned_pitch(strafe: &Strafe, forwards: f32, backwards: f32) -> f32 {
    if strafe.forwardness >= 0.0 {
        forwards * strafe.forwardness
    } else {
        -strafe.forwardness * BACKWARD_PITCH * (backwards / BACKWARD_PITCH).tanh()
    }
}
