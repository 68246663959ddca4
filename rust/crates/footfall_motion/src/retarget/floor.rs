//! Where the ground of a clip is: under the feet that stand.

use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Lowest point of a pose's soles.
fn lowest_point(clip: &Clip, model: &ModelPose) -> Vec3 {
    Side::BOTH
        .into_iter()
        .flat_map(|side| sole_points(clip, model, side))
        .min_by(|a, b| a.y.total_cmp(&b.y))
        .unwrap_or_default()
}

/// Heel, ball and toe tip of one foot in the space of the clip, metres.
pub(crate) fn sole_points(clip: &Clip, model: &ModelPose, side: Side) -> [Vec3; 3] {
    let shape = clip.skeleton.foot(side);
    [
        model.point(side.foot(), shape.heel),
        model.point(side.toes(), shape.ball),
        model.point(side.toes(), shape.toe_tip),
    ]
}

/// Height of the ground under the clip from frame `first` on, metres: the median height of the lowest point of the soles
/// over the frames in which that point hardly moves.
pub(super) fn floor_height(clip: &Clip, first: usize) -> Option<f32> {
    let mut model = ModelPose::default();
    let mut lowest = Vec::new();
    for pose in clip.poses.iter().skip(first) {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        lowest.push(lowest_point(clip, &model));
    }
    let rate = clip.frame_rate_hz as f32;
    let reach = ((0.025 * rate).round() as usize).max(1);
    let mut still: Vec<(f32, f32)> = (reach..lowest.len().saturating_sub(reach))
        .map(|n| {
            let speed = lowest[n + reach].distance(lowest[n - reach]) * rate / (2 * reach) as f32;
            (speed, lowest[n].y)
        })
        .collect();
    still.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Most frames of a walk have a foot on the ground, a third of a run's; jumps stand before and after.
    let limit = still.get(still.len() / 4)?.0.clamp(0.15, 0.8);
    let mut heights: Vec<f32> = still
        .iter()
        .take_while(|entry| entry.0 <= limit)
        .map(|entry| entry.1)
        .collect();
    heights.sort_by(f32::total_cmp);
    heights.get(heights.len() / 2).copied()
}

/// Shifts the clip so that its ground is at zero. Frames before `first` are put on the ground one by one.
pub(super) fn put_on_floor(clip: &mut Clip, first: usize) {
    let mut model = ModelPose::default();
    for pose in &mut clip.poses.iter_mut().take(first) {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        let lowest = Side::BOTH
            .into_iter()
            .flat_map(|side| {
                let shape = clip.skeleton.foot(side);
                [
                    model.point(side.foot(), shape.heel).y,
                    model.point(side.toes(), shape.ball).y,
                    model.point(side.toes(), shape.toe_tip).y,
                ]
            })
            .fold(f32::INFINITY, f32::min);
        pose.root_position.y -= lowest;
    }
    let floor = floor_height(clip, first).or_else(|| {
        // Too short for speeds: the lowest frame stands.
        clip.poses
            .iter()
            .skip(first)
            .map(|pose| {
                forward_kinematics(&clip.skeleton, pose, &mut model);
                lowest_point(clip, &model).y
            })
            .min_by(f32::total_cmp)
    });
    if let Some(floor) = floor {
        for pose in clip.poses.iter_mut().skip(first) {
            pose.root_position.y -= floor;
        }
    }
}
