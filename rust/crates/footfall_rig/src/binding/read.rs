//! Reading of a body's pose from a rig.

use super::bones::turned_by_links;
use super::{Bones, RigBinding, is_leg};
use footfall_core::rotation::of_transform;
use footfall_core::{JOINT_COUNT, Joint, Pose};
use glam::Quat;

impl RigBinding {
    /// Reads the pose of the bones of hips and legs, on the ground; other joints of `pose` stay as they are.
    pub fn read_legs(&self, bones: &impl Bones, pose: &mut Pose) {
        self.read_where(bones, pose, is_leg);
    }

    /// Reads the pose of all bones, on the ground. A joint without a bone moves with the joint below it.
    pub fn read(&self, bones: &impl Bones, pose: &mut Pose) {
        self.read_where(bones, pose, |_| true);
    }

    fn read_where(&self, bones: &impl Bones, pose: &mut Pose, wanted: impl Fn(Joint) -> bool) {
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        let mut turned: [Option<Quat>; JOINT_COUNT] = [None; JOINT_COUNT];
        for (index, bound) in self.bones.iter().enumerate() {
            if !wanted(bound.turned_by) {
                continue;
            }
            let above = if let Some(parent) = bound.parent {
                turned_by_links(bones, rotations[parent], &bound.links)
            } else {
                let above = self.above_hips(bones, &bound.links);
                let hips = bones.position(bound.bone);
                pose.root_position = above.transform_point3(hips);
                of_transform(&above)
            };
            let local = bones.rotation(bound.bone);
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
