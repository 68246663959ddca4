//! Bones as any engine or file poses them, brought into the form that recordings have.
//!
//! Bones rest in any turn and come with scales above them (a rig in centimetres under a node of 0.01); a recording has joints that rest
//! parallel to the world. Only what the bones do against their rest is kept, and places as they are in the world.

use crate::bvh::{BvhFile, BvhJoint, Channel};
use glam::{Affine3A, EulerRot, Quat, Vec3};

/// A bone moves against its parent if it does by this share of the body's size.
const LEAST_SHIFT: f32 = 1e-4;

/// A bone and how it rests.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// Its name.
    pub name: String,
    /// The bone that it hangs from.
    pub parent: Option<usize>,
    /// `world_from_bone` at rest, whatever scales are above it included.
    pub rest: Affine3A,
}

/// Bones that move.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletalMotion {
    /// All bones, in any order.
    pub bones: Vec<Bone>,
    /// Frames per second; above zero.
    pub frame_rate_hz: f64,
    /// `world_from_bone` of each bone in each frame.
    pub frames: Vec<Vec<Affine3A>>,
}

impl SkeletalMotion {
    /// The same motion as a recording with joints that rest parallel to the world.
    pub fn to_recording(&self) -> BvhFile {
        let order = self.depth_first();
        let place_of = |bone: usize| order.iter().position(|&other| other == bone);
        let rest: Vec<(Quat, Vec3)> = self.bones.iter().map(|bone| split(&bone.rest)).collect();
        let world: Vec<Vec<(Quat, Vec3)>> = self
            .frames
            .iter()
            .map(|frame| {
                let posed = frame.iter().zip(&rest);
                posed
                    .map(|(posed, rest)| {
                        let (turn, place) = split(posed);
                        ((turn * rest.0.inverse()).normalize(), place)
                    })
                    .collect()
            })
            .collect();
        let local = |frame: &[(Quat, Vec3)], bone: usize| {
            let (turn, place) = frame[bone];
            self.bones[bone]
                .parent
                .and_then(|parent| frame.get(parent))
                .map_or((turn, place), |above| {
                    let back = above.0.inverse();
                    ((back * turn).normalize(), back * (place - above.1))
                })
        };
        let offset = |bone: usize| {
            let above = self.bones[bone].parent.and_then(|parent| rest.get(parent));
            rest[bone].1 - above.map_or(Vec3::ZERO, |above| above.1)
        };
        let size = rest
            .iter()
            .map(|(_, place)| place.distance(rest[0].1))
            .fold(0.0, f32::max);
        let shifts: Vec<bool> = (0..self.bones.len())
            .map(|bone| {
                let rests = offset(bone);
                self.bones[bone].parent.is_none()
                    || world
                        .iter()
                        .any(|frame| local(frame, bone).1.distance(rests) > LEAST_SHIFT * size)
            })
            .collect();
        let joints = order
            .iter()
            .map(|&bone| BvhJoint {
                name: self.bones[bone].name.clone(),
                parent: self.bones[bone].parent.and_then(place_of),
                offset: offset(bone),
                channels: channels(shifts[bone]),
                end_sites: Vec::new(),
            })
            .collect();
        let mut values = Vec::new();
        for frame in &world {
            for &bone in &order {
                let (turn, place) = local(frame, bone);
                if shifts[bone] {
                    values.extend(place.to_array());
                }
                let (z, x, y) = turn.to_euler(EulerRot::ZXY);
                values.extend([z, x, y].map(f32::to_degrees));
            }
        }
        BvhFile {
            joints,
            frame_time_secs: 1.0 / self.frame_rate_hz,
            frame_count: self.frames.len(),
            values,
        }
    }

    /// All bones, each before those that hang from it.
    fn depth_first(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.bones.len());
        let children = |above: Option<usize>| {
            let bones = (0..self.bones.len()).rev();
            bones.filter(move |&bone| self.bones[bone].parent == above)
        };
        let mut open: Vec<usize> = children(None).collect();
        while let Some(bone) = open.pop() {
            order.push(bone);
            open.extend(children(Some(bone)));
        }
        order
    }
}

fn split(transform: &Affine3A) -> (Quat, Vec3) {
    let (_, turn, place) = transform.to_scale_rotation_translation();
    (turn.normalize(), place)
}

fn channels(shifts: bool) -> Vec<Channel> {
    use Channel::{XPosition, XRotation, YPosition, YRotation, ZPosition, ZRotation};
    let mut channels = if shifts {
        vec![XPosition, YPosition, ZPosition]
    } else {
        Vec::new()
    };
    channels.extend([ZRotation, XRotation, YRotation]);
    channels
}
