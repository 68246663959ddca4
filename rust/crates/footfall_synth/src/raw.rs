//! What a frame of generated features says about the body before it is put on the ground.

use footfall_core::{JOINT_COUNT, Joint, Pose, Side, Skeleton};
use footfall_ik::{pitch_and_heading, settled_pitch};
use footfall_model::layout;
use glam::{Quat, Vec3};

/// One generated frame, hips at the origin and heading removed.
#[derive(Clone, Debug)]
pub(crate) struct RawFrame {
    /// Local rotations; the hips' relative to the heading.
    pub(crate) rotations: [Quat; JOINT_COUNT],
    /// Per side, what the leg does.
    pub(crate) legs: [RawLeg; 2],
}

/// One leg of a generated frame, relative to the hips and the heading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawLeg {
    /// The hip joint from the hips.
    pub(crate) hip: Vec3,
    /// The ankle from the hips.
    pub(crate) ankle: Vec3,
    /// Rotation of the foot.
    pub(crate) foot: Quat,
    /// Pitch of the foot (positive: heel up), settled.
    pub(crate) pitch: f32,
    /// Heading of the foot relative to the walker's.
    pub(crate) heading: f32,
}

impl Default for RawFrame {
    fn default() -> Self {
        let leg = RawLeg {
            hip: Vec3::ZERO,
            ankle: Vec3::ZERO,
            foot: Quat::IDENTITY,
            pitch: 0.0,
            heading: 0.0,
        };
        Self {
            rotations: [Quat::IDENTITY; JOINT_COUNT],
            legs: [leg; 2],
        }
    }
}

impl RawFrame {
    /// Fills the frame from static features. `stride_scale` stretches the legs' reach forwards and backwards.
    pub(crate) fn decode(&mut self, features: &[f32], skeleton: &Skeleton, stride_scale: f32) {
        layout::decode(features, &mut self.rotations);
        let hips = self.rotations[Joint::Hips.index()];
        for side in Side::BOTH {
            let local = |joint: Joint| self.rotations[joint.index()];
            let thigh = hips * local(side.upper_leg());
            let shank = thigh * local(side.lower_leg());
            let foot = shank * local(side.foot());
            let (pitch, heading) = pitch_and_heading(foot);
            let hip = hips * skeleton.offset(side.upper_leg());
            let ankle = hip
                + thigh * skeleton.offset(side.lower_leg())
                + shank * skeleton.offset(side.foot());
            let reach = (ankle.z - hip.z) * (stride_scale - 1.0);
            self.legs[side.index()] = RawLeg {
                hip,
                ankle: ankle + Vec3::Z * reach,
                foot,
                // A shorter stride lands flatter and pushes off less.
                pitch: settled_pitch(pitch * stride_scale.min(1.0)),
                heading,
            };
        }
    }

    /// The pose with the hips at a place and under a heading.
    pub(crate) fn pose(&self, hips: Vec3, world_from_heading: Quat, out: &mut Pose) {
        out.root_position = hips;
        out.rotations = self.rotations;
        let root = Joint::Hips.index();
        out.rotations[root] = (world_from_heading * self.rotations[root]).normalize();
    }
}
