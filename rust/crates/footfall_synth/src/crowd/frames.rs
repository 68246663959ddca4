//! Frames of a crowd's step: places of the joints as 16-bit numbers.

use crate::ground::PlantedFrame;
use footfall_core::{
    GroundTransform, JOINT_COUNT, Joint, ModelPose, Pose, Skeleton, forward_kinematics_of,
};
use glam::{Quat, Vec3};
use multiversion::multiversion;

const JOINT_NUMBERS: usize = CrowdPose::JOINT_NUMBERS;
pub(super) const POSE_NUMBERS: usize = JOINT_COUNT * JOINT_NUMBERS;

/// Rotations and positions (metres) as whole numbers: to 0.03 mrad, and to a tenth of a millimetre within 3.2 m.
const ROTATION_STEPS: f32 = 32_767.0;
const POSITION_STEPS: f32 = 10_000.0;

/// Size of a cache line, bytes.
const CACHE_LINE: usize = 64;

/// Positions of all joints and their rotations relative to the T-pose, in the character's own space, in the order of [`Joint::ALL`].
#[derive(Clone, Debug)]
#[repr(align(32))]
pub struct CrowdPose([f32; POSE_NUMBERS]);

impl Default for CrowdPose {
    fn default() -> Self {
        Self([0.0; POSE_NUMBERS])
    }
}

impl CrowdPose {
    /// Numbers of one joint: rotation, position, and one for padding.
    pub const JOINT_NUMBERS: usize = 8;

    /// Eight numbers a joint: `character_from_joint` rotation (x, y, z, w), of length 1 to within a percent; position in metres;
    /// and 0.
    pub fn numbers(&self) -> &[f32; POSE_NUMBERS] {
        &self.0
    }

    /// Packs it into 16-bit numbers.
    pub(super) fn shrink(&self, out: &mut [i16; POSE_NUMBERS]) {
        shrink(&self.0, out);
    }

    /// Adds another pose by a weight, number by number.
    pub(super) fn mixed(&self, other: &Self, weight: f32) -> Self {
        let numbers = self.0.iter().zip(&other.0);
        let mut out = Self::default();
        for (out, (a, b)) in out.0.iter_mut().zip(numbers) {
            *out = a + weight * (b - a);
        }
        out
    }

    /// Adds the difference of two other poses by a weight, number by number.
    pub(super) fn shift(&mut self, from: &Self, to: &Self, weight: f32) {
        for (out, (from, to)) in self.0.iter_mut().zip(from.0.iter().zip(&to.0)) {
            *out += weight * (to - from);
        }
    }

    /// Writes the blend of two packed poses.
    pub(super) fn blend(
        &mut self,
        now: &[i16; POSE_NUMBERS],
        next: &[i16; POSE_NUMBERS],
        weight: f32,
    ) {
        blend(now, next, weight, &mut self.0);
    }

    /// `character_from_joint` rotation.
    pub fn rotation(&self, joint: Joint) -> Quat {
        let at = joint.index() * JOINT_NUMBERS;
        Quat::from_slice(&self.0[at..]).normalize()
    }

    /// Position in metres.
    pub fn position(&self, joint: Joint) -> Vec3 {
        Vec3::from_slice(&self.0[joint.index() * JOINT_NUMBERS + 4..])
    }
}

/// Place of a character in one frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CrowdPlace {
    /// The character on the ground: `plan_from_character`.
    pub(super) place: GroundTransform,
    pub(super) contact: [bool; 2],
}

/// Number of frames packed together.
const TOGETHER: usize = 4;

/// Working memory of [`CrowdFrames::set`].
#[derive(Debug, Default)]
pub(super) struct FrameBuffers {
    poses: [Pose; TOGETHER],
    model_poses: [ModelPose; TOGETHER],
}

/// Frames of a step, one entry per frame in both lists. They are separate because a game needs the place in each of its frames, but not always the pose.
#[derive(Clone, Debug, Default)]
pub(super) struct CrowdFrames {
    pub(super) places: Vec<CrowdPlace>,
    poses: Vec<[i16; POSE_NUMBERS]>,
}

impl CrowdFrames {
    /// Packs planted frames.
    pub(super) fn set(
        &mut self,
        frames: &[PlantedFrame],
        skeleton: &Skeleton,
        buffers: &mut FrameBuffers,
    ) {
        self.places.resize(frames.len(), CrowdPlace::default());
        self.poses.resize(frames.len(), [0; POSE_NUMBERS]);
        let FrameBuffers { poses, model_poses } = buffers;
        let mut before = [Quat::IDENTITY; JOINT_COUNT];
        let places = self.places.chunks_mut(TOGETHER);
        let kept = places.zip(self.poses.chunks_mut(TOGETHER));
        for (frames, (places, kept)) in frames.chunks(TOGETHER).zip(kept) {
            for ((frame, place), pose) in frames.iter().zip(places).zip(&mut *poses) {
                place.place = GroundTransform {
                    position: frame.ground_position,
                    heading: frame.ground_heading,
                };
                place.contact = frame.contact;
                let character_from_plan = frame.plan_from_ground.conjugate();
                let on_plan = frame.pose.root_position - place.place.position;
                pose.rotations = frame.pose.rotations;
                pose.root_position = character_from_plan * on_plan;
                let hips = &mut pose.rotations[Joint::Hips.index()];
                *hips = (character_from_plan * *hips).normalize();
            }
            forward_kinematics_of(skeleton, poses, model_poses);
            for (model, numbers) in model_poses.iter().zip(kept) {
                let joints = model.rotations.iter().zip(&model.positions);
                let mut values = CrowdPose::default();
                let rows = values.0.chunks_exact_mut(JOINT_NUMBERS);
                for ((row, (rotation, position)), before) in rows.zip(joints).zip(&mut before) {
                    // The quaternion of the same sign as the previous one, so that frames can be blended number by number.
                    let sign = if rotation.dot(*before) < 0.0 {
                        -1.0
                    } else {
                        1.0
                    };
                    *before = *rotation * sign;
                    row[..4].copy_from_slice(&before.to_array());
                    row[4..7].copy_from_slice(&position.to_array());
                }
                shrink(&values.0, numbers);
            }
        }
    }

    /// Holds one place and pose.
    pub(super) fn hold(&mut self, place: CrowdPlace, pose: &[i16; POSE_NUMBERS]) {
        self.places.clear();
        self.places.extend([place; 2]);
        self.poses.clear();
        self.poses.extend([*pose; 2]);
    }

    /// Returns the last pose.
    pub(super) fn last_pose(&self) -> Option<&[i16; POSE_NUMBERS]> {
        self.poses.last()
    }

    /// Returns the number of frames.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Prefetches the places of a frame and of the next one.
    pub(super) fn fetch_place(&self, frame: usize) {
        for place in &self.places[frame..=frame + 1] {
            core::hint::black_box(place.place.heading);
        }
    }

    /// Reads a little of every cache line that [`blend`](Self::blend) will read: after this for several steps, blending them
    /// waits for memory once instead of once per step.
    pub(super) fn fetch(&self, frame: usize) {
        for pose in &self.poses[frame..=frame + 1] {
            for number in pose.iter().step_by(CACHE_LINE / size_of::<i16>()) {
                core::hint::black_box(*number);
            }
        }
    }

    /// Writes the blend of a frame and the next one.
    pub(super) fn blend(&self, frame: usize, weight: f32, out: &mut CrowdPose) {
        out.blend(&self.poses[frame], &self.poses[frame + 1], weight);
    }
}

/// Returns the resolution of the numbers of a joint, steps per unit.
const STEPS: [f32; JOINT_NUMBERS] = {
    let (rotation, position) = (ROTATION_STEPS, POSITION_STEPS);
    [
        rotation, rotation, rotation, rotation, position, position, position, 1.0,
    ]
};

#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn shrink(values: &[f32; POSE_NUMBERS], out: &mut [i16; POSE_NUMBERS]) {
    let rows = out.chunks_exact_mut(JOINT_NUMBERS);
    for (out, values) in rows.zip(values.chunks_exact(JOINT_NUMBERS)) {
        for ((out, value), steps) in out.iter_mut().zip(values).zip(STEPS) {
            *out = (value * steps).round_ties_even() as i16;
        }
    }
}

#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn blend(
    now: &[i16; POSE_NUMBERS],
    next: &[i16; POSE_NUMBERS],
    weight: f32,
    out: &mut [f32; POSE_NUMBERS],
) {
    let scales = STEPS.map(f32::recip);
    let rows = now
        .chunks_exact(JOINT_NUMBERS)
        .zip(next.chunks_exact(JOINT_NUMBERS));
    for (out, (now, next)) in out.chunks_exact_mut(JOINT_NUMBERS).zip(rows) {
        for (((out, now), next), scale) in out.iter_mut().zip(now).zip(next).zip(scales) {
            let (now, next) = (f32::from(*now), f32::from(*next));
            *out = (now + weight * (next - now)) * scale;
        }
    }
}
