//! A frame of a step as a crowd keeps it: joints where they are drawn.

use crate::generator::GroundTransform;
use crate::planting::PlantedFrame;
use footfall_core::rotation::from_heading;
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use glam::{Quat, Vec3A};

/// Where a joint is and how it is turned against the T-pose, in the character's own space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct JointPlace {
    /// `character_from_joint` rotation.
    pub rotation: Quat,
    /// Position, metres.
    pub position: Vec3A,
}

#[derive(Clone, Debug, Default)]
pub(super) struct CrowdFrame {
    /// The character on the ground: `plan_from_character`.
    pub(super) place: GroundTransform,
    pub(super) contact: [bool; 2],
    joints: [JointPlace; JOINT_COUNT],
}

impl CrowdFrame {
    /// Becomes a frame on the ground that faces so much off its heading. `pose` and `model` are room to work in.
    pub(super) fn set(
        &mut self,
        frame: &PlantedFrame,
        facing: f32,
        skeleton: &Skeleton,
        pose: &mut Pose,
        model: &mut ModelPose,
    ) {
        self.place = GroundTransform {
            position: frame.ground_position,
            heading: frame.heading - facing,
        };
        self.contact = frame.contact;
        let character_from_plan = from_heading(-self.place.heading);
        let on_plan = frame.pose.root_position - self.place.position;
        pose.rotations = frame.pose.rotations;
        pose.root_position = character_from_plan * on_plan;
        let hips = &mut pose.rotations[Joint::Hips.index()];
        *hips = (character_from_plan * *hips).normalize();
        forward_kinematics(skeleton, pose, model);
        let places = model.rotations.iter().zip(&model.positions);
        for (joint, (rotation, position)) in self.joints.iter_mut().zip(places) {
            *joint = JointPlace {
                rotation: *rotation,
                position: (*position).into(),
            };
        }
    }

    /// Writes the blend of this frame towards the one that follows.
    pub(super) fn blend(&self, next: &Self, weight: f32, out: &mut [JointPlace; JOINT_COUNT]) {
        let pairs = self.joints.iter().zip(&next.joints);
        for (blend, (now, then)) in out.iter_mut().zip(pairs) {
            let sign = if now.rotation.dot(then.rotation) < 0.0 {
                -1.0
            } else {
                1.0
            };
            let sum = now.rotation * (1.0 - weight) + then.rotation * (sign * weight);
            blend.rotation = sum.normalize();
            blend.position = now.position.lerp(then.position, weight);
        }
    }
}
