//! Height and speed of the points on which a foot can stand.

use crate::figure::sole_points;
use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// A foot that swings at less than this, metres a second, does not swing.
pub(super) const LEAST_SWING_SPEED: f32 = 1.5;

/// One point over time.
#[derive(Clone, Debug)]
pub(super) struct PointSignal {
    /// Above its own resting level, metres.
    pub(super) height: Vec<f32>,
    /// Metres a second, over about 33 ms around the frame.
    pub(super) speed: Vec<f32>,
    /// Metres a second before or after the frame, whichever is less: small from the frame on in which a point comes to rest.
    pub(super) settling: Vec<f32>,
}

/// One foot over time, from the first frame of the motion on.
#[derive(Clone, Debug)]
pub(super) struct FootSignals {
    pub(super) heel: PointSignal,
    /// Ball or toe tip, whichever can bear: the lower height and the lesser speed of the two.
    pub(super) toe: PointSignal,
    /// What the heel's speed reaches in a swing of this clip.
    pub(super) swing_speed: f32,
}

impl FootSignals {
    pub(super) fn of(clip: &Clip, side: Side, first_frame: usize) -> Self {
        let mut model = ModelPose::default();
        let mut points: [Vec<Vec3>; 3] = Default::default();
        for pose in clip.poses.iter().skip(first_frame) {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            for (track, point) in points
                .iter_mut()
                .zip(sole_points(&clip.skeleton, &model, side))
            {
                track.push(point);
            }
        }
        let rate = clip.frame_rate_hz as f32;
        let [heel, ball, tip] = points.map(|track| point_signal(&track, rate));
        let mut sorted = heel.speed.clone();
        sorted.sort_by(f32::total_cmp);
        let swing_speed = sorted.get(sorted.len() * 9 / 10).copied().unwrap_or(0.0);
        let lesser = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a.min(*b)).collect();
        Self {
            heel,
            toe: PointSignal {
                height: lesser(&ball.height, &tip.height),
                speed: lesser(&ball.speed, &tip.speed),
                settling: lesser(&ball.settling, &tip.settling),
            },
            swing_speed,
        }
    }
}

fn point_signal(track: &[Vec3], rate: f32) -> PointSignal {
    let speed = speeds(track, rate);
    let level = resting_level(track, &speed);
    PointSignal {
        height: track.iter().map(|point| point.y - level).collect(),
        speed,
        settling: settling_speeds(track, rate),
    }
}

/// Speed from some frames before to as many after each frame. At high rates over 33 ms, for one frame of noise is no speed.
fn speeds(track: &[Vec3], rate: f32) -> Vec<f32> {
    let reach = reach(rate);
    let last = track.len().saturating_sub(1);
    (0..track.len())
        .map(|frame| {
            let (from, to) = (frame.saturating_sub(reach), (frame + reach).min(last));
            track[to].distance(track[from]) * rate / (to - from).max(1) as f32
        })
        .collect()
}

fn reach(rate: f32) -> usize {
    ((rate / 60.0).round() as usize).max(1)
}

/// The lesser of the speeds before and after each frame.
fn settling_speeds(track: &[Vec3], rate: f32) -> Vec<f32> {
    let reach = reach(rate);
    let speed = |from: usize, to: usize| track[to].distance(track[from]) * rate / reach as f32;
    (0..track.len())
        .map(|frame| {
            let before = frame.checked_sub(reach).map(|from| speed(from, frame));
            let to = frame + reach;
            let after = (to < track.len()).then(|| speed(frame, to));
            match (before, after) {
                (Some(before), Some(after)) => before.min(after),
                (before, after) => before.or(after).unwrap_or(0.0),
            }
        })
        .collect()
}

/// The height at which a point rests: the median over the frames in which it is slow and low.
fn resting_level(track: &[Vec3], speed: &[f32]) -> f32 {
    let mut order: Vec<usize> = (0..track.len()).collect();
    order.sort_by(|&a, &b| speed[a].total_cmp(&speed[b]));
    let limit = order
        .get(order.len() / 8)
        .map_or(0.3, |&frame| (1.5 * speed[frame]).clamp(0.25, 1.0));
    let mut heights: Vec<f32> = order
        .iter()
        .take_while(|&&frame| speed[frame] <= limit)
        .map(|&frame| track[frame].y)
        .collect();
    heights.sort_by(f32::total_cmp);
    let Some(&low) = heights.get(heights.len() / 10) else {
        return 0.0;
    };
    heights.retain(|height| *height <= low + 0.04);
    // A point that never comes near the ground of the clip rests on the ground, not in the air.
    heights[heights.len() / 2].clamp(-0.05, 0.05)
}
