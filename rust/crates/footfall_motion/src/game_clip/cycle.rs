//! Clips that end as they begin.

use footfall_core::rotation::{from_heading, heading};
use footfall_core::{Clip, Joint, Pose};
use glam::{Quat, Vec3};

/// Longer clips are recordings, whatever their ends are like.
const LONGEST_SECS: f64 = 6.0;
const LEAST_FRAMES: usize = 8;
/// Differences between the ends of a loop, as shares of the usual change from frame to frame: where the last frame is the first one
/// again, and where it is the one before.
const SAME: f32 = 0.5;
const NEXT: f32 = 1.8;
/// Change of a held frame at most, as a share of the usual change. Engines hold the last frame of a clip that lacks the one after it.
const HELD: f32 = 0.1;
/// A slower change is no movement, radians a frame, sum of all joints.
const LEAST_CHANGE: f32 = 0.02;
/// Time for which a loop is repeated, and the greatest number of repetitions.
const WANTED_SECS: f64 = 9.0;
const MOST_REPEATS: usize = 12;

/// Frames of one round, for a clip that is a loop.
pub(super) fn find(clip: &Clip, first: usize) -> Option<usize> {
    let poses = clip.poses.get(first..)?;
    let count = poses.len();
    if count < LEAST_FRAMES || count as f64 > LONGEST_SECS * clip.frame_rate_hz {
        return None;
    }
    let changes: Vec<f32> = poses
        .windows(2)
        .map(|pair| difference(&pair[0], &pair[1]))
        .collect();
    let mut sorted = changes.clone();
    sorted.sort_by(f32::total_cmp);
    let usual = sorted[sorted.len() / 2];
    if usual < LEAST_CHANGE {
        return None;
    }
    let held = changes
        .iter()
        .rev()
        .take_while(|change| **change < HELD * usual);
    let count = count - held.count();
    let to_first = |frame: usize| difference(&poses[frame], &poses[0]);
    let last = to_first(count - 1);
    if last < SAME * usual {
        Some(count - 1)
    } else if last < NEXT * usual && last < to_first(count - 2) {
        Some(count)
    } else {
        None
    }
}

/// Repeats the clip's motion with its travel, and returns how often it is there now.
pub(super) fn unroll(clip: &mut Clip, first: usize, cycle: usize) -> usize {
    let mut poses = clip.poses.split_off(first.min(clip.poses.len()));
    let is_first_again =
        |last: &Pose| difference(last, &poses[0]) < difference(last, &poses[cycle - 1]);
    let closes = poses.get(cycle).is_some_and(is_first_again);
    poses.truncate(cycle + usize::from(closes));
    let secs = cycle as f64 / clip.frame_rate_hz;
    let repeats = ((WANTED_SECS / secs).ceil() as usize).clamp(2, MOST_REPEATS);
    let (turn, travel) = round(&poses, cycle);
    clip.poses.clear();
    let (mut turned, mut travelled) = (0.0, Vec3::ZERO);
    for _ in 0..repeats {
        for pose in poses.iter().take(cycle) {
            clip.poses.push(moved(pose, turned, travelled));
        }
        travelled += from_heading(turned) * travel;
        turned += turn;
    }
    // The first frame once more: the last step ends within the clip.
    clip.poses
        .extend(poses.first().map(|pose| moved(pose, turned, travelled)));
    repeats
}

/// Turn of the body and its way in one round, seen from where it begins with heading as it is.
fn round(poses: &[Pose], cycle: usize) -> (f32, Vec3) {
    let place = |frame: usize| poses[frame].root_position.with_y(0.0);
    let facing = |frame: usize| heading(poses[frame].rotation(Joint::Hips));
    let last = poses.len() - 1;
    let mut turn = facing(last) - facing(0);
    let mut end = place(last);
    if cycle == poses.len() {
        // One frame is wanting: as fast as before and after it.
        let ahead = facing(1) - facing(0);
        let behind = facing(last) - facing(last - 1);
        turn += 0.5 * (wrapped(ahead) + wrapped(behind));
        let onward = from_heading(turn) * (place(1) - place(0));
        end += 0.5 * (onward + place(last) - place(last - 1));
    }
    let turn = wrapped(turn);
    (turn, end - from_heading(turn) * place(0))
}

/// A pose turned about the origin, then moved.
fn moved(pose: &Pose, turn: f32, travel: Vec3) -> Pose {
    let turn = from_heading(turn);
    let mut moved = pose.clone();
    moved.root_position = turn * pose.root_position + travel;
    moved.rotations[0] = (turn * pose.rotations[0]).normalize();
    moved
}

fn wrapped(angle: f32) -> f32 {
    let turn = core::f32::consts::TAU;
    angle - (angle / turn).round() * turn
}

/// Difference between the postures of two bodies, wherever they stand and face: radians, sum of all joints.
fn difference(a: &Pose, b: &Pose) -> f32 {
    let level = |pose: &Pose| -> Quat {
        let hips = pose.rotation(Joint::Hips);
        from_heading(-heading(hips)) * hips
    };
    let joints = Joint::ALL.into_iter().skip(1);
    let limbs: f32 = joints
        .map(|joint| a.rotation(joint).angle_between(b.rotation(joint)))
        .sum();
    limbs + level(a).angle_between(level(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::Skeleton;

    /// Legs that swing once in `period` frames while the body turns and travels.
    fn swinging(frames: usize, period: f32) -> Clip {
        let skeleton = Skeleton::standard();
        let poses = (0..frames).map(|frame| {
            let mut pose = Pose::rest(&skeleton);
            let phase = core::f32::consts::TAU * frame as f32 / period;
            for (joint, sign) in [(Joint::LeftUpperLeg, 1.0), (Joint::RightUpperLeg, -1.0)] {
                pose.rotations[joint.index()] = Quat::from_rotation_x(sign * 0.4 * phase.sin());
            }
            let turned = 0.01 * frame as f32;
            pose.rotations[0] = from_heading(turned);
            // On a circle of 2 m.
            pose.root_position += 2.0 * Vec3::new(1.0 - turned.cos(), 0.0, turned.sin());
            pose
        });
        Clip {
            poses: poses.collect(),
            skeleton: skeleton.clone(),
            frame_rate_hz: 30.0,
        }
    }

    #[test]
    fn loops_are_found_with_and_without_their_last_frame_and_nothing_else_is() {
        assert_eq!(find(&swinging(31, 30.0), 0), Some(30));
        assert_eq!(find(&swinging(30, 30.0), 0), Some(30));
        assert_eq!(find(&swinging(26, 30.0), 0), None);
        assert_eq!(find(&swinging(301, 30.0), 0), None);
        let still = Clip {
            poses: vec![Pose::rest(&Skeleton::standard()); 31],
            ..swinging(1, 30.0)
        };
        assert_eq!(find(&still, 0), None);
    }

    /// A clip whose last frame is held for so many frames.
    fn held(clip: Clip, frames: usize) -> Clip {
        let last = clip.poses.iter().last().cloned();
        let held = last.into_iter().cycle().take(frames);
        let poses = clip.poses.into_iter().chain(held).collect();
        Clip { poses, ..clip }
    }

    #[test]
    fn a_last_frame_that_is_held_is_none_of_the_loop() {
        for frames in 1..4 {
            assert_eq!(find(&held(swinging(30, 30.0), frames), 0), Some(30));
            assert_eq!(find(&held(swinging(31, 30.0), frames), 0), Some(30));
            assert_eq!(find(&held(swinging(26, 30.0), frames), 0), None);
        }
    }

    #[test]
    fn a_loop_goes_on_where_it_came_to() {
        for mut clip in [
            swinging(30, 30.0),
            swinging(31, 30.0),
            held(swinging(30, 30.0), 1),
            held(swinging(31, 30.0), 2),
        ] {
            let frames = clip.poses.len();
            let repeats = unroll(&mut clip, 0, 30);
            assert_eq!(clip.poses.len(), repeats * 30 + 1);
            let whole = swinging(repeats * 30 + 1, 30.0);
            for (frame, (got, wanted)) in clip.poses.iter().zip(&whole.poses).enumerate() {
                let apart = got.root_position.distance(wanted.root_position);
                assert!(apart < 0.01, "{frames} frames, frame {frame}: {apart}");
                assert!(difference(got, wanted) < 0.01);
            }
        }
    }
}
