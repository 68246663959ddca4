//! Poses in local space, and forward kinematics to model space.

use crate::joint::{JOINT_COUNT, Joint};
use crate::rotation::blend_near;
use crate::skeleton::Skeleton;
use glam::{Quat, Vec3};

/// One frame of motion: where the hips are and how every joint is turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Position of the hips in the space of the clip, metres.
    pub root_position: Vec3,
    /// `parent_from_joint` rotation of each joint (for the hips: of the clip's space), identity in the T-pose.
    pub rotations: [Quat; JOINT_COUNT],
}

impl Default for Pose {
    fn default() -> Self {
        Self {
            root_position: Vec3::ZERO,
            rotations: [Quat::IDENTITY; JOINT_COUNT],
        }
    }
}

impl AsRef<Self> for Pose {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl AsMut<Self> for Pose {
    fn as_mut(&mut self) -> &mut Self {
        self
    }
}

impl Pose {
    /// The T-pose of a body that stands at the origin.
    pub fn rest(skeleton: &Skeleton) -> Self {
        Self {
            root_position: skeleton.offset(Joint::Hips),
            ..Self::default()
        }
    }

    /// Local rotation of one joint.
    pub fn rotation(&self, joint: Joint) -> Quat {
        self.rotations[joint.index()]
    }

    /// Returns true when position and rotations are finite.
    pub fn is_finite(&self) -> bool {
        self.root_position.is_finite() && self.rotations.iter().all(|turn| turn.is_finite())
    }

    /// The pose of the mirrored body: left and right change places in the plane x = 0.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut mirrored = self.clone();
        mirrored.root_position.x = -mirrored.root_position.x;
        for joint in Joint::ALL {
            let turn = self.rotation(joint.mirrored());
            mirrored.rotations[joint.index()] = Quat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w);
        }
        mirrored
    }

    /// Blends towards `other`: 0 keeps this pose, 1 takes the other. Rotations take the short way.
    #[must_use]
    pub fn interpolate(&self, other: &Self, weight: f32) -> Self {
        let mut blended = self.clone();
        blended.root_position = self.root_position.lerp(other.root_position, weight);
        for (rotation, target) in blended.rotations.iter_mut().zip(&other.rotations) {
            *rotation = rotation.slerp(*target, weight);
        }
        blended
    }

    /// Writes to `out` the blend of this pose towards a pose that follows it closely. As [`interpolate`](Self::interpolate)
    /// to within a ten-thousandth of the angle between them, and many times cheaper.
    pub fn interpolate_near(&self, other: &Self, weight: f32, out: &mut Self) {
        out.root_position = self.root_position.lerp(other.root_position, weight);
        let pairs = self.rotations.iter().zip(&other.rotations);
        // A flag waits less for the joint before than a minimum does.
        let mut short = false;
        for (blend, (rotation, target)) in out.rotations.iter_mut().zip(pairs.clone()) {
            let squared;
            (*blend, squared) = blend_near(*rotation, *target, weight);
            short |= squared < LEAST_SQUARED_LENGTH;
        }
        if short {
            // Seldom: the same rotation can be written with either sign, and frames far apart show quick swings.
            for (blend, (rotation, target)) in out.rotations.iter_mut().zip(pairs) {
                *blend = rotation.lerp(*target, weight);
            }
        }
    }
}

/// Blends of neighbouring rotations are longer than this, unless they are written with opposite signs or lie so far apart (0.2 radians) that one step of
/// Newton's method leaves them short by more than 4e-5.
const LEAST_SQUARED_LENGTH: f32 = 0.99;

/// A pose in model space: where every joint is and how it is turned there.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelPose {
    /// Position of each joint, metres.
    pub positions: [Vec3; JOINT_COUNT],
    /// `model_from_joint` rotation of each joint.
    pub rotations: [Quat; JOINT_COUNT],
}

impl Default for ModelPose {
    fn default() -> Self {
        Self {
            positions: [Vec3::ZERO; JOINT_COUNT],
            rotations: [Quat::IDENTITY; JOINT_COUNT],
        }
    }
}

impl ModelPose {
    /// Position of one joint.
    pub fn position(&self, joint: Joint) -> Vec3 {
        self.positions[joint.index()]
    }

    /// `model_from_joint` rotation of one joint.
    pub fn rotation(&self, joint: Joint) -> Quat {
        self.rotations[joint.index()]
    }

    /// All joints of a pose.
    pub fn of(skeleton: &Skeleton, pose: &Pose) -> Self {
        let mut model = Self::default();
        forward_kinematics(skeleton, pose, &mut model);
        model
    }

    /// A point given in a joint's space, in model space.
    pub fn point(&self, joint: Joint, joint_space: Vec3) -> Vec3 {
        self.position(joint) + self.rotation(joint) * joint_space
    }
}

/// Turns local rotations into positions and rotations in model space.
pub fn forward_kinematics(skeleton: &Skeleton, pose: &Pose, out: &mut ModelPose) {
    forward_kinematics_of(
        skeleton,
        core::array::from_ref(pose),
        core::array::from_mut(out),
    );
}

/// [`forward_kinematics`] of several poses. A joint waits for its parent, so four poses take little more time than one.
pub fn forward_kinematics_of<const N: usize>(
    skeleton: &Skeleton,
    poses: &[Pose; N],
    out: &mut [ModelPose; N],
) {
    for (pose, out) in poses.iter().zip(&mut *out) {
        out.positions[0] = pose.root_position;
        out.rotations[0] = pose.rotations[0];
    }
    for index in 1..JOINT_COUNT {
        let (parent, offset) = (PARENTS[index], skeleton.offsets[index]);
        for (pose, out) in poses.iter().zip(&mut *out) {
            let parent_rotation = out.rotations[parent];
            out.positions[index] = out.positions[parent] + parent_rotation * offset;
            out.rotations[index] = (parent_rotation * pose.rotations[index]).normalize();
        }
    }
}

/// Indices of the joints' parents, which come first; that of the hips is its own.
const PARENTS: [usize; JOINT_COUNT] = {
    let mut parents = [0; JOINT_COUNT];
    let mut index = 0;
    while index < JOINT_COUNT {
        if let Some(parent) = Joint::ALL[index].parent() {
            parents[index] = parent.index();
        }
        index += 1;
    }
    parents
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::exp_map;
    use proptest::prelude::*;

    fn any_pose() -> impl Strategy<Value = Pose> {
        proptest::collection::vec(-2.0_f32..2.0, JOINT_COUNT * 3 + 3).prop_map(|values| {
            let mut pose = Pose {
                root_position: Vec3::from_slice(&values),
                ..Pose::default()
            };
            for (rotation, value) in pose.rotations.iter_mut().zip(values[3..].chunks_exact(3)) {
                *rotation = exp_map(Vec3::from_slice(value));
            }
            pose
        })
    }

    proptest! {
        #[test]
        fn segments_keep_their_length(pose in any_pose()) {
            let skeleton = Skeleton::standard();
            let model = ModelPose::of(&skeleton, &pose);
            for joint in Joint::ALL {
                if let Some(parent) = joint.parent() {
                    let length = model.position(joint).distance(model.position(parent));
                    prop_assert!((length - skeleton.offset(joint).length()).abs() < 1e-5);
                }
            }
        }

        #[test]
        fn a_mirrored_pose_is_the_mirrored_body(pose in any_pose()) {
            let skeleton = Skeleton::standard();
            let (mut model, mut mirrored) = (ModelPose::default(), ModelPose::default());
            forward_kinematics(&skeleton, &pose, &mut model);
            forward_kinematics(&skeleton, &pose.mirrored(), &mut mirrored);
            for joint in Joint::ALL {
                let expected = model.position(joint.mirrored()) * Vec3::new(-1.0, 1.0, 1.0);
                prop_assert!(mirrored.position(joint).distance(expected) < 1e-4);
            }
        }

        #[test]
        fn near_interpolation_is_interpolation(a in any_pose(), weight in 0.0_f32..1.0) {
            let mut b = a.clone();
            for rotation in &mut b.rotations {
                *rotation *= Quat::from_rotation_x(0.1);
            }
            let mut near = Pose::default();
            a.interpolate_near(&b, weight, &mut near);
            for (near, exact) in near.rotations.iter().zip(&a.interpolate(&b, weight).rotations) {
                prop_assert!((*near - *exact).length().min((*near + *exact).length()) < 2e-5);
            }
        }

        #[test]
        fn interpolation_ends_at_its_ends(a in any_pose(), b in any_pose()) {
            for (blend, target) in [(a.interpolate(&b, 0.0), &a), (a.interpolate(&b, 1.0), &b)] {
                for (rotation, expected) in blend.rotations.iter().zip(&target.rotations) {
                    prop_assert!(rotation.angle_between(*expected) < 2e-3);
                }
            }
        }
    }
}
