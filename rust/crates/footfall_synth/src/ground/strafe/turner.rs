//! Turn of the legs and the trunk in one step.

use super::Strafe;
use super::lift::{Lift, sole_below};
use crate::ground::frame::PlantedFrame;
use crate::ground::generated::{GeneratedFrame, GeneratedLeg};
use crate::ground::hip_height::MEETING_FROM;
use crate::plan::StepTiming;
use footfall_core::ease::{smooth_step, soft_min};
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Side};
use footfall_ik::RockerFoot;
use glam::{Vec2, Vec3};

/// Stretch of the standing leg in steps to the side, and greatest stretch of the landing leg, as shares of its length.
const STANDING_EXTENSION: [f32; 2] = [0.965, 0.978];
const LANDING_EXTENSION: [f32; 2] = [0.95, 0.97];

/// Greatest rise of the hips from their lowest place, between two steps to the side, as a share of the leg, and the distance over which it sets in, metres.
const BOB_SHARE: f32 = 0.06;
const BOB_SOFTNESS_M: f32 = 0.01;

/// Distance by which a hip is nearer to its foot than twice the widening, as a share of the leg.
const HIP_SHARE: f32 = 0.06;

/// Distance by which the hips are ahead of the middle between the feet in steps to the side, as a share of the leg: a foot still bears when the next has landed.
const LEAD_SHARE: f32 = 0.024;

/// Least share of a leg's squared length that is left of it from the side.
const LEAST_HEIGHT: f32 = 0.5;

/// Greatest rise of toes and heels in a step backwards, radians, and its factor on that of a step forwards the other way
/// round: toes land steeper than heels do.
const BACKWARD_PITCH: f32 = 0.3;
const BACKWARD_GAIN: f32 = 1.8;

/// Parts of the swing after which a foot, and its height, are independent of the stance.
const FREED_BY: f32 = 0.5;
const LIFTED_BY: f32 = 0.35;

/// Part of the rest of a swing over which a foot in the air takes its new direction.
const REDIRECTED_BY: f32 = 0.85;

/// Share of the way from the ankle to the middle of the sole: the point about which steps backwards are mirrored. Toes land behind, and the leg that leaves ahead is nearly straight. Ankles of four
/// of Bandai's actors who walk backwards at 1.1 to 1.2 m/s go from 0.32 m behind the hips to 0.33 m ahead.
const BACKWARD_MIDDLE: f32 = 0.3;

/// Joints that turn the trunk back to the facing direction.
const BACK: [Joint; 3] = [Joint::Spine, Joint::Chest, Joint::UpperChest];

/// The legs of a body, and the heading under which their walk goes along +Z.
pub(crate) struct Turner<'a> {
    pub(crate) feet: &'a [RockerFoot; 2],
    /// Metres.
    pub(crate) leg_length: f32,
    /// Radians.
    pub(crate) own_facing: f32,
    /// Factors on the legs' reach, before the step and after it.
    pub(crate) strides: [f32; 2],
}

/// A step's approach to standing, in which no leg is turned.
#[derive(Clone, Copy, Default)]
struct Rest {
    /// Share of it: 0 inside a walk, 1 at the end of a step that ends standing.
    share: f32,
    /// Distance of the middle of each sole ahead of the hips in standing, metres.
    ahead: [f32; 2],
}

/// State of a swinging foot.
#[derive(Clone, Copy)]
struct Swing {
    /// Progress of the foot away from its stance, from 0 to 1.
    freed: f32,
    /// The same of its height.
    lifted: f32,
    /// Pitch at the mirrored time of the swing: backward steps swing as forward steps in reverse.
    mirrored: f32,
    /// Pitch at the landing.
    landing: f32,
    /// Height of the sole's lowest point, from the hips as generated, metres.
    sole: f32,
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
        let (leading, trailing) = (timing.leading, timing.leading.other());
        let last = timing.frames;
        let swing_frames = (last - timing.terminal) as f32;
        let landing = generated[last].legs[trailing.index()].free_pitch;
        let lift = Lift::of(self, generated, timing);
        let end = self.rest(&generated[last], timing);
        let [landed, standing] = [(trailing, LANDING_EXTENSION), (leading, STANDING_EXTENSION)]
            .map(|(side, stretch)| {
                let leg = &generated[last].legs[side.index()];
                let flat = leg.flat_ankle(&self.feet[side.index()]);
                let turned = self.turn_place((now, &end), side, flat);
                self.rise((now, &end), leg.hip, [flat, turned], stretch)
            });
        let meeting = landed - standing;
        for (index, frame) in frames.iter_mut().enumerate().take(last + 1) {
            let part = index as f32 / last as f32;
            let strafe = before.between(now, self.strides, part);
            let rest = Rest {
                share: smooth_step(part) * end.share,
                ..end
            };
            let mirrored = (timing.terminal + last).saturating_sub(index).min(last);
            let mirrored = generated[mirrored].legs[trailing.index()].free_pitch;
            let legs = &mut generated[index].legs;
            let standing = &mut legs[leading.index()];
            let flat = standing.flat_ankle(&self.feet[leading.index()]);
            let turned = self.turn_place((&strafe, &rest), leading, flat);
            let places = [flat, turned];
            let rise = self.rise((&strafe, &rest), standing.hip, places, STANDING_EXTENSION);
            let pitch = standing_pitch(&strafe, standing.pitch);
            let roll = self.feet[leading.index()].roll(pitch);
            standing.put(turned - rise * Vec3::Y + roll, pitch, pitch);
            let swing = (timing.airborne || index > timing.terminal).then(|| {
                let s = (index - timing.terminal) as f32 / swing_frames;
                Swing {
                    freed: smooth_step(s / FREED_BY),
                    lifted: if timing.airborne {
                        1.0
                    } else {
                        smooth_step(s / LIFTED_BY)
                    },
                    mirrored,
                    landing,
                    sole: flat.y + lift.sole(s),
                }
            });
            let meeting_part = (part - MEETING_FROM) / (1.0 - MEETING_FROM);
            let rise = rise + smooth_step(meeting_part) * meeting;
            let redirected = if timing.airborne {
                before.between(now, self.strides, (part / REDIRECTED_BY).min(1.0))
            } else {
                strafe
            };
            self.turn_trailing(
                (&redirected, &rest),
                trailing,
                &mut legs[trailing.index()],
                rise,
                swing,
            );
            let back = from_heading(-strafe.turn / BACK.len() as f32);
            for joint in BACK {
                let rotation = &mut frame.pose.rotations[joint.index()];
                *rotation = (back * *rotation).normalize();
            }
        }
    }

    /// Returns the rise of the hips over a bearing leg: in sideways steps its flat foot keeps its distance from the hip, within the reach of the leg.
    /// The flat foot's ankle is given as generated and as turned.
    fn rise(
        &self,
        (strafe, rest): (&Strafe, &Rest),
        hip: Vec3,
        [flat, turned]: [Vec3; 2],
        [least, most]: [f32; 2],
    ) -> f32 {
        let length = flat
            .distance(hip)
            .clamp(least * self.leg_length, most * self.leg_length);
        let level = Vec2::new(turned.x - hip.x, turned.z - hip.z).length();
        let down = length * length - level * level;
        let down = down.max(LEAST_HEIGHT * length * length).sqrt();
        let down = soft_min(
            down,
            self.lowest_height(strafe) + BOB_SHARE * self.leg_length,
            BOB_SOFTNESS_M,
        );
        let aside = strafe.reach[0].abs().min(1.0) * (1.0 - rest.share);
        aside * (turned.y - (hip.y - down))
    }

    /// Returns the height of a hip above the ankle at which a leg reaches its place farthest to the side.
    fn lowest_height(&self, strafe: &Strafe) -> f32 {
        let leg = self.leg_length;
        let aside = (2.0 * strafe.widening - HIP_SHARE * leg).max(0.0);
        let height = (LANDING_EXTENSION[1] * leg).powi(2) - aside * aside;
        height.max(LEAST_HEIGHT * leg * leg).sqrt()
    }

    /// Turns the other leg, below risen hips; `swing` is its state while its foot is in the air.
    fn turn_trailing(
        &self,
        (strafe, rest): (&Strafe, &Rest),
        side: Side,
        leg: &mut GeneratedLeg,
        rise: f32,
        swing: Option<Swing>,
    ) {
        let foot = &self.feet[side.index()];
        let standing = standing_pitch(strafe, leg.pitch);
        let place = |offset: Vec3| self.turn_place((strafe, rest), side, leg.ankle - offset);
        let mut ankle = place(foot.roll(leg.pitch)) + foot.roll(standing);
        let mut pitch = standing;
        if let Some(swing) = swing {
            let swinging = turned_pitch(strafe, leg.free_pitch, swing.mirrored);
            // Toes that come down as the foot lands would make a flat foot fall.
            let tilted = leg.free_pitch.max(swing.landing.min(0.0));
            let mut free = place(foot.tilt(tilted)) + foot.tilt(swinging);
            let lifted = swing.sole - sole_below(foot, swinging);
            let turned = 1.0 - strafe.uprightness();
            free.y += turned * (lifted - free.y);
            let up = ankle.y + swing.lifted * (free.y - ankle.y);
            ankle = ankle.lerp(free, swing.freed);
            ankle.y += turned * (up - ankle.y);
            pitch += swing.freed * (swinging - pitch);
        }
        leg.put(ankle - rise * Vec3::Y, pitch, standing);
    }

    /// Returns the standing in which a step ends, whose last frame is given: none of it inside a walk.
    fn rest(&self, last: &GeneratedFrame, timing: &StepTiming) -> Rest {
        if !timing.rests {
            return Rest::default();
        }
        let ahead = Side::BOTH.map(|side| {
            let foot = &self.feet[side.index()];
            let flat = last.legs[side.index()].flat_ankle(foot);
            (from_heading(self.own_facing) * flat + foot.sole_middle()).z
        });
        Rest { share: 1.0, ahead }
    }

    /// Returns the target of a flat foot's ankle, relative to the hips. Its excursion is that of the middle of the sole, which is about as far
    /// ahead of the hips as behind them in walks forwards and to the side; backwards, that of a point nearer to the ankle. Who comes to rest stands as after a walk forwards.
    fn turn_place(&self, (strafe, rest): (&Strafe, &Rest), side: Side, ankle: Vec3) -> Vec3 {
        let walks = 1.0 - rest.share;
        let share = 1.0 + walks * strafe.backwardness() * (BACKWARD_MIDDLE - 1.0);
        let middle = share * self.feet[side.index()].sole_middle();
        let place = from_heading(self.own_facing) * ankle + middle;
        let out = match side {
            Side::Left => strafe.widening,
            Side::Right => -strafe.widening,
        };
        let stood = rest.share * rest.ahead[side.index()];
        let excursion = place.z - stood;
        let lead = walks * LEAD_SHARE * self.leg_length;
        let turned = Vec3::new(
            place.x + out + strafe.reach[0] * (excursion - lead),
            place.y,
            stood + strafe.reach[1] * excursion,
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
