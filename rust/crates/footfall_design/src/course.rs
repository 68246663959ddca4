//! The way over the ground, without sway: the reference for the motion of feet and hips.

use crate::chance::{drift, normal};
use crate::curve::smoothed;
use crate::sheet::StyleSheet;
use crate::timeline::Timeline;
use footfall_core::Pose;
use footfall_core::rotation::{from_heading, wrap_angle};
use glam::{Quat, Vec3};

/// Smoothing of the hips' way, strides: a sway of one stride is gone, a bend of the path stays.
const PLACE_SIGMA: f32 = 0.4;
const HEADING_SIGMA: f32 = 0.25;

/// A place and a heading on the ground for each frame.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    pub(crate) place: Vec<Vec3>,
    pub(crate) heading: Vec<f32>,
    /// Local stretch of the way against the captured one.
    pub(crate) stretch: Vec<f32>,
}

impl Course {
    /// The captured way.
    pub(crate) fn captured(poses: &[Pose], timeline: &Timeline) -> Self {
        let hips: Vec<Vec3> = poses
            .iter()
            .map(|pose| pose.root_position.with_y(0.0))
            .collect();
        let place = smoothed(&hips, PLACE_SIGMA * timeline.stride_frames);
        let last = place.len() - 1;
        let mut heading: Vec<f32> = Vec::with_capacity(place.len());
        for frame in 0..=last {
            let way = place[(frame + 1).min(last)] - place[frame.saturating_sub(1)];
            let angle = way.x.atan2(way.z);
            let near = heading.last().copied().unwrap_or(angle);
            heading.push(near + wrap_angle(angle - near));
        }
        Self {
            heading: smoothed(&heading, HEADING_SIGMA * timeline.stride_frames),
            stretch: vec![1.0; place.len()],
            place,
        }
    }

    /// The way of the style: every piece as long as its step, with a slow weave.
    pub(crate) fn styled(
        &self,
        timeline: &Timeline,
        sheet: &StyleSheet,
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        let sides: f32 = sheet.sides.iter().map(|side| side.step_length).sum();
        let mean = sheet.walk.stride / 100.0 * sides / 200.0;
        let drawn: Vec<f32> = timeline
            .phase
            .iter()
            .map(|phase| {
                let step = (phase * 2.0).floor() as i64 as u64;
                let chance = 1.0 + 0.01 * sheet.irregular.step_length * normal(seed, 2, step);
                mean * chance.clamp(0.5, 1.5)
            })
            .collect();
        let stretch = smoothed(&drawn, 0.12 * timeline.stride_frames);
        let mut place = vec![self.place[0]];
        for frame in 1..self.place.len() {
            let way = self.place[frame] - self.place[frame - 1];
            place.push(place[frame - 1] + way * stretch[frame]);
        }
        let mut styled = Self {
            place,
            heading: self.heading.clone(),
            stretch,
        };
        let amount = 0.01 * sheet.irregular.wander;
        for (frame, place) in styled.place.iter_mut().enumerate() {
            let secs = frame as f32 / rate_hz as f32;
            let aside = amount * drift(seed, 3, secs / (1.5 * sheet.irregular.period));
            *place += from_heading(self.heading[frame]) * Vec3::X * aside;
        }
        styled
    }

    /// `model_from_course` rotation at a frame.
    pub(crate) fn level(&self, frame: usize) -> Quat {
        from_heading(self.heading[frame])
    }

    /// A point at a frame, as seen from the course: left, up, ahead.
    pub(crate) fn relative(&self, frame: usize, point: Vec3) -> Vec3 {
        self.level(frame).inverse() * (point - self.place[frame])
    }

    /// The reverse of [`Self::relative`].
    pub(crate) fn point(&self, frame: usize, relative: Vec3) -> Vec3 {
        self.place[frame] + self.level(frame) * relative
    }
}
