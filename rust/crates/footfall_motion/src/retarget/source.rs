//! The motion of a file seen through a joint map: what each canonical joint does there, turned so that Y is up.

use super::Placement;
use crate::bvh::{BvhFile, JointTransforms, rest_transforms};
use footfall_core::rotation::shortest_arc;
use footfall_core::{JOINT_COUNT, Joint, Side};
use glam::{Quat, Vec3};

/// One frame of the source, per canonical joint.
#[derive(Clone, Debug)]
pub(super) struct SourceFrame {
    /// `world_from_joint` rotation of the source's joint.
    pub(super) rotations: [Quat; JOINT_COUNT],
    /// Position of the joint, in the file's unit.
    pub(super) positions: [Vec3; JOINT_COUNT],
    /// Ends of the joints' segments.
    pub(super) tails: [Vec3; JOINT_COUNT],
}

impl SourceFrame {
    pub(super) fn rotation(&self, joint: Joint) -> Quat {
        self.rotations[joint.index()]
    }

    pub(super) fn position(&self, joint: Joint) -> Vec3 {
        self.positions[joint.index()]
    }

    /// From a joint to the end of its segment.
    pub(super) fn segment(&self, joint: Joint) -> Vec3 {
        self.tails[joint.index()] - self.positions[joint.index()]
    }

    /// Direction of a joint's segment.
    pub(super) fn direction(&self, joint: Joint) -> Vec3 {
        self.segment(joint).normalize_or_zero()
    }

    /// From the right hip joint to the left one.
    pub(super) fn left(&self) -> Vec3 {
        (self.position(Joint::LeftUpperLeg) - self.position(Joint::RightUpperLeg))
            .normalize_or_zero()
    }
}

/// The whole motion.
#[derive(Clone, Debug)]
pub(super) struct SourceMotion {
    pub(super) frames: Vec<SourceFrame>,
    /// The file's zero rotations.
    pub(super) rest: SourceFrame,
    /// True for the canonical joints that the file has.
    pub(super) has: [bool; JOINT_COUNT],
    /// Thigh plus shank in the file, mean of both legs, in the file's unit.
    pub(super) leg_length: f32,
    /// Factor by which the legs have become longer than the file's.
    pub(super) leg_factor: f32,
    /// Frames before this one are not part of the motion (a T-pose that an exporter put in front).
    pub(super) first_motion_frame: usize,
    pub(super) frame_rate_hz: f64,
}

/// End of a segment.
#[derive(Clone, Copy, Debug)]
enum Tail {
    /// At another joint of the file.
    At(usize),
    /// At a fixed point of the joint's own space.
    Local(Vec3),
}

impl SourceMotion {
    /// Places every joint in every frame. The placement must be complete.
    pub(super) fn new(file: &BvhFile, placement: &Placement) -> Self {
        let sources = source_of_each(placement);
        let has = placement.joints.map(|joint| joint.is_some());
        let rest_raw = rest_transforms(file);
        let tails = Joint::ALL.map(|joint| tail_of(file, placement, &rest_raw, joint));
        let mut transforms = JointTransforms::default();
        let up = up_axis(file, placement);
        // Half a turn about X brings a body that hangs head down upright without mirroring it.
        let turn = if up.y < -0.5 {
            Quat::from_rotation_x(core::f32::consts::PI)
        } else {
            shortest_arc(up, Vec3::Y)
        };
        let view = |raw: &JointTransforms| SourceFrame {
            rotations: sources.map(|joint| turn * raw.rotations[joint]),
            positions: sources.map(|joint| turn * raw.positions[joint]),
            tails: core::array::from_fn(|n| {
                turn * match tails[n] {
                    Tail::At(joint) => raw.positions[joint],
                    Tail::Local(point) => {
                        raw.positions[sources[n]] + raw.rotations[sources[n]] * point
                    }
                }
            }),
        };
        let mut frames = Vec::with_capacity(file.frame_count);
        for frame in 0..file.frame_count {
            file.place_joints(frame, &mut transforms);
            frames.push(view(&transforms));
        }
        let mut motion = Self {
            rest: view(&rest_raw),
            leg_length: 0.0,
            leg_factor: 1.0,
            first_motion_frame: 0,
            frame_rate_hz: file.frame_rate_hz(),
            has,
            frames,
        };
        motion.first_motion_frame = first_motion_frame(&motion.frames);
        motion.leg_length = motion.mean_leg_length();
        motion
    }

    /// Moves the body in every frame of the motion proper by these shifts, in units of which the file's have `scale`.
    pub(super) fn travel(&mut self, way: &[Vec3], scale: f32) {
        for (frame, &offset) in self.frames[self.first_motion_frame..].iter_mut().zip(way) {
            let offset = offset / scale;
            for place in frame.positions.iter_mut().chain(&mut frame.tails) {
                *place += offset;
            }
        }
    }

    /// The frames of the motion proper.
    pub(super) fn moving(&self) -> &[SourceFrame] {
        &self.frames[self.first_motion_frame..]
    }

    /// Some hundreds of frames spread over the motion: enough for means.
    pub(super) fn sampled(&self) -> impl Iterator<Item = &SourceFrame> {
        let frames = self.moving();
        frames.iter().step_by(frames.len() / 1000 + 1)
    }

    fn mean_leg_length(&self) -> f32 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for frame in self.sampled() {
            for side in Side::BOTH {
                sum += frame.segment(side.upper_leg()).length()
                    + frame.segment(side.lower_leg()).length();
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Mean length of a joint's segment, in the file's unit.
    pub(super) fn mean_length(&self, joint: Joint) -> f32 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for frame in self.sampled() {
            sum += frame.segment(joint).length();
            count += 1.0;
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }
}

/// The file's joint for every canonical joint; one that the file does not have moves with the next that it has.
fn source_of_each(placement: &Placement) -> [usize; JOINT_COUNT] {
    let mut sources = [0; JOINT_COUNT];
    for joint in Joint::ALL {
        sources[joint.index()] = placement
            .joint(joint)
            // A file with a head and no neck: the head's joint is the top of the neck.
            .or_else(|| {
                (joint == Joint::Neck)
                    .then(|| placement.joint(Joint::Head))
                    .flatten()
            })
            .or_else(|| joint.parent().map(|parent| sources[parent.index()]))
            .unwrap_or(0);
    }
    sources
}

fn tail_of(file: &BvhFile, placement: &Placement, rest: &JointTransforms, joint: Joint) -> Tail {
    use Joint::{
        Head, Hips, LeftFoot, LeftHand, LeftLowerArm, LeftToes, Neck, RightFoot, RightHand,
        RightLowerArm, RightToes,
    };
    let own = placement.joint(joint);
    let next = match joint {
        Hips | Joint::Spine | Joint::Chest | Joint::UpperChest => {
            let above = [Joint::Spine, Joint::Chest, Joint::UpperChest, Neck, Head];
            above
                .into_iter()
                .filter(|&above| above > joint)
                .find_map(|above| {
                    placement.joint(above).filter(|&found| {
                        own.is_none_or(|own| {
                            rest.positions[found].distance(rest.positions[own]) > 1e-4
                        })
                    })
                })
        }
        Head | LeftHand | RightHand | LeftToes | RightToes => None,
        _ => Joint::ALL
            .get(joint.index() + 1)
            .and_then(|&next| placement.joint(next)),
    };
    let ends_with_own_tail = matches!(
        joint,
        Head | Neck
            | LeftHand
            | RightHand
            | LeftToes
            | RightToes
            | LeftFoot
            | RightFoot
            | LeftLowerArm
            | RightLowerArm
    );
    match (next, own) {
        (Some(next), _) => Tail::At(next),
        (None, Some(own)) if ends_with_own_tail => Tail::Local(local_tail(file, own)),
        _ => Tail::Local(Vec3::ZERO),
    }
}

/// Returns the end of a joint without a mapped child, in its own space.
fn local_tail(file: &BvhFile, joint: usize) -> Vec3 {
    let shortest = 1e-3 * file.joints[joint].offset.length().max(1e-6);
    let own_ends = &file.joints[joint].end_sites;
    if let Some(end) = own_ends.iter().find(|end| end.length() > shortest) {
        return *end;
    }
    // Fingers and the like: breadth first, skipping thumbs, the mean of the first generation that lies apart.
    let mut generation = vec![(joint, Vec3::ZERO)];
    while !generation.is_empty() {
        let mut next = Vec::new();
        let mut points = Vec::new();
        for &(parent, at) in &generation {
            for (index, child) in file.joints.iter().enumerate() {
                if child.parent == Some(parent)
                    && !child.name.to_ascii_lowercase().contains("thumb")
                {
                    let at = at + child.offset;
                    next.push((index, at));
                    if at.length() > shortest {
                        points.push(at);
                    }
                }
            }
        }
        if !points.is_empty() {
            return points.iter().sum::<Vec3>() / points.len() as f32;
        }
        generation = next;
    }
    // Skeletons whose segments all lie along one axis of their joints carry on along it.
    file.joints[joint].offset * 0.5
}

/// The axis of the file that points from the feet to the neck.
fn up_axis(file: &BvhFile, placement: &Placement) -> Vec3 {
    let at = |transforms: &JointTransforms, joint: Joint| {
        placement
            .joint(joint)
            .map_or(Vec3::ZERO, |joint| transforms.positions[joint])
    };
    let body_up = |transforms: &JointTransforms| {
        let top = if placement.joint(Joint::Neck).is_some() {
            at(transforms, Joint::Neck)
        } else {
            at(transforms, Joint::Head)
        };
        let feet = 0.5 * (at(transforms, Joint::LeftFoot) + at(transforms, Joint::RightFoot));
        (top - feet).normalize_or_zero()
    };
    let mut transforms = JointTransforms::default();
    let mut sum = Vec3::ZERO;
    for frame in (0..file.frame_count).step_by(file.frame_count / 200 + 1) {
        file.place_joints(frame, &mut transforms);
        sum += body_up(&transforms);
    }
    let axes = [
        Vec3::Y,
        Vec3::Z,
        Vec3::X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
        Vec3::NEG_X,
    ];
    axes.into_iter()
        .max_by(|a, b| a.dot(sum).total_cmp(&b.dot(sum)))
        // Max takes the last of equals; without any evidence Y is up.
        .filter(|axis| axis.dot(sum) > 1e-3)
        .unwrap_or(Vec3::Y)
}

/// Number of frames at the start that are not part of the motion: after them the pose jumps.
fn first_motion_frame(frames: &[SourceFrame]) -> usize {
    const LOOK_AHEAD: usize = 3;
    if frames.len() < LOOK_AHEAD + 5 {
        return 0;
    }
    let change = |a: &SourceFrame, b: &SourceFrame| {
        let joints = [
            Joint::LeftUpperArm,
            Joint::RightUpperArm,
            Joint::LeftLowerArm,
            Joint::RightLowerArm,
            Joint::LeftUpperLeg,
            Joint::RightUpperLeg,
            Joint::LeftLowerLeg,
            Joint::RightLowerLeg,
        ];
        joints
            .map(|joint| a.direction(joint).angle_between(b.direction(joint)))
            .iter()
            .filter(|angle| angle.is_finite())
            .sum::<f32>()
            / joints.len() as f32
    };
    let mut changes: Vec<f32> = frames
        .windows(2)
        .take(240)
        .map(|pair| change(&pair[0], &pair[1]))
        .collect();
    let early = changes[..LOOK_AHEAD].to_vec();
    changes.sort_by(f32::total_cmp);
    let typical = changes[changes.len() / 2];
    early
        .iter()
        .rposition(|&change| change > 0.12 && change > 6.0 * typical)
        .map_or(0, |frame| frame + 1)
}
