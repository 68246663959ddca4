//! A row of body numbers as a pose.

use footfall_core::Pose;
use footfall_core::rotation::exp_maps;
use footfall_model::FEATURE_COUNT;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT};
use glam::Vec3;

/// Numbers that describe the body in a frame, as [`footfall_model::imu_model`] lays them out.
pub type BodyFrame = [f32; BODY_COUNT];

/// Writes the pose of a body that faces +Z above the origin, so many times as large as the model's.
pub fn pose_of(body: &BodyFrame, scale: f32, pose: &mut Pose) {
    exp_maps(&body[..FEATURE_COUNT], &mut pose.rotations);
    pose.root_position = Vec3::Y * body[HEIGHT] * scale;
}
