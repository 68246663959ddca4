//! Poses of a loop as tracks of an animation.

use super::stage;
use crate::convert;
use crate::skeleton_binding::SkeletonBinding;
use footfall_synth::LoopedWalk;
use glam::Vec3;
use godot::classes::animation::{LoopMode, TrackType};
use godot::classes::{Animation, Skeleton3D};
use godot::prelude::*;

/// Rotations closer to each other than this are one, as cosines of half of their angle.
const SAME_TURN: f32 = 1.0 - 1e-9;
const SAME_PLACE_M: f32 = 1e-6;

/// Makes animations for one skeleton.
pub(super) struct Clips {
    binding: SkeletonBinding,
    /// A copy of the skeleton at rest, apart from the tree, that poses are put on.
    posed: Gd<Skeleton3D>,
    /// Path of the skeleton.
    path: String,
    root: Root,
}

/// Track of the root.
struct Root {
    path: NodePath,
    /// Place before any travel.
    rest: Vector3,
    /// Travel of the root for a metre ahead.
    ahead: Vector3,
}

impl Clips {
    /// For a skeleton in the tree.
    pub(super) fn of(
        skeleton: &Gd<Skeleton3D>,
        character: &Gd<Node3D>,
        binding: SkeletonBinding,
    ) -> Self {
        let path = path_of(skeleton);
        let world_from_character = character.get_global_transform().orthonormalized();
        let world_from_ground =
            convert::affine(world_from_character) * binding.character_from_ground;
        let ahead = convert::vector3(world_from_ground.transform_vector3(Vec3::Z));
        Self {
            root: Root::of(skeleton, binding.bones()[0], ahead, &path),
            posed: copy_at_rest(skeleton),
            path,
            binding,
        }
    }

    pub(super) fn binding(&self) -> &SkeletonBinding {
        &self.binding
    }

    /// The track that `AnimationMixer.root_motion_track` is to name.
    pub(super) fn root_path(&self) -> &NodePath {
        &self.root.path
    }

    /// A loop as an animation.
    pub(super) fn animation(&mut self, walk: &LoopedWalk) -> Gd<Animation> {
        let mut animation = Animation::new_gd();
        let bones = self.binding.bones();
        let hips = bones[0];
        let mut keys = vec![Vec::with_capacity(walk.poses.len()); bones.len()];
        let mut places = Vec::with_capacity(walk.poses.len());
        for pose in &walk.poses {
            self.binding.write(&self.posed, pose);
            for (bone, keys) in bones.iter().zip(&mut keys) {
                keys.push(self.posed.get_bone_pose_rotation(*bone));
            }
            places.push(self.posed.get_bone_pose_position(hips));
        }
        let secs = f64::from(walk.duration_secs());
        animation.set_length(walk.duration_secs());
        animation.set_loop_mode(LoopMode::LINEAR);
        let track = animation.add_track(TrackType::POSITION_3D);
        animation.track_set_path(track, &self.root.path);
        let end = self.root.rest + self.root.ahead * (walk.speed_mps * walk.duration_secs());
        animation.position_track_insert_key(track, 0.0, self.root.rest);
        animation.position_track_insert_key(track, secs, end);

        let at = |frame: usize| f64::from(frame as f32 * walk.frame_secs);
        let track = animation.add_track(TrackType::POSITION_3D);
        animation.track_set_path(track, &self.bone_path(hips));
        for frame in needed_keys(&places, |a, b| a.distance_to(*b) < SAME_PLACE_M) {
            animation.position_track_insert_key(track, at(frame), places[frame]);
        }
        for (bone, keys) in bones.iter().zip(&keys) {
            let track = animation.add_track(TrackType::ROTATION_3D);
            animation.track_set_path(track, &self.bone_path(*bone));
            for frame in needed_keys(keys, |a, b| a.dot(*b).abs() > SAME_TURN) {
                animation.rotation_track_insert_key(track, at(frame), keys[frame]);
            }
        }
        animation
    }

    fn bone_path(&self, bone: i32) -> NodePath {
        let path = format!("{}:{}", self.path, self.posed.get_bone_name(bone));
        NodePath::from(&path)
    }
}

impl Drop for Clips {
    fn drop(&mut self) {
        self.posed.clone().free();
    }
}

impl Root {
    /// `ahead` is where the character faces, in global space.
    fn of(skeleton: &Gd<Skeleton3D>, hips: i32, ahead: Vector3, path: &str) -> Self {
        let ahead_in = |parent: Transform3D| parent.basis.inverse() * ahead;
        let (mut bone, mut top) = (hips, None);
        while skeleton.get_bone_parent(bone) >= 0 {
            bone = skeleton.get_bone_parent(bone);
            top = Some(bone);
        }
        if let Some(bone) = top {
            let name = skeleton.get_bone_name(bone);
            return Self {
                path: NodePath::from(&format!("{path}:{name}")),
                rest: skeleton.get_bone_rest(bone).origin,
                ahead: ahead_in(skeleton.get_global_transform()),
            };
        }
        let parent = skeleton.get_parent_node_3d();
        Self {
            path: NodePath::from(path),
            rest: skeleton.get_position(),
            ahead: ahead_in(parent.map_or(Transform3D::IDENTITY, |parent| {
                parent.get_global_transform()
            })),
        }
    }
}

/// The skeleton's path from its scene's root, by its unique name where it has one.
fn path_of(skeleton: &Gd<Skeleton3D>) -> String {
    if skeleton.is_unique_name_in_owner() {
        return format!("%{}", skeleton.get_name());
    }
    stage(skeleton).map_or_else(
        || skeleton.get_name().to_string(),
        |stage| stage.get_path_to(skeleton).to_string(),
    )
}

fn copy_at_rest(skeleton: &Gd<Skeleton3D>) -> Gd<Skeleton3D> {
    let mut copy = Skeleton3D::new_alloc();
    for bone in 0..skeleton.get_bone_count() {
        copy.add_bone(&skeleton.get_bone_name(bone));
    }
    for bone in 0..skeleton.get_bone_count() {
        copy.set_bone_parent(bone, skeleton.get_bone_parent(bone));
        copy.set_bone_rest(bone, skeleton.get_bone_rest(bone));
    }
    copy.reset_bone_poses();
    copy
}

/// The frames whose keys cannot be interpolated: both ends, and those that differ from the one before or the one after.
fn needed_keys<T>(keys: &[T], same: impl Fn(&T, &T) -> bool) -> Vec<usize> {
    let last = keys.len().saturating_sub(1);
    (0..keys.len())
        .filter(|&frame| {
            frame == 0
                || frame == last && !keys[1..].iter().all(|key| same(key, &keys[0]))
                || frame != last
                    && !(same(&keys[frame - 1], &keys[frame])
                        && same(&keys[frame], &keys[frame + 1]))
        })
        .collect()
}
