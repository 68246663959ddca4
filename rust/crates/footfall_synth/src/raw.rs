//! What a frame of generated features says about the body before it is put on the ground.

use footfall_core::{JOINT_COUNT, Joint, Side, Skeleton};
use footfall_ik::{FootTarget, foot_heading, foot_pitch, settled_pitch};
use footfall_model::layout;
use glam::{Quat, Vec3};

/// One generated frame, hips at the origin and heading removed.
#[derive(Clone, Debug, Default)]
pub(crate) struct RawFrame {
    /// Rotation of the hips relative to the heading.
    pub(crate) hips: Quat,
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
    /// Its pitch (positive: heel up).
    pub(crate) free_pitch: f32,
    /// The same on the ground: settled, and less of it in short strides.
    pub(crate) pitch: f32,
    /// Where the foot is if it stands on its plant at this pitch; the planter fills it.
    pub(crate) stance: FootTarget,
}

impl RawLeg {
    /// Heading of the foot relative to the walker's.
    pub(crate) fn heading(&self) -> f32 {
        foot_heading(self.foot)
    }

    /// Puts the ankle elsewhere, with the foot at another pitch: at `free` in the air and at `standing` on the ground.
    pub(crate) fn put(&mut self, ankle: Vec3, free: f32, standing: f32) {
        self.ankle = ankle;
        self.foot = (self.foot * Quat::from_rotation_x(free - self.free_pitch)).normalize();
        self.pitch = standing;
    }
}

impl Default for RawLeg {
    fn default() -> Self {
        Self {
            hip: Vec3::ZERO,
            ankle: Vec3::ZERO,
            foot: Quat::IDENTITY,
            free_pitch: 0.0,
            pitch: 0.0,
            stance: FootTarget {
                ankle: Vec3::ZERO,
                foot: Quat::IDENTITY,
                toes: Quat::IDENTITY,
            },
        }
    }
}

impl RawFrame {
    /// Fills the frame and a pose's local rotations (the hips' relative to the heading) from static features.
    /// `stride_scale` stretches the legs' reach forwards and backwards.
    pub(crate) fn decode(
        &mut self,
        features: &[f32],
        skeleton: &Skeleton,
        stride_scale: f32,
        rotations: &mut [Quat; JOINT_COUNT],
    ) {
        layout::decode(features, rotations);
        let hips = rotations[Joint::Hips.index()];
        self.hips = hips;
        for side in Side::BOTH {
            let local = |joint: Joint| rotations[joint.index()];
            let thigh = hips * local(side.upper_leg());
            let shank = thigh * local(side.lower_leg());
            let foot = shank * local(side.foot());
            let hip = hips * skeleton.offset(side.upper_leg());
            let ankle = hip
                + thigh * skeleton.offset(side.lower_leg())
                + shank * skeleton.offset(side.foot());
            let reach = (ankle.z - hip.z) * (stride_scale - 1.0);
            let leg = &mut self.legs[side.index()];
            leg.hip = hip;
            leg.ankle = ankle + Vec3::Z * reach;
            leg.foot = foot;
            leg.free_pitch = foot_pitch(foot);
            // A shorter stride lands flatter and pushes off less.
            leg.pitch = settled_pitch(leg.free_pitch * stride_scale.min(1.0));
        }
    }
}
