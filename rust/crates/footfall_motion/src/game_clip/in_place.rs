//! The way of a body that walks on the spot, from the foot that stands (Tilmanne et al. 2012, section 5.2.3).
//!
//! The lowest points of the feet bear the body. On the spot they move backwards; seen from them, the body moves forwards.

use crate::figure::sole_points;
use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Heel, ball and toe tip of both feet.
const POINTS: usize = 6;
/// Height above its resting level at which a point hardly bears, metres; at that level it bears fully.
const BEARING_HEIGHT_M: f32 = 0.004;
/// Points higher above their level do not bear, metres.
const MOST_HEIGHT_M: f32 = 0.04;
/// A standing point's velocity differs from that of the ground by at most this share of it.
const MOST_DIFFERENCE: f32 = 0.6;
/// Share of points' frames that lie below the level at which they rest: noise.
const LEVEL_SHARE: usize = 20;
/// Slower ground is standing, m/s.
const LEAST_SPEED_MPS: f32 = 0.15;
/// Share of the travel of its feet beyond which a body does not walk in place.
const MOST_TRAVEL: f32 = 0.3;

/// Offsets of the root that let the feet stand, for a clip that walks in place; `None` for one that travels or stands.
pub(super) fn way_of_feet(clip: &Clip, first: usize) -> Option<Vec<Vec3>> {
    let poses = clip.poses.get(first..).filter(|poses| poses.len() > 2)?;
    let mut model = ModelPose::default();
    let points: Vec<[Vec3; POINTS]> = poses
        .iter()
        .map(|pose| {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            let [left, right] = Side::BOTH.map(|side| sole_points(&clip.skeleton, &model, side));
            core::array::from_fn(|n| if n < 3 { left[n] } else { right[n - 3] })
        })
        .collect();
    let levels: [f32; POINTS] = core::array::from_fn(|n| {
        let mut heights: Vec<f32> = points.iter().map(|points| points[n].y).collect();
        heights.sort_by(f32::total_cmp);
        heights[heights.len() / LEVEL_SHARE]
    });
    let steps: Vec<[Step; POINTS]> = points
        .windows(2)
        .map(|pair| {
            core::array::from_fn(|n| Step {
                height: 0.5 * (pair[0][n].y + pair[1][n].y) - levels[n],
                shift: (pair[1][n] - pair[0][n]).with_y(0.0),
            })
        })
        .collect();
    let ground = median_of_lowest(&steps);
    if ground.length() * (clip.frame_rate_hz as f32) < LEAST_SPEED_MPS {
        return None;
    }
    let root = |frame: usize| poses[frame].root_position.with_y(0.0);
    let travelled = (root(poses.len() - 1) - root(0)) / steps.len() as f32;
    // The ground moves against the body's way: all of it on the spot, nothing of it where the body travels.
    let expected = travelled - ground;
    if travelled.dot(expected) > MOST_TRAVEL * expected.length_squared() {
        return None;
    }
    let shifts = bridged(
        &steps
            .iter()
            .map(|step| shift(step, ground))
            .collect::<Vec<_>>(),
        ground,
    );
    let mut at = Vec3::ZERO;
    let way = std::iter::once(Vec3::ZERO).chain(shifts.into_iter().map(|shift| {
        at -= shift;
        at
    }));
    Some(way.collect())
}

/// A point of a foot from one frame to the next.
#[derive(Clone, Copy)]
struct Step {
    /// Above the level at which it rests.
    height: f32,
    shift: Vec3,
}

/// Usual motion of the lowest point.
fn median_of_lowest(steps: &[[Step; POINTS]]) -> Vec3 {
    let lowest: Vec<Vec3> = steps
        .iter()
        .filter_map(|points| {
            let lowest = points.iter().min_by(|a, b| a.height.total_cmp(&b.height));
            lowest.map(|point| point.shift)
        })
        .collect();
    let median = |axis: usize| {
        let mut values: Vec<f32> = lowest.iter().map(|shift| shift[axis]).collect();
        values.sort_by(f32::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or_default()
    };
    Vec3::new(median(0), 0.0, median(2))
}

/// Motion of the ground in a frame, by the points that stand; `None` in flight.
fn shift(points: &[Step; POINTS], ground: Vec3) -> Option<Vec3> {
    let most = MOST_DIFFERENCE * ground.length();
    let (sum, weight) = points
        .iter()
        .filter(|point| point.height < MOST_HEIGHT_M && point.shift.distance(ground) < most)
        .map(|point| {
            let weight = (-point.height.max(0.0) / BEARING_HEIGHT_M).exp();
            (weight * point.shift, weight)
        })
        .fold((Vec3::ZERO, 0.0), |sum, next| {
            (sum.0 + next.0, sum.1 + next.1)
        });
    (weight > 1e-6).then(|| sum / weight)
}

/// Frames in flight take what is between those around them.
fn bridged(shifts: &[Option<Vec3>], ground: Vec3) -> Vec<Vec3> {
    let known = |frame: usize| shifts[frame].map(|shift| (frame, shift));
    (0..shifts.len())
        .map(|frame| {
            let before = (0..=frame).rev().find_map(known);
            let after = (frame..shifts.len()).find_map(known);
            match (before, after) {
                (Some((from, a)), Some((to, b))) if to > from => {
                    a.lerp(b, (frame - from) as f32 / (to - from) as f32)
                }
                (Some((_, shift)), _) | (_, Some((_, shift))) => shift,
                (None, None) => ground,
            }
        })
        .collect()
}
