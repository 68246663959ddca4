//! Motion at a fixed rate.

use crate::pose::{ModelPose, Pose};
use crate::skeleton::Skeleton;

/// Motion of one body at a fixed rate. Frame 0 is at time 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// The body that moves.
    pub skeleton: Skeleton,
    /// Frames per second.
    pub frame_rate_hz: f64,
    /// One pose a frame.
    pub poses: Vec<Pose>,
}

impl Clip {
    /// From the first frame to the last, seconds.
    pub fn duration_secs(&self) -> f64 {
        self.poses.len().saturating_sub(1) as f64 / self.frame_rate_hz
    }

    /// All joints, frame by frame.
    pub fn model_poses(&self) -> impl Iterator<Item = ModelPose> {
        let poses = self.poses.iter();
        poses.map(|pose| ModelPose::of(&self.skeleton, pose))
    }

    /// The pose at a time; held at both ends. `None` for a clip without frames.
    pub fn pose_at(&self, time_secs: f64) -> Option<Pose> {
        let last = self.poses.len().checked_sub(1)?;
        let position = (time_secs * self.frame_rate_hz).clamp(0.0, last as f64);
        let first = position.floor() as usize;
        let next = (first + 1).min(last);
        Some(self.poses[first].interpolate(&self.poses[next], (position - first as f64) as f32))
    }

    /// The same motion at another rate, from the first frame to the last.
    #[must_use]
    pub fn resampled(&self, frame_rate_hz: f64) -> Self {
        // A relative slack keeps the last frame when the duration is a whole number of new frames up to rounding.
        let frames = (self.duration_secs() * frame_rate_hz * (1.0 + 1e-9) + 1e-6).floor() as usize;
        let poses = (0..=frames)
            .map_while(|frame| self.pose_at(frame as f64 / frame_rate_hz))
            .collect();
        Self {
            skeleton: self.skeleton.clone(),
            frame_rate_hz,
            poses,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn resampling_keeps_ends_and_speed() {
        let skeleton = Skeleton::standard();
        let poses = (0..121)
            .map(|frame| Pose {
                root_position: Vec3::Z * frame as f32 / 120.0,
                ..Pose::default()
            })
            .collect();
        let clip = Clip {
            skeleton,
            frame_rate_hz: 120.0,
            poses,
        };
        let half = clip.resampled(60.0);
        assert_eq!(half.poses.len(), 61);
        assert!((half.poses[60].root_position.z - 1.0).abs() < 1e-5);
        assert!((half.poses[30].root_position.z - 0.5).abs() < 1e-5);
        assert!((half.duration_secs() - 1.0).abs() < 1e-9);
    }
}
