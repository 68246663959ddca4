//! A `Skeleton3D` as a body: [`RigBinding`] measures it and moves poses; here are the engine's bones and the engine's words.

use crate::{bones, convert};
use footfall_core::Pose;
pub(crate) use footfall_rig::LayerWeights;
use footfall_rig::{Bones, RigBinding, joint_bones, relative_size};
use footfall_synth::CrowdPose;
use glam::{Affine3A, Quat, Vec3};
use godot::classes::{BoneMap, Skeleton3D};
use godot::prelude::*;
use std::fmt;
use std::ops::Deref;

/// Reasons why a skeleton cannot walk, for the user, with what to do.
#[derive(Debug)]
pub(crate) struct BindingError(footfall_rig::BindingError);

impl fmt::Display for BindingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use footfall_rig::BindingError as Rig;
        match &self.0 {
            Rig::MissingJoints(missing) => write!(
                f,
                "The skeleton {}. Set this node's Bone Map (Bone Map, New BoneMap) and assign these bones, or reimport the character \
                 with a BoneMap (Advanced Import Settings, Skeleton3D, Retarget).",
                missing.findings()
            ),
            Rig::WrongParent {
                bone,
                joint,
                expected,
            } => write!(
                f,
                "Bone {bone} ({}) is not below {} in the hierarchy. Correct the Bone Map or the skeleton.",
                joint.name(),
                expected.name()
            ),
            Rig::NotStanding => f.write_str(
                "The rest pose does not stand upright: LeftUpperLeg and RightUpperLeg must be side by side in the Character's axes. \
                 Give the skeleton a standing T-pose as its rest pose, or turn its node upright.",
            ),
            Rig::Skeleton(error) => write!(f, "The rest pose cannot be used: {error}."),
        }
    }
}

/// A skeleton's bones as joints, with its body measured in metres of the world.
#[derive(Debug)]
pub(crate) struct SkeletonBinding {
    key: BindingKey,
    rig: RigBinding,
}

/// Inputs that the binding was made from. Where they differ, the binding has to be made anew.
#[derive(Debug, Clone, Copy)]
struct BindingKey {
    skeleton: InstanceId,
    version: u64,
    character_from_skeleton: Affine3A,
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
        let rest = bones::at_rest(skeleton);
        let rig = joint_bones(rest.rig(), &bones::mapped(skeleton, bone_map))
            .map_err(footfall_rig::BindingError::from)
            .and_then(|bones| RigBinding::new(&rest, &bones, &key.character_from_skeleton))
            .map_err(BindingError)?;
        Ok(Self { key, rig })
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
        let now = BindingKey::of(skeleton, character);
        let key = &self.key;
        let same = key.skeleton == now.skeleton && key.version == now.version;
        let [measured, now] = [key, &now].map(|key| key.character_from_skeleton);
        relative_size(&measured, &now).filter(|_| same)
    }

    /// The skeleton that was measured.
    pub(crate) fn skeleton(&self) -> InstanceId {
        self.key.skeleton
    }

    /// The bones that are posed, as the engine counts them, parents first; the hips' is the first.
    pub(crate) fn bones(&self) -> Vec<i32> {
        self.rig.bones().map(convert::count).collect()
    }

    /// Writes hips and legs of a pose: [`RigBinding::write_legs`].
    pub(crate) fn write_legs(&mut self, skeleton: &Gd<Skeleton3D>, pose: &Pose) {
        self.rig.write_legs(&mut Posed(&mut skeleton.clone()), pose);
    }

    /// Writes a pose: [`RigBinding::write`].
    pub(crate) fn write(&mut self, skeleton: &Gd<Skeleton3D>, pose: &Pose) {
        self.rig.write(&mut Posed(&mut skeleton.clone()), pose);
    }

    /// Writes a pose of a crowd's walker: [`RigBinding::write_joints`].
    pub(crate) fn write_joints(&mut self, skeleton: &Gd<Skeleton3D>, pose: &CrowdPose) {
        self.rig
            .write_joints(&mut Posed(&mut skeleton.clone()), pose);
    }

    /// Writes a pose in layers: [`RigBinding::write_layered`].
    pub(crate) fn write_layered(
        &mut self,
        skeleton: &Gd<Skeleton3D>,
        pose: &Pose,
        weights: &LayerWeights,
    ) {
        self.rig
            .write_layered(&mut Posed(&mut skeleton.clone()), pose, weights);
    }

    /// Reads hips and legs of the pose that the skeleton has: [`RigBinding::read_legs`].
    pub(crate) fn read_legs(&self, skeleton: &Gd<Skeleton3D>, pose: &mut Pose) {
        self.rig.read_legs(&Posed(&mut skeleton.clone()), pose);
    }

    /// Reads the pose that the skeleton has: [`RigBinding::read`].
    pub(crate) fn read(&self, skeleton: &Gd<Skeleton3D>, pose: &mut Pose) {
        self.rig.read(&Posed(&mut skeleton.clone()), pose);
    }
}

/// Measurements: proportions, the ground, which bones.
impl Deref for SkeletonBinding {
    type Target = RigBinding;

    fn deref(&self) -> &RigBinding {
        &self.rig
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
}

/// The poses of a skeleton's bones. It borrows what the `Gd` points to: the `Gd` itself looks up its class and asks whether the object lives at every
/// call, which takes as long as the call.
struct Posed<'a>(&'a mut Skeleton3D);

impl Bones for Posed<'_> {
    fn rotation(&self, bone: usize) -> Quat {
        convert::quat(self.0.get_bone_pose_rotation(convert::count(bone)))
    }

    fn position(&self, bone: usize) -> Vec3 {
        convert::vec3(self.0.get_bone_pose_position(convert::count(bone)))
    }

    fn transform(&self, bone: usize) -> Affine3A {
        convert::affine(self.0.get_bone_pose(convert::count(bone)))
    }

    fn set_rotation(&mut self, bone: usize, rotation: Quat) {
        let rotation = convert::quaternion(rotation);
        self.0
            .set_bone_pose_rotation(convert::count(bone), rotation);
    }

    fn set_position(&mut self, bone: usize, position: Vec3) {
        let position = convert::vector3(position);
        self.0
            .set_bone_pose_position(convert::count(bone), position);
    }
}
