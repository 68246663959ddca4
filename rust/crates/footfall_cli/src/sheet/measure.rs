//! Measurements of a clip for the panels: positions, heading, travel, joint angles.

use super::{SheetOptions, Subject};
use anyhow::{Result, ensure};
use footfall_core::rotation::{heading, wrap_angle};
use footfall_core::{Clip, FrameSpan, Joint, ModelPose, Side};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// Smoothing of the heading that figures are turned to, seconds to either side: longer than a stride's sway.
const HEADING_HALF_WINDOW_SECS: f64 = 0.6;
/// Least net displacement that defines a direction of travel, metres.
const LEAST_TRAVEL_M: f32 = 0.6;

/// A clip's window in model space.
pub(crate) struct Measured {
    /// First frame of the window in the clip.
    pub(crate) first_frame: usize,
    /// Frames per second.
    pub(crate) frame_rate_hz: f64,
    /// One a frame of the window.
    pub(crate) frames: Vec<ModelPose>,
    /// Direction of travel, horizontal unit vector.
    pub(crate) travel: Vec3,
    /// Smoothed heading of each frame, radians.
    pub(crate) headings: Vec<f32>,
    /// Largest height of any joint or of the top of the head, metres.
    pub(crate) top: f32,
    /// Stances clipped to the window, in frames of the window.
    pub(crate) stances: [Vec<FrameSpan>; 2],
}

impl Measured {
    pub(crate) fn new(subject: &Subject, options: &SheetOptions) -> Result<Self> {
        let clip = &subject.clip;
        let window = frame_window(clip, options);
        ensure!(
            window.len() >= 2,
            "{}: nothing to draw from {} s on, the clip lasts {:.1} s; choose an earlier --start or a longer --seconds",
            subject.title,
            options.start_secs,
            clip.duration_secs()
        );
        let frames: Vec<ModelPose> = clip.poses[window.clone()]
            .iter()
            .map(|pose| ModelPose::of(&clip.skeleton, pose))
            .collect();
        let headings = smooth_headings(&frames, clip.frame_rate_hz);
        let travel = direction_of_travel(&frames, &headings);
        let top = frames
            .iter()
            .map(|frame| {
                frame
                    .positions
                    .iter()
                    .map(|position| position.y)
                    .fold(frame.point(Joint::Head, clip.skeleton.head_top).y, f32::max)
            })
            .fold(0.5 * clip.skeleton.hip_height(), f32::max);
        let stances = Side::BOTH.map(|side| {
            subject.stances[side.index()]
                .iter()
                .filter(|span| span.last >= window.start && span.first < window.end)
                .map(|span| FrameSpan {
                    first: span.first.max(window.start) - window.start,
                    last: span.last.min(window.end - 1) - window.start,
                })
                .collect()
        });
        Ok(Self {
            first_frame: window.start,
            frame_rate_hz: clip.frame_rate_hz,
            frames,
            travel,
            headings,
            top,
            stances,
        })
    }

    /// Length of the window, seconds.
    pub(crate) fn duration_secs(&self) -> f64 {
        (self.frames.len() - 1) as f64 / self.frame_rate_hz
    }

    /// Time of the window's first frame in the clip, seconds.
    pub(crate) fn start_secs(&self) -> f64 {
        self.first_frame as f64 / self.frame_rate_hz
    }

    /// Horizontal place in metres: along the direction of travel, and to its left.
    pub(crate) fn on_ground(&self, point: Vec3) -> Vec2 {
        let left = Vec3::Y.cross(self.travel);
        Vec2::new(point.dot(self.travel), point.dot(left))
    }

    /// Least and largest place of the hips and toes on the ground.
    pub(crate) fn ground_bounds(&self) -> (Vec2, Vec2) {
        let joints = [Joint::Hips, Joint::LeftToes, Joint::RightToes];
        let mut bounds = (Vec2::MAX, Vec2::MIN);
        for frame in &self.frames {
            for joint in joints {
                let place = self.on_ground(frame.position(joint));
                bounds = (bounds.0.min(place), bounds.1.max(place));
            }
        }
        bounds
    }
}

fn frame_window(clip: &Clip, options: &SheetOptions) -> Range<usize> {
    let frames = clip.poses.len();
    let frame_at = |secs: f64| ((secs.max(0.0) * clip.frame_rate_hz).round() as usize).min(frames);
    let first = frame_at(options.start_secs);
    let end = options.seconds.map_or(frames, |seconds| {
        frame_at(options.start_secs + seconds)
            .saturating_add(1)
            .min(frames)
    });
    first..end.max(first)
}

fn smooth_headings(frames: &[ModelPose], frame_rate_hz: f64) -> Vec<f32> {
    let mut turned = 0.0;
    let mut previous = None;
    let unwrapped: Vec<f32> = frames
        .iter()
        .map(|frame| {
            let angle = heading(frame.rotation(Joint::Hips));
            turned = previous.map_or(angle, |before| turned + wrap_angle(angle - before));
            previous = Some(angle);
            turned
        })
        .collect();
    let half = (HEADING_HALF_WINDOW_SECS * frame_rate_hz).round() as usize;
    (0..frames.len())
        .map(|frame| {
            // The window stays symmetric at the ends, where a one-sided mean would lag.
            let reach = half.min(frame).min(frames.len() - 1 - frame);
            let around = &unwrapped[frame - reach..=frame + reach];
            around.iter().sum::<f32>() / around.len() as f32
        })
        .collect()
}

fn direction_of_travel(frames: &[ModelPose], headings: &[f32]) -> Vec3 {
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else {
        return Vec3::Z;
    };
    let mut net = last.position(Joint::Hips) - first.position(Joint::Hips);
    net.y = 0.0;
    if net.length() > LEAST_TRAVEL_M {
        return net.normalize();
    }
    let facing: Vec3 = headings
        .iter()
        .map(|angle| Vec3::new(angle.sin(), 0.0, angle.cos()))
        .sum();
    facing.try_normalize().unwrap_or(Vec3::Z)
}
