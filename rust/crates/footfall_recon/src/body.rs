//! A row of body numbers as a pose.

use footfall_core::Pose;
use footfall_core::rotation::exp_maps;
use footfall_model::FEATURE_COUNT;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT};
use glam::Vec3;

/// Numbers that describe the body in a frame, as [`footfall_model::imu_model`] lays them out.
pub type BodyFrame = [f32; BODY_COUNT];

/// A body, how it came there and how it goes on, in frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// The body.
    pub body: BodyFrame,
    /// Change since the frame before.
    pub arrival: BodyFrame,
    /// Change to the next frame.
    pub velocity: BodyFrame,
}

impl Course {
    /// A body of zeros at rest.
    pub const REST: Self = Self {
        body: [0.0; BODY_COUNT],
        arrival: [0.0; BODY_COUNT],
        velocity: [0.0; BODY_COUNT],
    };
}

/// Writes the pose of a body that faces +Z above the origin, scaled from the model's size.
pub fn pose_of(body: &BodyFrame, scale: f32, pose: &mut Pose) {
    exp_maps(&body[..FEATURE_COUNT], &mut pose.rotations);
    pose.root_position = Vec3::Y * body[HEIGHT] * scale;
}
