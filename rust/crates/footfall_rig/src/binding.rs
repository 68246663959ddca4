//! Binding of joints and bones: a game's rig measured as a body, and poses converted between the two.

mod bones;
mod layers;
mod read;
mod write;

use crate::joints::MissingJoints;
use crate::rest_body::{RestBody, RestJoints};
use crate::rest_rig::RestRig;
pub use bones::{Bones, relative_size};
use bones::{BoundBone, bind};
use footfall_core::rotation::of_transform;
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Side, Skeleton};
use footfall_ik::placement::Frame;
use glam::{Affine3A, Quat, Vec3};
pub use layers::LayerWeights;

/// Rounding of the facing direction, which is measured at the hips: a rest pose is seldom symmetric to the last degree.
const FACING_GRAIN: f32 = 5.0_f32.to_radians();

/// Reasons why a rig cannot be a body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BindingError {
    /// Required joints have no bones.
    #[error(transparent)]
    MissingJoints(#[from] MissingJoints),
    /// A bone is not below the expected joint.
    #[error(
        "bone {bone} ({joint}) is not below {expected} in the hierarchy; correct the map of joints or the rig",
        joint = joint.name(),
        expected = expected.name()
    )]
    WrongParent {
        /// Name of the bone.
        bone: String,
        /// Joint of the bone.
        joint: Joint,
        /// Joint that should be above it.
        expected: Joint,
    },
    /// Left and right hip are not beside each other.
    #[error(
        "the rest pose does not stand upright: LeftUpperLeg and RightUpperLeg must be side by side in the character's axes; give the rig a \
         standing T-pose as its rest pose, or turn it upright"
    )]
    NotStanding,
    /// A segment has no length.
    #[error("the rest pose cannot be used: {0}")]
    Skeleton(#[from] footfall_core::SkeletonError),
}

/// Bones of a rig as joints, with the measured body.
#[derive(Clone, Debug)]
pub struct RigBinding {
    /// Proportions in the character's units: metres for an unscaled character.
    pub body: Skeleton,
    /// Transform from the floor under the body, facing +Z, to the character.
    pub character_from_ground: Affine3A,
    ground_from_rig: Affine3A,
    bones: Vec<BoundBone>,
    model_pose: ModelPose,
}

impl RigBinding {
    /// Measures a rig with these joints' bones, as from [`joint_bones`](crate::joint_bones).
    ///
    /// # Errors
    /// [`BindingError`] when the bones do not form a standing body.
    pub fn new(
        rig: &RestRig,
        bones: &[Option<usize>; JOINT_COUNT],
        character_from_rig: &Affine3A,
    ) -> Result<Self, BindingError> {
        let character_from_bone = |bone: usize| *character_from_rig * rig.rest(bone);
        let place = |joint: Joint| {
            bones[joint.index()].map(|bone| Vec3::from(character_from_bone(bone).translation))
        };
        let to_left = place(Joint::LeftUpperLeg).unwrap_or_default()
            - place(Joint::RightUpperLeg).unwrap_or_default();
        let facing = facing(to_left).ok_or(BindingError::NotStanding)?;
        let turn = Quat::from_rotation_y(facing);
        let hips = place(Joint::Hips).unwrap_or_default();
        let level = Affine3A::from_rotation_translation(turn, Vec3::new(hips.x, 0.0, hips.z));
        let to_level = level.inverse();

        let joints = RestJoints {
            positions: core::array::from_fn(|index| {
                place(Joint::ALL[index]).map(|position| to_level.transform_point3(position))
            }),
            toe_ends: Side::BOTH.map(|side| {
                let end = rig.first_below(bones[side.toes().index()]?)?;
                Some(to_level.transform_point3(character_from_bone(end).translation.into()))
            }),
            origin_height: character_from_rig.translation.y,
        };
        let rest = RestBody::new(&joints)?;
        let floor = Vec3::Y * rest.floor_height;
        let character_from_ground = level * Affine3A::from_translation(floor);
        let bones = bind(rig, bones, &rest, |bone| {
            turn.inverse() * of_transform(&character_from_bone(bone))
        })?;
        Ok(Self {
            body: rest.skeleton,
            character_from_ground,
            ground_from_rig: character_from_ground.inverse() * *character_from_rig,
            bones,
            model_pose: ModelPose::default(),
        })
    }

    /// Returns the joint whose rotation the bone of each joint takes: its own, or that of a missing joint above it.
    pub fn turned_by(&self) -> [Joint; JOINT_COUNT] {
        let mut turned_by = Joint::ALL;
        for bound in &self.bones {
            turned_by[bound.joint.index()] = bound.turned_by;
        }
        turned_by
    }

    /// Returns the ground under the body of a character at this place, in the body's facing direction.
    pub fn world_from_ground(&self, world_from_character: &Frame) -> Frame {
        world_from_character.child(&self.ground())
    }

    /// Returns the place of a character whose body stands on this ground: the transform for an engine's object that carries the rig. Inverse of
    /// [`world_from_ground`](Self::world_from_ground).
    pub fn world_from_character(&self, world_from_ground: &Frame) -> Frame {
        world_from_ground.child(&self.ground().local(&Frame::IDENTITY))
    }

    fn ground(&self) -> Frame {
        Frame {
            position: self.character_from_ground.translation.into(),
            rotation: of_transform(&self.character_from_ground),
        }
    }

    /// Returns the posed bones, parents first; the hips' bone is the first.
    pub fn bones(&self) -> impl Iterator<Item = usize> {
        self.bones.iter().map(|bound| bound.bone)
    }

    /// Returns, for every bone of the measured rig, the joint that it moves with, and the transform of its rest pose to the T-pose: from the rig's space to the
    /// ground. Bones above the hips move with them.
    pub fn t_pose_of_bones(&self, rig: &RestRig) -> Vec<(Joint, Affine3A)> {
        let t_pose = ModelPose::of(&self.body, &Pose::rest(&self.body));
        let of_bound = |bound: &BoundBone| {
            let rest = self.ground_from_rig * rig.rest(bound.bone);
            let turn = bound.ground_from_bone * of_transform(&rest).conjugate();
            let from_rest = Affine3A::from_rotation_translation(turn, t_pose.position(bound.joint))
                * Affine3A::from_translation(-Vec3::from(rest.translation));
            (bound.joint, from_rest * self.ground_from_rig)
        };
        let hips = self.bones.first().map(of_bound);
        (0..rig.rig().len())
            .filter_map(|bone| {
                let mut chain = core::iter::once(bone).chain(rig.rig().above(bone));
                let bound = |bone: usize| self.bones.iter().find(|bound| bound.bone == bone);
                chain.find_map(bound).map(of_bound).or(hips)
            })
            .collect()
    }

    /// Transform from the ground to the bone above the hips' bone.
    fn above_hips(&self, bones: &impl Bones, links: &[usize]) -> Affine3A {
        links.iter().fold(self.ground_from_rig, |above, link| {
            above * bones.transform(*link)
        })
    }
}

/// Returns true for the hips and the joints of legs.
fn is_leg(joint: Joint) -> bool {
    let of_leg = |side: Side| {
        [side.upper_leg(), side.lower_leg(), side.foot(), side.toes()].contains(&joint)
    };
    joint == Joint::Hips || Side::BOTH.into_iter().any(of_leg)
}

/// Returns the heading of a body whose left hip joint is in this direction from the right one.
fn facing(to_left: Vec3) -> Option<f32> {
    let level = Vec3::new(to_left.x, 0.0, to_left.z);
    if level.length() < 0.5 * to_left.length() || to_left.length() < 1e-6 {
        return None;
    }
    // Heading 0 has +X to its left; turning left brings that towards -Z.
    let heading = (-level.z).atan2(level.x);
    Some((heading / FACING_GRAIN).round() * FACING_GRAIN)
}

#[cfg(test)]
mod tests;
