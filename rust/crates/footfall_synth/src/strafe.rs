//! Facing one way and going another: sidestepping, walking backwards and everything between.
//!
//! The model knows walking forwards only, so its steps are turned under the body. What a leg does is taken apart into the place of its
//! foot, were it flat, and the roll of the foot about that place. The place's way to and fro is turned towards the travel; it is what
//! carries the body, so the body then travels there. The roll is taken away for going sideways and turned round for going backwards, where
//! people land on their toes and leave from their heels. Pelvis and feet turn part of the way, as people's do, and the back turns back.

use crate::planting::{PlantedFrame, StepTiming};
use crate::raw::{RawFrame, RawLeg};
use core::f32::consts::FRAC_PI_6;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Side, Skeleton};
use footfall_ik::RockerFoot;
use footfall_model::FEATURE_COUNT;
use footfall_model::layout::feature_offset;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// How far the pelvis turns towards the travel at most, radians: half way between the axes.
const MAX_PELVIS_TURN: f32 = FRAC_PI_6;

/// Slower than this the pelvis turns less, m/s: feet that hardly travel need no room.
const FULL_TURN_SPEED_MPS: f32 = 0.4;

/// Longest steps to the side and backwards, as shares of the leg. People's are shorter than those forwards.
const MAX_SIDE_STEP: f32 = 0.36;
const MAX_BACK_STEP: f32 = 0.6;

/// Feet that pass each other sideways keep this far from the middle, as a share of the leg, so that legs do not cross.
const PASSING_SHARE: f32 = 0.085;

/// How far the leg that stands is stretched at most in steps to the side, as a share of its length.
const STANDING_EXTENSION: f32 = 0.97;

/// Least share of a leg's squared length that is left of it from the side.
const LEAST_HEIGHT: f32 = 0.5;

/// How far toes and heels come up in a step backwards at most, radians, and how many times as much as a step forwards has it the other way
/// round: toes land steeper than heels do.
const BACKWARD_PITCH: f32 = 0.3;
const BACKWARD_GAIN: f32 = 1.8;

/// How much arms and trunk swing in steps to the side, as a share of a walk forwards.
const SIDE_SWAY: f32 = 0.25;

/// Part of the swing by which a foot is free of how it stood.
const FREED_BY: f32 = 0.35;

/// The joints that turn the trunk back to where the walker faces.
const BACK: [Joint; 3] = [Joint::Spine, Joint::Chest, Joint::UpperChest];

/// How a step's legs and trunk are turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Strafe {
    /// Where a metre of the legs' reach forwards goes: to the left and forwards, metres.
    pub(crate) reach: [f32; 2],
    /// How much it is a walk forwards: 1, sideways: 0, or backwards: -1.
    pub(crate) forwardness: f32,
    /// How far the pelvis is turned towards the travel, radians.
    pub(crate) turn: f32,
    /// By how much each foot is set further out, metres.
    pub(crate) widening: f32,
}

impl Strafe {
    /// The walk as it is.
    pub(crate) const NONE: Self = Self {
        reach: [0.0, 1.0],
        forwardness: 1.0,
        turn: 0.0,
        widening: 0.0,
    };

    /// For a step of this velocity (to the left and forwards, m/s) that lasts so long.
    pub(crate) fn of(velocity_mps: Vec2, step_secs: f32, skeleton: &Skeleton) -> Self {
        if velocity_mps.x == 0.0 && velocity_mps.y >= 0.0 {
            return Self::NONE;
        }
        let turn = pelvis_turn(velocity_mps);
        let direction = seen_from_pelvis(velocity_mps).normalize_or(Vec2::Y);
        let over = overstep(velocity_mps, step_secs, leg_length(skeleton));
        Self {
            reach: (direction / over.max(1.0)).to_array(),
            forwardness: direction.y,
            turn,
            ..Self::NONE
        }
    }

    /// Sets the feet of a step so far apart that they pass each other. `raw` is the step forwards.
    pub(crate) fn spread(mut self, raw: &[RawFrame], leg_length: f32) -> Self {
        let (mut apart, mut step) = (0.0, 0.0_f32);
        for raw in raw {
            let [left, right] = &raw.legs;
            apart += left.ankle.x - right.ankle.x;
            step = step.max((left.ankle.z - right.ankle.z).abs());
        }
        let stance = 0.5 * apart / raw.len() as f32;
        // Each leg goes half a step out and half a step in.
        let side_step = 0.5 * step * self.reach[0].abs();
        if side_step > 0.0 {
            self.widening = (side_step + PASSING_SHARE * leg_length - stance).max(0.0);
        }
        self
    }

    /// Every number of it.
    pub(crate) const fn numbers(&self) -> [f32; 5] {
        let [left, forwards] = self.reach;
        [left, forwards, self.forwardness, self.turn, self.widening]
    }

    /// At part `s` of a step, from what the step before was to what this one is.
    pub(crate) fn between(&self, next: &Self, s: f32) -> Self {
        let share = smooth_step(s);
        let mix = |from: f32, to: f32| from + share * (to - from);
        Self {
            reach: [0, 1].map(|axis| mix(self.reach[axis], next.reach[axis])),
            forwardness: mix(self.forwardness, next.forwardness),
            turn: mix(self.turn, next.turn),
            widening: mix(self.widening, next.widening),
        }
    }

    /// Turns the leg that stands, whose walk goes along +Z under the heading `own`. In steps to the side its foot stays as far from the hip as
    /// it is, or comes as close as the leg reaches; returns by how much the hips rise with it.
    fn turn_standing(
        &self,
        leg: &mut RawLeg,
        side: Side,
        foot: &RockerFoot,
        own: f32,
        leg_length: f32,
    ) -> f32 {
        let flat = leg.ankle - foot.roll(leg.pitch);
        let length = flat.distance(leg.hip).min(STANDING_EXTENSION * leg_length);
        let pitch = self.standing_pitch(leg.pitch);
        let mut turned = self.turn_place(flat, side, foot, own);
        let level = Vec2::new(turned.x - leg.hip.x, turned.z - leg.hip.z).length();
        let down = length * length - level * level;
        let kept = leg.hip.y - down.max(LEAST_HEIGHT * length * length).sqrt();
        turned.y += self.reach[0].abs().min(1.0) * (kept - turned.y);
        leg.put(turned + foot.roll(pitch), pitch, pitch);
        flat.y - turned.y
    }

    /// Turns the other leg, of hips that have risen; `swing` while its foot is in the air.
    fn turn_trailing(
        &self,
        leg: &mut RawLeg,
        side: Side,
        foot: &RockerFoot,
        own: f32,
        rise: f32,
        swing: Option<Swing>,
    ) {
        let standing = self.standing_pitch(leg.pitch);
        let place = |offset: Vec3| self.turn_place(leg.ankle - offset, side, foot, own);
        let mut ankle = place(foot.roll(leg.pitch)) + foot.roll(standing);
        let mut pitch = standing;
        if let Some(swing) = swing {
            let swinging = self.pitch(leg.free_pitch, swing.mirrored);
            let free = place(foot.tilt(leg.free_pitch)) + foot.tilt(swinging);
            ankle = ankle.lerp(free, swing.freed);
            pitch += swing.freed * (swinging - pitch);
        }
        leg.put(ankle - rise * Vec3::Y, pitch, standing);
    }

    /// Where the ankle of a flat foot goes, from the hips. Its excursion is that of the middle of the sole, which is as far ahead of the
    /// hips as behind them in any walk.
    fn turn_place(&self, ankle: Vec3, side: Side, foot: &RockerFoot, own: f32) -> Vec3 {
        let middle = foot.sole_middle();
        let place = from_heading(own) * ankle + middle;
        let out = match side {
            Side::Left => self.widening,
            Side::Right => -self.widening,
        };
        let turned = Vec3::new(
            place.x + out + self.reach[0] * place.z,
            place.y,
            self.reach[1] * place.z,
        );
        from_heading(-own) * (turned - middle)
    }

    fn standing_pitch(&self, forwards: f32) -> f32 {
        self.pitch(forwards, -BACKWARD_GAIN * forwards)
    }

    /// What becomes of a foot's pitch: less of it in steps to the side, another in steps backwards.
    fn pitch(&self, forwards: f32, backwards: f32) -> f32 {
        if self.forwardness >= 0.0 {
            forwards * self.forwardness
        } else {
            -self.forwardness * BACKWARD_PITCH * (backwards / BACKWARD_PITCH).tanh()
        }
    }
}

/// What there is to know about a swinging foot.
#[derive(Clone, Copy)]
struct Swing {
    /// How far it has come away from how it stood, from 0 to 1.
    freed: f32,
    /// Its pitch as long before the end of the swing as this is after its beginning: steps backwards swing as steps forwards do in reverse.
    mirrored: f32,
}

/// How far the pelvis turns towards a velocity to the left and forwards, m/s; radians, positive to the left.
///
/// Not at all along the axes: it faces forwards in steps forwards, sideways and backwards.
pub(crate) fn pelvis_turn(velocity_mps: Vec2) -> f32 {
    let direction = velocity_mps.normalize_or_zero();
    let share = smooth_step(velocity_mps.length() / FULL_TURN_SPEED_MPS);
    2.0 * direction.x * direction.y * MAX_PELVIS_TURN * share
}

/// How many times as long as people's steps a step of this velocity would be on legs of this length; at most 1 for one that is possible.
pub(crate) fn overstep(velocity_mps: Vec2, step_secs: f32, leg: f32) -> f32 {
    let step = seen_from_pelvis(velocity_mps) * step_secs / leg;
    Vec2::new(step.x / MAX_SIDE_STEP, step.y.min(0.0) / MAX_BACK_STEP).length()
}

/// Angles of headings are positive to the left, which is where x points; those of vectors are to y.
fn seen_from_pelvis(velocity_mps: Vec2) -> Vec2 {
    Vec2::from_angle(pelvis_turn(velocity_mps)).rotate(velocity_mps)
}

/// How much of the walk is left of arms and trunk: they swing against the legs, so they stop for steps to the side and turn round for
/// steps backwards. `middle` is the posture that they swing about.
pub(crate) fn sway(
    features: &mut [f32; FEATURE_COUNT],
    middle: &[f32; FEATURE_COUNT],
    strafe: Strafe,
) {
    let towards = if strafe.forwardness < 0.0 { 1.0 } else { -1.0 };
    let share = SIDE_SWAY + (1.0 + towards * SIDE_SWAY) * strafe.forwardness;
    for joint in Joint::ALL {
        let at = feature_offset(joint);
        let swings = match joint {
            // A trunk sways sideways and nods in any walk; only its turning goes with the legs.
            Joint::Hips | Joint::Spine | Joint::Chest | Joint::UpperChest => at + 1..at + 2,
            Joint::Neck | Joint::Head => continue,
            _ if is_arm(joint) => at..at + 3,
            _ => continue,
        };
        for index in swings {
            features[index] = middle[index] + share * (features[index] - middle[index]);
        }
    }
}

/// Turns a step that goes forwards to where it is to go, coming from a step that went as `before` says. `own` is the heading under
/// which the walk goes along +Z.
pub(crate) fn turn_step(
    raw: &mut [RawFrame],
    frames: &mut [PlantedFrame],
    timing: &StepTiming,
    feet: &[RockerFoot; 2],
    leg_length: f32,
    own: f32,
    [before, now]: [&Strafe; 2],
) {
    let trailing = timing.leading.other();
    let last = timing.frames;
    let freed_by = FREED_BY * (last - timing.terminal) as f32;
    for index in 0..=last {
        let strafe = before.between(now, index as f32 / last as f32);
        let mirrored = (timing.terminal + last).saturating_sub(index).min(last);
        let mirrored = raw[mirrored].legs[trailing.index()].free_pitch;
        let swing = (index > timing.terminal).then(|| Swing {
            freed: smooth_step((index - timing.terminal) as f32 / freed_by),
            mirrored,
        });
        let leading = timing.leading;
        let (leg, foot) = (
            &mut raw[index].legs[leading.index()],
            &feet[leading.index()],
        );
        let rise = strafe.turn_standing(leg, leading, foot, own, leg_length);
        let (leg, foot) = (
            &mut raw[index].legs[trailing.index()],
            &feet[trailing.index()],
        );
        strafe.turn_trailing(leg, trailing, foot, own, rise, swing);
        let back = from_heading(-strafe.turn / BACK.len() as f32);
        let rotations = &mut frames[index].pose.rotations;
        for joint in BACK {
            let rotation = &mut rotations[joint.index()];
            *rotation = (back * *rotation).normalize();
        }
    }
}

pub(crate) fn leg_length(skeleton: &Skeleton) -> f32 {
    0.5 * (skeleton.leg_length(Side::Left) + skeleton.leg_length(Side::Right))
}

const fn is_arm(joint: Joint) -> bool {
    matches!(
        joint,
        Joint::LeftShoulder
            | Joint::LeftUpperArm
            | Joint::LeftLowerArm
            | Joint::LeftHand
            | Joint::RightShoulder
            | Joint::RightUpperArm
            | Joint::RightLowerArm
            | Joint::RightHand
    )
}
