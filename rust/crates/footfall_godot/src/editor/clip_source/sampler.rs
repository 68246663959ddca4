//! An animation's tracks as poses of a skeleton's bones.

use crate::convert;
use footfall_motion::skeletal::{Bone, SkeletalMotion};
use glam::Affine3A;
use godot::classes::animation::TrackType;
use godot::classes::{Animation, Skeleton3D};
use godot::prelude::*;

/// Rate where the animation's step gives none, frames per second.
const USUAL_RATE_HZ: f64 = 30.0;
const PLAUSIBLE_RATES_HZ: std::ops::RangeInclusive<f64> = 15.0..=240.0;
/// Longest animation that is sampled, seconds.
const LONGEST_SECS: f64 = 600.0;

/// A track of one bone.
struct Track {
    index: i32,
    kind: TrackType,
    bone: usize,
}

/// Number of a skeleton's bones that an animation turns.
pub(super) fn bones_turned(animation: &Gd<Animation>, skeleton: &Gd<Skeleton3D>) -> usize {
    let turns = tracks(animation, skeleton).into_iter();
    turns
        .filter(|track| track.kind == TrackType::ROTATION_3D)
        .count()
}

/// Bones of a skeleton, in or out of the tree, as an animation poses them; `None` when it turns none of them.
pub(super) fn sample(
    animation: &Gd<Animation>,
    skeleton: &Gd<Skeleton3D>,
) -> Option<SkeletalMotion> {
    if bones_turned(animation, skeleton) == 0 {
        return None;
    }
    let tracks = tracks(animation, skeleton);
    let above = world_from(skeleton);
    let bones: Vec<(Option<usize>, Transform3D)> = (0..skeleton.get_bone_count())
        .map(|bone| {
            let parent = usize::try_from(skeleton.get_bone_parent(bone)).ok();
            (parent, skeleton.get_bone_rest(bone))
        })
        .collect();
    let rests: Vec<Transform3D> = bones.iter().map(|(_, rest)| *rest).collect();
    let parents: Vec<Option<usize>> = bones.iter().map(|(parent, _)| *parent).collect();
    let posed = |locals: &[Transform3D]| -> Vec<Affine3A> {
        (0..locals.len())
            .map(|bone| {
                // A skeleton has no circles; more bones above one than there are would be one.
                let chain = std::iter::successors(Some(bone), |&bone| parents[bone]);
                let pose = chain
                    .take(locals.len())
                    .fold(Transform3D::IDENTITY, |below, bone| locals[bone] * below);
                convert::affine(above * pose)
            })
            .collect()
    };
    let step = f64::from(animation.get_step());
    let found = if step > 0.0 {
        1.0 / step
    } else {
        USUAL_RATE_HZ
    };
    let frame_rate_hz = if PLAUSIBLE_RATES_HZ.contains(&found) {
        found
    } else {
        USUAL_RATE_HZ
    };
    let length = f64::from(animation.get_length()).min(LONGEST_SECS);
    let count = (length * frame_rate_hz).round() as usize + 1;
    let scale = skeleton.get_motion_scale();
    let frames = (0..count).map(|frame| {
        let time = (frame as f64 / frame_rate_hz).min(length);
        let mut locals = rests.clone();
        for track in &tracks {
            pose(animation, track, time, scale, &mut locals[track.bone]);
        }
        posed(&locals)
    });
    let at_rest = posed(&rests);
    let named = (0..skeleton.get_bone_count()).map(|bone| skeleton.get_bone_name(bone));
    Some(SkeletalMotion {
        frames: frames.collect(),
        frame_rate_hz,
        bones: named
            .zip(parents.iter().zip(at_rest))
            .map(|(name, (parent, rest))| Bone {
                name: name.to_string(),
                parent: *parent,
                rest,
            })
            .collect(),
    })
}

/// The tracks that pose bones of the skeleton.
fn tracks(animation: &Gd<Animation>, skeleton: &Gd<Skeleton3D>) -> Vec<Track> {
    let poses = [
        TrackType::POSITION_3D,
        TrackType::ROTATION_3D,
        TrackType::SCALE_3D,
    ];
    (0..animation.get_track_count())
        .filter_map(|index| {
            let kind = animation.track_get_type(index);
            let path = animation.track_get_path(index);
            let bone = skeleton.find_bone(&GString::from(&path.get_concatenated_subnames()));
            let is_used = poses.contains(&kind) && animation.track_is_enabled(index);
            let bone = usize::try_from(bone).ok().filter(|_| is_used)?;
            Some(Track { index, kind, bone })
        })
        .collect()
}

/// Puts a track's value at a time into its bone's own transform.
fn pose(
    animation: &Gd<Animation>,
    track: &Track,
    time: f64,
    motion_scale: f32,
    local: &mut Transform3D,
) {
    let scale = local.basis.get_scale();
    let turn = local.basis.orthonormalized();
    match track.kind {
        TrackType::POSITION_3D => {
            local.origin = animation.position_track_interpolate(track.index, time) * motion_scale;
        }
        TrackType::ROTATION_3D => {
            let turned = animation.rotation_track_interpolate(track.index, time);
            local.basis = Basis::from_quaternion(turned.normalized()) * Basis::from_scale(scale);
        }
        _ => {
            let scaled = animation.scale_track_interpolate(track.index, time);
            local.basis = turn * Basis::from_scale(scaled);
        }
    }
}

/// Transform of a skeleton's node in its scene.
fn world_from(skeleton: &Gd<Skeleton3D>) -> Transform3D {
    let mut node = Some(skeleton.clone().upcast::<Node>());
    let mut world = Transform3D::IDENTITY;
    while let Some(current) = node {
        if let Ok(spatial) = current.clone().try_cast::<Node3D>() {
            world = spatial.get_transform() * world;
        }
        node = current.get_parent();
    }
    world
}
