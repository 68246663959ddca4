//! Floor of a clip: under the feet that stand.

use crate::figure::sole_points;
use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use glam::{Mat3, Quat, Vec2, Vec3};

/// Lowest point of a pose's soles.
fn lowest_point(clip: &Clip, model: &ModelPose) -> Vec3 {
    Side::BOTH
        .into_iter()
        .flat_map(|side| sole_points(&clip.skeleton, model, side))
        .min_by(|a, b| a.y.total_cmp(&b.y))
        .unwrap_or_default()
}

/// A plane under the feet: `height + slope · (x, z)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Floor {
    /// Metres at the origin.
    pub(super) height: f32,
    /// Rise along x and along z.
    pub(super) slope: Vec2,
}

impl Floor {
    fn at(&self, point: Vec3) -> f32 {
        self.height + self.slope.dot(Vec2::new(point.x, point.z))
    }
}

/// A captured floor is level to within this much; steeper ground is meant.
const STEEPEST: f32 = 0.05;
/// Slope of a captured floor by error of calibration, and distance of single stances from it, metres: the ridge of the fit.
const SLOPE_SPREAD: f32 = 0.02;
const STANCE_SPREAD: f32 = 0.01;
/// Frames of one stance are one observation.
const STANCE_SECS: f32 = 0.3;

/// The ground under the clip from frame `first` on: a plane through the lowest point of the soles in the frames in which
/// that point hardly moves, fitted robustly.
pub(super) fn floor_under(clip: &Clip, first: usize) -> Floor {
    let resting = resting_points(clip, first);
    let Some(median) = median(resting.iter().map(|point| point.y)) else {
        return Floor::default();
    };
    let count = resting.len() as f32;
    let centre = resting.iter().sum::<Vec3>() / count;
    let weight = 1.0 / (STANCE_SECS * clip.frame_rate_hz as f32).max(1.0);
    let ridge = (STANCE_SPREAD / SLOPE_SPREAD).powi(2);
    let mut floor = Floor {
        height: median,
        slope: Vec2::ZERO,
    };
    for _ in 0..12 {
        // Iteratively reweighted least squares about the centre; Huber's weights keep a foot that rests in the air out.
        let mut normal = Mat3::from_diagonal(Vec3::new(1e-6, ridge, ridge));
        let mut right = Vec3::ZERO;
        for point in &resting {
            let row = Vec3::new(1.0, point.x - centre.x, point.z - centre.z);
            let error = point.y - floor.at(*point - centre.with_y(0.0));
            let weight = weight * (STANCE_SPREAD / error.abs().max(STANCE_SPREAD)).powi(2);
            normal += Mat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
            right += row * (point.y * weight);
        }
        let solution = normal.inverse() * right;
        if !solution.is_finite() {
            break;
        }
        floor = Floor {
            height: solution.x,
            slope: Vec2::new(solution.y, solution.z).clamp_length_max(STEEPEST),
        };
    }
    floor.height -= floor.slope.dot(Vec2::new(centre.x, centre.z));
    floor
}

/// Lowest points of the soles in the frames in which they hardly move; if there are none, the lowest of all.
fn resting_points(clip: &Clip, first: usize) -> Vec<Vec3> {
    let mut model = ModelPose::default();
    let mut lowest = Vec::new();
    for pose in clip.poses.iter().skip(first) {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        lowest.push(lowest_point(clip, &model));
    }
    let rate = clip.frame_rate_hz as f32;
    let reach = ((0.025 * rate).round() as usize).max(1);
    let mut still: Vec<(f32, Vec3)> = (reach..lowest.len().saturating_sub(reach))
        .map(|n| {
            let speed = lowest[n + reach].distance(lowest[n - reach]) * rate / (2 * reach) as f32;
            (speed, lowest[n])
        })
        .collect();
    still.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Most frames of a walk have a foot on the ground, a third of a run's; jumps stand before and after.
    let quarter = still.get(still.len() / 4).map_or(0.0, |quarter| quarter.0);
    let limit = quarter.clamp(0.15, 0.8);
    let resting: Vec<Vec3> = still
        .iter()
        .take_while(|entry| entry.0 <= limit)
        .map(|entry| entry.1)
        .collect();
    if resting.is_empty() {
        // Too short for speeds, or in place, where no foot rests.
        let lowest = lowest.into_iter().min_by(|a, b| a.y.total_cmp(&b.y));
        return lowest.into_iter().collect();
    }
    resting
}

fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut sorted: Vec<f32> = values.collect();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Shifts every frame up or down so that the ground is at zero. Frames before `first` are put on the ground one by one.
///
/// A sloping floor is taken out by height alone, so that directions stay as captured.
pub(super) fn put_on_floor(clip: &mut Clip, first: usize) {
    let floor = floor_under(clip, first);
    let mut model = ModelPose::default();
    for frame in 0..clip.poses.len() {
        let rise = if frame < first {
            forward_kinematics(&clip.skeleton, &clip.poses[frame], &mut model);
            lowest_point(clip, &model).y
        } else {
            floor.at(clip.poses[frame].root_position)
        };
        clip.poses[frame].root_position.y -= rise;
    }
}

/// Bends toes that point into the ground up until their tips touch it.
///
/// Many captured bodies have stiff toes: they push off on the tip of the toes where a person's toes lie flat.
pub(super) fn lift_toes(clip: &mut Clip) {
    /// The toes never point up more than this on account of the ground, radians.
    const MOST_RAISED: f32 = 0.5;
    let mut model = ModelPose::default();
    for pose in &mut clip.poses {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        for side in Side::BOTH {
            let toes = side.toes();
            let tip = model.rotation(toes) * clip.skeleton.foot(side).toe_tip;
            let height = model.position(toes).y;
            let length = tip.length();
            if tip.y + height >= 0.0 || length < 1e-4 {
                continue;
            }
            let raised = (-height / length).clamp(-1.0, 1.0).asin().min(MOST_RAISED);
            let turn = raised - (tip.y / length).clamp(-1.0, 1.0).asin();
            // Positive about this axis turns a level direction upward.
            let Some(axis) = tip.cross(Vec3::Y).try_normalize() else {
                continue;
            };
            let foot = model.rotation(side.foot());
            let raise = Quat::from_axis_angle(axis, turn.max(0.0));
            pose.rotations[toes.index()] =
                (foot.inverse() * raise * model.rotation(toes)).normalize();
        }
    }
}
