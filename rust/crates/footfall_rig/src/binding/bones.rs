//! Bones of an engine, and the links between the joints' bones.

use super::BindingError;
use crate::rest_body::RestBody;
use crate::rest_rig::RestRig;
use footfall_core::rotation::of_transform;
use footfall_core::{JOINT_COUNT, Joint};
use glam::{Affine3A, Quat, Vec3};

/// Poses of a rig's bones in an engine: each relative to its parent bone, by its index in the [`RestRig`].
///
/// An engine that stores rotation and position separately should implement the optional methods, which avoids decomposing a matrix.
pub trait Bones {
    /// Returns position, rotation and scale of a bone.
    fn transform(&self, bone: usize) -> Affine3A;

    /// Returns the rotation of a bone, of length 1.
    fn rotation(&self, bone: usize) -> Quat {
        of_transform(&self.transform(bone))
    }

    /// Returns the position of a bone.
    fn position(&self, bone: usize) -> Vec3 {
        self.transform(bone).translation.into()
    }

    /// Sets the rotation of a bone.
    fn set_rotation(&mut self, bone: usize, rotation: Quat);

    /// Sets the position of a bone.
    fn set_position(&mut self, bone: usize, position: Vec3);
}

/// Bone of a joint.
#[derive(Clone, Debug)]
pub(super) struct BoundBone {
    pub(super) bone: usize,
    /// Joint of the bone.
    pub(super) joint: Joint,
    /// Joint whose rotation it takes.
    pub(super) turned_by: Joint,
    /// Rotation in the T-pose, in the axes of the ground.
    pub(super) ground_from_bone: Quat,
    /// Own rotation in the rest pose.
    pub(super) rest: Quat,
    /// Next bone above with a joint, as a position in the list.
    pub(super) parent: Option<usize>,
    /// Bones between it and that parent, highest first; above the hips, all.
    pub(super) links: Vec<usize>,
}

/// Links each bone to the joint's bone above it.
pub(super) fn bind(
    rig: &RestRig,
    bones: &[Option<usize>; JOINT_COUNT],
    rest: &RestBody,
    ground_from_resting: impl Fn(usize) -> Quat,
) -> Result<Vec<BoundBone>, BindingError> {
    let mut bound: Vec<BoundBone> = Vec::with_capacity(JOINT_COUNT);
    for joint in Joint::ALL {
        let Some(bone) = bones[joint.index()] else {
            continue;
        };
        let mut links: Vec<usize> = Vec::new();
        let mut above = None;
        for next in rig.rig().above(bone) {
            if bones.contains(&Some(next)) {
                above = Some(next);
                break;
            }
            links.insert(0, next);
        }
        let mut expected = joint.parent();
        while let Some(parent) = expected
            && bones[parent.index()].is_none()
        {
            expected = parent.parent();
        }
        let expected_bone = expected.and_then(|parent| bones[parent.index()]);
        if expected_bone != above {
            return Err(BindingError::WrongParent {
                bone: rig.rig().names()[bone].clone(),
                joint,
                expected: expected.unwrap_or(Joint::Hips),
            });
        }
        bound.push(BoundBone {
            bone,
            joint,
            turned_by: rest.turned_by[joint.index()],
            ground_from_bone: rest.t_pose_from_rest[joint.index()] * ground_from_resting(bone),
            rest: of_transform(&rig.own_rest(bone)),
            parent: bound
                .iter()
                .position(|parent| Some(parent.bone) == expected_bone),
            links,
        });
    }
    Ok(bound)
}

/// Applies to a rotation the bones between two joints.
pub(super) fn turned_by_links(bones: &impl Bones, above: Quat, links: &[usize]) -> Quat {
    links
        .iter()
        .fold(above, |above, link| above * bones.rotation(*link))
}

/// Returns the scale of the second transform relative to the first; `None` if they differ in more than scale and the single-precision error of a large
/// world.
pub fn relative_size(measured: &Affine3A, now: &Affine3A) -> Option<f32> {
    let length = measured.matrix3.x_axis.length().max(f32::MIN_POSITIVE);
    let scale = now.matrix3.x_axis.length() / length;
    let same = (measured.matrix3 * scale).abs_diff_eq(now.matrix3, 1e-3 * scale * length)
        && (measured.translation * scale).abs_diff_eq(now.translation, 1e-2 * scale.max(1.0));
    (same && scale > 0.0).then_some(scale)
}
