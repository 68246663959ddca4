//! Joints to bones and back: what a `Skeleton3D` has, where its floor is, and how a pose is written to it.

mod layers;
mod read;

use crate::bones;
use crate::convert;
use crate::rest_body::{RestBody, RestJoints};
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_synth::CrowdPose;
use glam::{Affine3A, Quat, Vec3};
use godot::classes::{BoneMap, Skeleton3D};
use godot::prelude::*;
pub(crate) use layers::LayerWeights;

/// Facing is measured at the hips and rounded to this: a rest pose is seldom symmetric to the last degree.
const FACING_GRAIN: f32 = 5.0_f32.to_radians();

/// Why a skeleton cannot walk, for the user. Each says what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum BindingError {
    /// Required bones are missing.
    #[error(transparent)]
    MissingBones(#[from] bones::MissingBones),
    /// A bone does not hang where a body needs it.
    #[error(
        "Bone {bone} ({joint}) does not hang from {expected}. Correct the Bone Map, or the hierarchy of the skeleton.",
        joint = joint.name(),
        expected = expected.name()
    )]
    WrongParent {
        /// Name of the bone.
        bone: String,
        /// The joint that it is.
        joint: Joint,
        /// The joint that it should hang from.
        expected: Joint,
    },
    /// Left and right hip are not beside each other.
    #[error(
        "The rest pose does not stand upright: LeftUpperLeg and RightUpperLeg must be side by side in the Character's axes. \
         Give the skeleton a standing T-pose as its rest pose, or turn its node upright."
    )]
    NotStanding,
    /// A segment has no length.
    #[error("The rest pose cannot stand: {0}.")]
    Skeleton(#[from] footfall_core::SkeletonError),
}

/// A skeleton's bones as joints, with its body measured.
#[derive(Debug)]
pub(crate) struct SkeletonBinding {
    key: BindingKey,
    /// Proportions in metres of the world.
    pub(crate) body: Skeleton,
    /// From the floor under the body, facing +Z, to the character's node without its scale.
    pub(crate) character_from_ground: Affine3A,
    ground_from_skeleton: Affine3A,
    bones: Vec<BoundBone>,
    model_pose: ModelPose,
}

/// Inputs that the binding was made from. Where they differ, the binding has to be made anew.
#[derive(Debug, Clone, Copy)]
struct BindingKey {
    skeleton: InstanceId,
    version: u64,
    character_from_skeleton: Affine3A,
}

#[derive(Debug)]
struct BoundBone {
    bone: i32,
    /// The joint that it is.
    joint: Joint,
    /// The joint whose rotation it takes.
    turned_by: Joint,
    /// Its rotation in the T-pose, in the axes of the ground.
    ground_from_bone: Quat,
    /// Its own rotation in the rest pose.
    rest: Quat,
    /// The bone above that is a joint too, as a position in the list.
    parent: Option<usize>,
    /// The bones between it and that parent, highest first; above the hips, all.
    links: Vec<i32>,
}

impl SkeletonBinding {
    /// Measures a skeleton that is in the tree.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the skeleton.
    pub(crate) fn new(
        skeleton: &Gd<Skeleton3D>,
        character: &Gd<Node3D>,
        bone_map: Option<&Gd<BoneMap>>,
    ) -> Result<Self, BindingError> {
        let key = BindingKey::of(skeleton, character);
        let bones = bones::of_joints(skeleton, bone_map)?;
        let character_from_bone = |bone: i32| {
            key.character_from_skeleton * convert::affine(skeleton.get_bone_global_rest(bone))
        };
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
                let toes = bones[side.toes().index()]?;
                let end = *skeleton.get_bone_children(toes).as_slice().first()?;
                Some(to_level.transform_point3(character_from_bone(end).translation.into()))
            }),
            origin_height: key.character_from_skeleton.translation.y,
        };
        let rest = RestBody::new(&joints)?;
        let floor = Vec3::Y * rest.floor_height;
        let character_from_ground = level * Affine3A::from_translation(floor);
        let bones = bound_bones(skeleton, &bones, &rest, |bone| {
            turn.inverse() * convert::rotation(&character_from_bone(bone))
        })?;
        Ok(Self {
            key,
            body: rest.skeleton,
            character_from_ground,
            ground_from_skeleton: character_from_ground.inverse() * key.character_from_skeleton,
            bones,
            model_pose: ModelPose::default(),
        })
    }

    /// Returns whether it still holds for this skeleton and character.
    pub(crate) fn fits(&self, skeleton: &Gd<Skeleton3D>, character: &Gd<Node3D>) -> bool {
        self.scale_to(skeleton, character)
            .is_some_and(|scale| (scale - 1.0).abs() < 1e-3)
    }

    /// Size of this skeleton on this character relative to its size when it was measured; `None` for another one.
    pub(crate) fn scale_to(
        &self,
        skeleton: &Gd<Skeleton3D>,
        character: &Gd<Node3D>,
    ) -> Option<f32> {
        self.key.scale_to(&BindingKey::of(skeleton, character))
    }

    /// Writes hips and legs of a pose, given on the ground, to the bones; all others keep the pose that they have.
    pub(crate) fn write_legs(&mut self, skeleton: &mut Gd<Skeleton3D>, pose: &Pose) {
        self.write_where(skeleton, pose, is_leg);
    }

    /// Writes a pose, given on the ground, to the bones. Unmapped bones keep the pose that they have.
    pub(crate) fn write(&mut self, skeleton: &mut Gd<Skeleton3D>, pose: &Pose) {
        self.write_where(skeleton, pose, |_| true);
    }

    /// Writes a pose of which every joint is known on the ground.
    pub(crate) fn write_joints(&mut self, skeleton: &mut Gd<Skeleton3D>, pose: &CrowdPose) {
        for joint in Joint::ALL {
            self.model_pose.rotations[joint.index()] = pose.rotation(joint);
            self.model_pose.positions[joint.index()] = pose.position(joint);
        }
        self.write_model(skeleton, |_| true);
    }

    /// The joint whose rotation the bone of each joint takes.
    pub(crate) fn turned_by(&self) -> [Joint; JOINT_COUNT] {
        let mut turned_by = Joint::ALL;
        for bound in &self.bones {
            turned_by[bound.joint.index()] = bound.turned_by;
        }
        turned_by
    }

    /// The skeleton that was measured.
    pub(crate) fn skeleton(&self) -> InstanceId {
        self.key.skeleton
    }

    /// The bones that are posed, parents first; the hips' is the first.
    pub(crate) fn bones(&self) -> Vec<i32> {
        self.bones.iter().map(|bound| bound.bone).collect()
    }

    /// For every bone of the skeleton the joint that it moves with, and how its rest pose becomes the T-pose: from the skeleton's
    /// space to the ground. Bones above the hips move with them.
    pub(crate) fn t_pose_of_bones(&self, skeleton: &Gd<Skeleton3D>) -> Vec<(Joint, Affine3A)> {
        let mut t_pose = ModelPose::default();
        forward_kinematics(&self.body, &Pose::rest(&self.body), &mut t_pose);
        let of_bound = |bound: &BoundBone| {
            let rest = convert::affine(skeleton.get_bone_global_rest(bound.bone));
            let rest = self.ground_from_skeleton * rest;
            let turn = bound.ground_from_bone * convert::rotation(&rest).conjugate();
            let from_rest = Affine3A::from_rotation_translation(turn, t_pose.position(bound.joint))
                * Affine3A::from_translation(-Vec3::from(rest.translation));
            (bound.joint, from_rest * self.ground_from_skeleton)
        };
        let hips = self.bones.first().map(of_bound);
        (0..skeleton.get_bone_count())
            .filter_map(|bone| {
                let mut above = bone;
                while above >= 0 {
                    if let Some(bound) = self.bones.iter().find(|bound| bound.bone == above) {
                        return Some(of_bound(bound));
                    }
                    above = skeleton.get_bone_parent(above);
                }
                hips
            })
            .collect()
    }

    /// From the ground to the bone above the hips' bone.
    fn above_hips(&self, skeleton: &Gd<Skeleton3D>, links: &[i32]) -> Affine3A {
        links.iter().fold(self.ground_from_skeleton, |above, link| {
            above * convert::affine(skeleton.get_bone_pose(*link))
        })
    }

    fn write_where(
        &mut self,
        skeleton: &mut Gd<Skeleton3D>,
        pose: &Pose,
        wanted: impl Fn(Joint) -> bool,
    ) {
        forward_kinematics(&self.body, pose, &mut self.model_pose);
        self.write_model(skeleton, wanted);
    }

    /// Puts the hips in their place. Returns the rotation of what is above them on the ground.
    fn write_hips(&self, skeleton: &mut Gd<Skeleton3D>, hips: &BoundBone) -> Quat {
        let above = self.above_hips(skeleton, &hips.links);
        let place = self.model_pose.position(Joint::Hips);
        let position = above.inverse().transform_point3(place);
        skeleton.set_bone_pose_position(hips.bone, convert::vector3(position));
        convert::rotation(&above)
    }

    fn write_model(&self, skeleton: &mut Gd<Skeleton3D>, wanted: impl Fn(Joint) -> bool) {
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        for (index, bound) in self.bones.iter().enumerate() {
            if !wanted(bound.turned_by) {
                continue;
            }
            let above = if let Some(parent) = bound.parent {
                turned_by_links(skeleton, rotations[parent], &bound.links)
            } else {
                self.write_hips(skeleton, bound)
            };
            rotations[index] = self.model_pose.rotation(bound.turned_by) * bound.ground_from_bone;
            let local = (above.inverse() * rotations[index]).normalize();
            skeleton.set_bone_pose_rotation(bound.bone, convert::quaternion(local));
        }
    }
}

impl BindingKey {
    fn of(skeleton: &Gd<Skeleton3D>, character: &Gd<Node3D>) -> Self {
        let world_from_character = convert::unscaled(character.get_global_transform());
        let world_from_skeleton = skeleton.get_global_transform();
        Self {
            skeleton: skeleton.instance_id(),
            version: skeleton.get_version(),
            character_from_skeleton: convert::affine(
                world_from_character.affine_inverse() * world_from_skeleton,
            ),
        }
    }

    /// The size of the other by this one, when they are the same up to that and to what a walk through a large world does to single
    /// precision.
    fn scale_to(&self, other: &Self) -> Option<f32> {
        let (a, b) = (
            &self.character_from_skeleton,
            &other.character_from_skeleton,
        );
        let length = a.matrix3.x_axis.length().max(f32::MIN_POSITIVE);
        let scale = b.matrix3.x_axis.length() / length;
        let same = self.skeleton == other.skeleton
            && self.version == other.version
            && (a.matrix3 * scale).abs_diff_eq(b.matrix3, 1e-3 * scale * length)
            && (a.translation * scale).abs_diff_eq(b.translation, 1e-2 * scale.max(1.0));
        (same && scale > 0.0).then_some(scale)
    }
}

/// A rotation turned on by the bones between two joints.
fn turned_by_links(skeleton: &Gd<Skeleton3D>, above: Quat, links: &[i32]) -> Quat {
    links.iter().fold(above, |above, link| {
        above * convert::quat(skeleton.get_bone_pose_rotation(*link))
    })
}

/// Returns whether a joint is the hips or one of a leg.
fn is_leg(joint: Joint) -> bool {
    let of_leg = |side: Side| {
        [side.upper_leg(), side.lower_leg(), side.foot(), side.toes()].contains(&joint)
    };
    joint == Joint::Hips || Side::BOTH.into_iter().any(of_leg)
}

/// Heading of a body whose left hip joint is in this direction from the right one.
fn facing(to_left: Vec3) -> Option<f32> {
    let level = Vec3::new(to_left.x, 0.0, to_left.z);
    if level.length() < 0.5 * to_left.length() || to_left.length() < 1e-6 {
        return None;
    }
    // Heading 0 has +X to its left; turning left brings that towards -Z.
    let heading = (-level.z).atan2(level.x);
    Some((heading / FACING_GRAIN).round() * FACING_GRAIN)
}

/// Links each bone to the joint's bone above it.
fn bound_bones(
    skeleton: &Gd<Skeleton3D>,
    bones: &[Option<i32>; JOINT_COUNT],
    rest: &RestBody,
    ground_from_resting: impl Fn(i32) -> Quat,
) -> Result<Vec<BoundBone>, BindingError> {
    let mut bound: Vec<BoundBone> = Vec::with_capacity(JOINT_COUNT);
    for joint in Joint::ALL {
        let Some(bone) = bones[joint.index()] else {
            continue;
        };
        let mut links = Vec::new();
        let mut above = skeleton.get_bone_parent(bone);
        while above >= 0 && !bones.contains(&Some(above)) {
            links.insert(0, above);
            above = skeleton.get_bone_parent(above);
        }
        let mut expected = joint.parent();
        while let Some(parent) = expected
            && bones[parent.index()].is_none()
        {
            expected = parent.parent();
        }
        let expected_bone = expected.and_then(|parent| bones[parent.index()]);
        if expected_bone.unwrap_or(-1) != above {
            return Err(BindingError::WrongParent {
                bone: skeleton.get_bone_name(bone).to_string(),
                joint,
                expected: expected.unwrap_or(Joint::Hips),
            });
        }
        bound.push(BoundBone {
            bone,
            joint,
            turned_by: rest.turned_by[joint.index()],
            ground_from_bone: rest.t_pose_from_rest[joint.index()] * ground_from_resting(bone),
            rest: convert::rotation(&convert::affine(skeleton.get_bone_rest(bone))),
            parent: bound
                .iter()
                .position(|parent| Some(parent.bone) == expected_bone),
            links,
        });
    }
    Ok(bound)
}
