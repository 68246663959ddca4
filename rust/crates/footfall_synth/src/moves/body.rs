//! A body whose posture changes over feet that have their own places.

use footfall_core::rotation::exp_map;
use footfall_core::{Joint, Pose, Side, Skeleton};
use footfall_ik::{
    FootTarget, Leg, Plant, RockerFoot, foot_heading, foot_pitch, reach_height, settled_pitch,
};
use footfall_model::BESIDE_COUNT;
use footfall_model::layout::feature_offset;
use glam::Vec3;

/// A posture beside standing: see [`BESIDE_COUNT`].
pub(super) type Beside = [f32; BESIDE_COUNT];

/// Fraction of the straight leg that a leg which pushes off uses at most.
const MOST_STRETCHED: f32 = 0.996;

/// One body, ready to be moved.
#[derive(Clone, Debug)]
pub(super) struct Body {
    legs: [Leg; 2],
    pub(super) feet: [RockerFoot; 2],
    hip_from_hips: [Vec3; 2],
    leg_lengths: [f32; 2],
    /// Their mean, metres.
    pub(super) leg_length: f32,
}

impl Body {
    pub(super) fn new(skeleton: &Skeleton) -> Self {
        Self {
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            feet: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            hip_from_hips: Side::BOTH.map(|side| skeleton.offset(side.upper_leg())),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            leg_length: skeleton.mean_leg_length(),
        }
    }

    /// Where the feet of a pose are.
    pub(super) fn feet(&self, pose: &Pose) -> [FootTarget; 2] {
        Side::BOTH.map(|side| {
            let hips = pose.rotation(Joint::Hips);
            let thigh = hips * pose.rotation(side.upper_leg());
            let shank = thigh * pose.rotation(side.lower_leg());
            let foot = shank * pose.rotation(side.foot());
            let hip = hips * self.hip_from_hips[side.index()];
            let reach = self.legs[side.index()].ankle_from_hip(thigh, shank);
            FootTarget {
                ankle: pose.root_position + hip + reach,
                foot,
                toes: foot * pose.rotation(side.toes()),
            }
        })
    }

    /// Turns the joints of a pose that stands by those of a posture beside standing.
    pub(super) fn turn(beside: &Beside, pose: &mut Pose) {
        for joint in Joint::ALL {
            let at = feature_offset(joint);
            let turn = exp_map(Vec3::new(beside[at], beside[at + 1], beside[at + 2]));
            pose.rotations[joint.index()] *= turn;
        }
    }

    /// Where the feet of a pose that stands are put.
    pub(super) fn plants(&self, pose: &Pose) -> [Plant; 2] {
        let stood = self.feet(pose);
        core::array::from_fn(|side| {
            let FootTarget { ankle, foot, .. } = stood[side];
            self.feet[side].plant_under(ankle, foot_heading(foot), foot_pitch(foot))
        })
    }

    /// Feet that stand on plants, moved by this much, at the pitch of a pose; nobody jumps on the heels.
    pub(super) fn on_toes(&self, plants: &[Plant; 2], moved: Vec3, pose: &Pose) -> [FootTarget; 2] {
        let feet = self.feet(pose);
        core::array::from_fn(|side| {
            let pitch = settled_pitch(foot_pitch(feet[side].foot).max(0.0));
            let plant = Plant {
                flat_ankle: plants[side].flat_ankle + moved,
                ..plants[side]
            };
            self.feet[side].stand(&plant, pitch)
        })
    }

    /// Greatest height of the hips of a pose from which both legs reach these feet without being quite straight, metres.
    pub(super) fn highest(&self, pose: &Pose, targets: &[FootTarget; 2]) -> f32 {
        let hips = pose.root_position;
        let limits = Side::BOTH.map(|side| {
            let hip = pose.rotation(Joint::Hips) * self.hip_from_hips[side.index()];
            let (ankle, length) = (targets[side.index()].ankle, self.leg_lengths[side.index()]);
            reach_height(hips, hip, ankle, length, MOST_STRETCHED).unwrap_or(hips.y)
        });
        limits[0].min(limits[1])
    }

    /// Solves the legs to where the feet have to be.
    pub(super) fn stand(&self, targets: &[FootTarget; 2], pose: &mut Pose) {
        let (hips, rotation) = (pose.root_position, pose.rotation(Joint::Hips));
        for (leg, target) in self.legs.iter().zip(targets) {
            leg.solve(hips, rotation, target, pose);
        }
    }
}
