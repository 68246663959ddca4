//! Reading of a skeleton as a pose of the body.

use super::{SkeletonBinding, is_leg, turned_by_links};
use crate::convert;
use footfall_core::{JOINT_COUNT, Joint, Pose};
use glam::Quat;
use godot::classes::Skeleton3D;
use godot::prelude::*;

impl SkeletonBinding {
    /// Reads how the bones of hips and legs are posed, on the ground; other joints of `pose` stay as they are.
    pub(crate) fn read_legs(&self, skeleton: &Gd<Skeleton3D>, pose: &mut Pose) {
        self.read_where(skeleton, pose, is_leg);
    }

    /// Reads how all bones are posed, on the ground. A joint without a bone moves with the one below it.
    pub(crate) fn read(&self, skeleton: &Gd<Skeleton3D>, pose: &mut Pose) {
        self.read_where(skeleton, pose, |_| true);
    }

    fn read_where(
        &self,
        skeleton: &Gd<Skeleton3D>,
        pose: &mut Pose,
        wanted: impl Fn(Joint) -> bool,
    ) {
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        let mut turned: [Option<Quat>; JOINT_COUNT] = [None; JOINT_COUNT];
        for (index, bound) in self.bones.iter().enumerate() {
            if !wanted(bound.turned_by) {
                continue;
            }
            let above = if let Some(parent) = bound.parent {
                turned_by_links(skeleton, rotations[parent], &bound.links)
            } else {
                let above = self.above_hips(skeleton, &bound.links);
                let hips = convert::vec3(skeleton.get_bone_pose_position(bound.bone));
                pose.root_position = above.transform_point3(hips);
                convert::rotation(&above)
            };
            let local = convert::quat(skeleton.get_bone_pose_rotation(bound.bone));
            rotations[index] = (above * local).normalize();
            let model = rotations[index] * bound.ground_from_bone.conjugate();
            turned[bound.turned_by.index()] = Some(model);
        }
        let mut models = [Quat::IDENTITY; JOINT_COUNT];
        for joint in Joint::ALL {
            if !wanted(joint) {
                continue;
            }
            let below = joint
                .parent()
                .map_or(Quat::IDENTITY, |parent| models[parent.index()]);
            let model = turned[joint.index()].unwrap_or(below);
            models[joint.index()] = model;
            pose.rotations[joint.index()] = (below.conjugate() * model).normalize();
        }
    }
}
