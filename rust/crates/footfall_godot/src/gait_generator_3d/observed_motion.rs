//! The last two frames of a motion, for its pose and its speed.

use footfall_core::{Pose, Skeleton};
use footfall_ik::handover::{Moving, standing_feet};
use footfall_ik::placement::Frame;
use glam::Vec3;

/// Two frames of a motion.
#[derive(Clone, Debug, Default)]
pub(super) struct ObservedMotion {
    before: Pose,
    now: Pose,
    stands: [bool; 2],
    /// From one to the other.
    pub(super) dt_secs: f32,
    frames: u8,
}

impl ObservedMotion {
    /// One frame more.
    pub(super) fn observe(&mut self, pose: &Pose, stands: [bool; 2], dt_secs: f32) {
        core::mem::swap(&mut self.before, &mut self.now);
        self.now.clone_from(pose);
        self.stands = stands;
        self.dt_secs = dt_secs;
        self.frames = (self.frames + 1).min(2);
    }

    /// Takes one frame more of a motion without known contacts. The floor is that of a frame of its space in which lengths are
    /// `scale` times as long.
    pub(super) fn observe_without_contacts(
        &mut self,
        body: &Skeleton,
        pose: &Pose,
        dt_secs: f32,
        floor: &Frame,
        scale: f32,
    ) {
        let known = self.frames > 0;
        self.observe(pose, self.stands, dt_secs);
        let Self { before, now, .. } = self.relative_to(floor, scale);
        let before = if known { &before } else { &now };
        self.stands = standing_feet(body, before, &now, dt_secs, self.stands);
    }

    /// The same motion with other feet that stand.
    pub(super) const fn with_standing(mut self, stands: [bool; 2]) -> Self {
        self.stands = stands;
        self
    }

    /// Returns whether its speed is known.
    pub(super) const fn is_known(&self) -> bool {
        self.frames == 2
    }

    pub(super) const fn moving(&self) -> Moving<'_> {
        Moving {
            before: &self.before,
            now: &self.now,
            stands: self.stands,
        }
    }

    /// The same motion as it is seen from a frame of its space, in which lengths are `scale` times as long.
    pub(super) fn relative_to(&self, frame: &Frame, scale: f32) -> Self {
        let mut seen = self.clone();
        for pose in [&mut seen.before, &mut seen.now] {
            lower(frame, pose);
            pose.root_position *= scale;
        }
        seen
    }

    /// The same motion of a frame's space in its parent.
    pub(super) fn raised(mut self, frame: &Frame) -> Self {
        for pose in [&mut self.before, &mut self.now] {
            raise(frame, pose);
        }
        self
    }

    /// Position of the hips now.
    pub(super) const fn hips(&self) -> Vec3 {
        self.now.root_position
    }
}

/// A pose of a frame's space in its parent.
pub(super) fn raise(frame: &Frame, pose: &mut Pose) {
    pose.root_position = frame.point(pose.root_position);
    pose.rotations[0] = (frame.rotation * pose.rotations[0]).normalize();
}

/// A pose of the parent as it is seen from a frame.
pub(super) fn lower(frame: &Frame, pose: &mut Pose) {
    pose.root_position = frame.local_point(pose.root_position);
    pose.rotations[0] = (frame.rotation.conjugate() * pose.rotations[0]).normalize();
}
