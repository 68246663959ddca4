//! Writing of a body's pose to the bones of a rig.

use super::bones::{BoundBone, turned_by_links};
use super::{Bones, RigBinding, is_leg};
use footfall_core::rotation::of_transform;
use footfall_core::{JOINT_COUNT, Joint, Pose, forward_kinematics};
use footfall_synth::CrowdPose;
use glam::Quat;

impl RigBinding {
    /// Writes hips and legs of a pose, given on the ground, to the bones; all others keep their pose.
    pub fn write_legs(&mut self, bones: &mut impl Bones, pose: &Pose) {
        self.write_where(bones, pose, is_leg);
    }

    /// Writes a pose, given on the ground, to the bones. Bones without a joint keep their pose.
    pub fn write(&mut self, bones: &mut impl Bones, pose: &Pose) {
        self.write_where(bones, pose, |_| true);
    }

    /// Writes a pose in which every joint is given on the ground.
    pub fn write_joints(&mut self, bones: &mut impl Bones, pose: &CrowdPose) {
        for joint in Joint::ALL {
            self.model_pose.rotations[joint.index()] = pose.rotation(joint);
            self.model_pose.positions[joint.index()] = pose.position(joint);
        }
        self.write_model(bones, |_| true);
    }

    fn write_where(&mut self, bones: &mut impl Bones, pose: &Pose, wanted: impl Fn(Joint) -> bool) {
        forward_kinematics(&self.body, pose, &mut self.model_pose);
        self.write_model(bones, wanted);
    }

    /// Places the hips. Returns the rotation of the bone above them on the ground.
    pub(super) fn write_hips(&self, bones: &mut impl Bones, hips: &BoundBone) -> Quat {
        let above = self.above_hips(bones, &hips.links);
        let place = self.model_pose.position(Joint::Hips);
        bones.set_position(hips.bone, above.inverse().transform_point3(place));
        of_transform(&above)
    }

    fn write_model(&self, bones: &mut impl Bones, wanted: impl Fn(Joint) -> bool) {
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        for (index, bound) in self.bones.iter().enumerate() {
            if !wanted(bound.turned_by) {
                continue;
            }
            let above = if let Some(parent) = bound.parent {
                turned_by_links(bones, rotations[parent], &bound.links)
            } else {
                self.write_hips(bones, bound)
            };
            rotations[index] = self.model_pose.rotation(bound.turned_by) * bound.ground_from_bone;
            let local = (above.inverse() * rotations[index]).normalize();
            bones.set_rotation(bound.bone, local);
        }
    }
}
