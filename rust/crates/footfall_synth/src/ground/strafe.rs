//! Facing one way and going another: sidestepping, walking backwards and everything between.
//!
//! The model only knows forward walking, so its steps are turned under the body. The motion of a leg is split into the place of its flat
//! foot and the roll of the foot about that place. The excursion of the place is turned towards the direction of travel and carries the body
//! there. The roll is removed for sideways steps and reversed for backward steps, in which
//! people land on their toes and leave from their heels. Pelvis and feet turn part of the way, as people's do, and the back turns back.

mod lift;
mod turner;

use super::generated::GeneratedFrame;
use crate::gait::{overstep, pelvis_turn, seen_from_pelvis};
use footfall_core::ease::smooth_step;
use footfall_core::rotation::exp_map;
use footfall_core::{JOINT_COUNT, Joint, Side, Skeleton};
use footfall_model::FEATURE_COUNT;
use footfall_model::layout::{self, feature_offset};
use glam::{Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};
pub(crate) use turner::Turner;

/// Largest factors by which steps to the side and backwards are lengthened to their intended length. Backwards, the first step after a walk forwards would be a lunge.
const MOST_LENGTHENED: [f32; 2] = [1.8, 1.15];

/// Likeness to a walk forwards, less than 1, from which steps are lengthened in full.
const ASIDE: f32 = 0.1;

/// Feet that pass each other sideways keep this far from the middle, as a share of the leg, so that legs do not cross.
const PASSING_SHARE: f32 = 0.095;

/// Swing of arms and trunk in steps to the side, as a share of a walk forwards.
const SIDE_SWAY: f32 = 0.25;

/// Least factor on the legs' reach with which the direction of a step counts.
const LEAST_STRIDE: f32 = 0.25;

/// Turn of a step's legs and trunk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Strafe {
    /// Displacement for each metre of the legs' reach forwards: to the left and forwards, metres.
    pub(crate) reach: [f32; 2],
    /// Likeness to a walk forwards: 1, sideways: 0, or backwards: -1.
    pub(crate) forwardness: f32,
    /// Turn of the pelvis towards the travel, radians.
    pub(crate) turn: f32,
    /// Outward shift of each foot, metres.
    pub(crate) widening: f32,
}

impl Strafe {
    /// An unturned walk.
    pub(crate) const NONE: Self = Self {
        reach: [0.0, 1.0],
        forwardness: 1.0,
        turn: 0.0,
        widening: 0.0,
    };

    /// Returns the turn for a step of this velocity, to the left and forwards, m/s, and duration.
    pub(crate) fn of(velocity_mps: Vec2, step_secs: f32, skeleton: &Skeleton) -> Self {
        if velocity_mps.x == 0.0 && velocity_mps.y >= 0.0 {
            return Self::NONE;
        }
        let turn = pelvis_turn(velocity_mps);
        let direction = seen_from_pelvis(velocity_mps).normalize_or(Vec2::Y);
        let over = overstep(velocity_mps, step_secs, skeleton.mean_leg_length());
        Self {
            reach: (direction / over.max(1.0)).to_array(),
            forwardness: direction.y,
            turn,
            ..Self::NONE
        }
    }

    /// Spreads the feet so that they pass each other. `generated` is the forward step.
    pub(crate) fn spread(mut self, generated: &[GeneratedFrame], leg_length: f32) -> Self {
        let apart = |generated: &GeneratedFrame| {
            let [left, right] = &generated.legs;
            left.ankle - right.ankle
        };
        let stance = generated.iter().map(|frame| apart(frame).x).sum::<f32>();
        let stance = 0.5 * stance / generated.len() as f32;
        // Its first frames may belong to longer steps.
        let step = generated
            .last()
            .map_or(0.0, |landing| apart(landing).z.abs());
        // Each leg goes half a step out and half a step in.
        let side_step = 0.5 * step * self.reach[0].abs();
        if side_step > 0.0 {
            self.widening = (side_step + PASSING_SHARE * leg_length - stance).max(self.widening);
        }
        self
    }

    /// Lengthens the legs' reach to the intended length of the step: a shortened step of a quick walk covers less than its share of a whole one. The nearer to straight ahead, the
    /// less it is, for there paces are measured. `flat_m` is its length forwards, `wanted_m` the intended one, metres.
    pub(crate) fn lengthened(mut self, flat_m: f32, wanted_m: Option<f32>) -> Self {
        if let Some(wanted_m) = wanted_m
            && flat_m > 0.0
        {
            let [side, back] = MOST_LENGTHENED;
            let most = side + self.backwardness() * (back - side);
            let longer = (wanted_m / flat_m).clamp(1.0, most) - 1.0;
            let aside = smooth_step((1.0 - self.forwardness) / ASIDE);
            let factor = 1.0 + aside * longer;
            self.reach = self.reach.map(|axis| axis * factor);
        }
        self
    }

    /// Returns the turn with which a step of this turn ends: none where it ends standing.
    pub(crate) const fn at_end(self, rests: bool) -> Self {
        if rests { Self::NONE } else { self }
    }

    /// Straightness of landing and standing legs, from 0 to 1: as people's in a walk forwards, less in steps to the side and backwards.
    pub(crate) fn uprightness(&self) -> f32 {
        self.forwardness.max(0.0).powi(2)
    }

    /// Likeness to a walk backwards, from 0 to 1.
    pub(crate) const fn backwardness(&self) -> f32 {
        (-self.forwardness).max(0.0)
    }

    /// Returns all values.
    pub(crate) const fn numbers(&self) -> [f32; 5] {
        let [left, forwards] = self.reach;
        [left, forwards, self.forwardness, self.turn, self.widening]
    }

    /// Interpolates from the previous step to this one, at part `s` of the step. `strides` are the factors on the legs' reach in both: the direction of longer steps counts for more, so
    /// that a body that has all but stopped sets off without going the old way first.
    pub(crate) fn between(&self, next: &Self, strides: [f32; 2], s: f32) -> Self {
        let share = smooth_step(s);
        let [before, after] = strides.map(|stride| stride.max(LEAST_STRIDE));
        let reaching = share * after / (before + share * (after - before));
        let mix = |from: f32, to: f32, share: f32| from + share * (to - from);
        Self {
            reach: [0, 1].map(|axis| mix(self.reach[axis], next.reach[axis], reaching)),
            forwardness: mix(self.forwardness, next.forwardness, share),
            turn: mix(self.turn, next.turn, share),
            widening: mix(self.widening, next.widening, share),
        }
    }
}

/// Decodes the features of a frame in a turned step, in which arms and trunk swing less. `middle` is the posture about which they swing.
pub(crate) fn decode_turned(
    features: &mut [f32; FEATURE_COUNT],
    middle: &[f32; FEATURE_COUNT],
    strafe: Strafe,
    rotations: &mut [Quat; JOINT_COUNT],
) {
    let pelvis = pelvis_of(features);
    sway(features, middle, strafe);
    layout::decode(features, rotations);
    keep_legs(rotations, pelvis);
}

/// Reduces the swing of arms and trunk: they swing against the legs, so they stop in sideways steps and reverse in
/// backward steps. `middle` is the posture about which they swing.
fn sway(features: &mut [f32; FEATURE_COUNT], middle: &[f32; FEATURE_COUNT], strafe: Strafe) {
    let towards = if strafe.forwardness < 0.0 { 1.0 } else { -1.0 };
    let share = SIDE_SWAY + (1.0 + towards * SIDE_SWAY) * strafe.forwardness;
    for joint in Joint::ALL {
        let at = feature_offset(joint);
        let swings = match joint {
            // A trunk sways sideways and nods in any walk; only its turning goes with the legs.
            Joint::Hips | Joint::Spine | Joint::Chest | Joint::UpperChest => at + 1..at + 2,
            Joint::Neck | Joint::Head => continue,
            _ if joint.is_of_arm() => at..at + 3,
            _ => continue,
        };
        for index in swings {
            features[index] = middle[index] + share * (features[index] - middle[index]);
        }
    }
}

/// Rotation of the pelvis in these features.
fn pelvis_of(features: &[f32; FEATURE_COUNT]) -> Quat {
    let at = feature_offset(Joint::Hips);
    exp_map(Vec3::from_slice(&features[at..at + 3]))
}

/// Leaves the legs where they were under a pelvis of rotation `before`: they swing as in a walk forwards whatever the pelvis does.
fn keep_legs(rotations: &mut [Quat; JOINT_COUNT], before: Quat) {
    let back = rotations[Joint::Hips.index()].inverse() * before;
    for side in Side::BOTH {
        let thigh = &mut rotations[side.upper_leg().index()];
        *thigh = (back * *thigh).normalize();
    }
}
