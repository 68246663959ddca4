//! Slip of standing and landing feet, by a contact rule of its own: the generator's is not to judge itself.

use super::joint_positions;
use footfall_core::{Clip, ModelPose, Side};
use glam::Vec3;

const CLEARANCE_ON_M: f32 = 0.02;
const CLEARANCE_OFF_M: f32 = 0.035;
const SLIP_ON_MPS: f32 = 0.35;
const SLIP_OFF_MPS: f32 = 0.6;
const END_MARGIN_SECS: f64 = 0.05;
/// Contacts shorter than this are noise.
const LEAST_CONTACT_SECS: f64 = 0.1;
/// A foot-fixed point is at floor level when it is within this of the foot's lowest point.
const FLOOR_LEVEL_M: f32 = 0.01;
const SOLE_SAMPLES: usize = 8;
/// The sole from heel to ball, then the ball and the tip of the toes, which turn with the toes.
const POINTS: usize = SOLE_SAMPLES + 3;

/// Slip of the feet in single frames, m/s, in no particular order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slips {
    /// While feet stand: 50 ms at both ends of a contact are left out.
    pub standing: Vec<f64>,
    /// While they land: the first 50 ms of a contact but its first frame, part of whose motion was before it.
    pub landing: Vec<f64>,
}

/// Slip of the feet in every frame in which they stand, m/s, in no particular order: [`Slips::standing`].
pub fn contact_slips(clip: &Clip) -> Vec<f64> {
    slips(clip).standing
}

/// Slip of the feet in contact.
///
/// A foot is in contact from when its sole's clearance is under 2 cm and its slip under 0.35 m/s until they reach 3.5 cm or
/// 0.6 m/s, if that lasts 0.1 s. Slip is the least horizontal speed among the points that could be the pivot: points fixed to
/// the foot at floor level, the ball and the tip of the toes.
pub fn slips(clip: &Clip) -> Slips {
    let frames = joint_positions(clip);
    let rate = clip.frame_rate_hz;
    let margin = (END_MARGIN_SECS * rate).ceil() as usize;
    let mut slips = Slips::default();
    for side in Side::BOTH {
        let feet: Vec<[Vec3; POINTS]> = frames
            .iter()
            .map(|frame| sole_points(clip, frame, side))
            .collect();
        let slip: Vec<f32> = (0..feet.len())
            .map(|frame| slip_at(&feet, frame, rate))
            .collect();
        let values = |frames: core::ops::Range<usize>| frames.map(|frame| f64::from(slip[frame]));
        for (first, last) in contacts(&feet, &slip, rate) {
            let standing = first + margin..(last + 1).saturating_sub(margin);
            slips.standing.extend(values(standing));
            let landing = first + 1..(first + margin).min(last + 1);
            slips.landing.extend(values(landing));
        }
    }
    slips
}

fn sole_points(clip: &Clip, frame: &ModelPose, side: Side) -> [Vec3; POINTS] {
    let shape = clip.skeleton.foot(side);
    let ball = clip.skeleton.offset(side.toes()) + shape.ball;
    core::array::from_fn(|index| match index.checked_sub(SOLE_SAMPLES + 1) {
        None => {
            let share = index as f32 / SOLE_SAMPLES as f32;
            frame.point(side.foot(), shape.heel.lerp(ball, share))
        }
        Some(0) => frame.point(side.toes(), shape.ball),
        Some(_) => frame.point(side.toes(), shape.toe_tip),
    })
}

fn lowest(points: &[Vec3; POINTS]) -> f32 {
    points.iter().map(|point| point.y).fold(f32::MAX, f32::min)
}

fn slip_at(feet: &[[Vec3; POINTS]], frame: usize, rate: f64) -> f32 {
    let (before, after) = (frame.saturating_sub(1), (frame + 1).min(feet.len() - 1));
    if before == after {
        return 0.0;
    }
    let floor = lowest(&feet[frame]);
    let secs = ((after - before) as f64 / rate) as f32;
    (0..POINTS)
        .filter(|&index| index > SOLE_SAMPLES || feet[frame][index].y < floor + FLOOR_LEVEL_M)
        .map(|index| {
            (feet[after][index] - feet[before][index])
                .with_y(0.0)
                .length()
                / secs
        })
        .fold(f32::MAX, f32::min)
}

fn contacts(feet: &[[Vec3; POINTS]], slip: &[f32], rate: f64) -> Vec<(usize, usize)> {
    let mut contacts = Vec::new();
    let mut begun = None;
    for frame in 0..=feet.len() {
        let stands = feet.get(frame).is_some_and(|foot| {
            let (height, speed) = if begun.is_some() {
                (CLEARANCE_OFF_M, SLIP_OFF_MPS)
            } else {
                (CLEARANCE_ON_M, SLIP_ON_MPS)
            };
            lowest(foot) < height && slip[frame] < speed
        });
        match (begun, stands) {
            (None, true) => begun = Some(frame),
            (Some(first), false) => {
                if (frame - first) as f64 >= LEAST_CONTACT_SECS * rate {
                    contacts.push((first, frame - 1));
                }
                begun = None;
            }
            _ => {}
        }
    }
    contacts
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};
    use glam::Quat;

    fn clip(poses: impl Iterator<Item = Pose>) -> Clip {
        Clip {
            skeleton: Skeleton::standard(),
            frame_rate_hz: 60.0,
            poses: poses.collect(),
        }
    }

    fn standing() -> Pose {
        Pose::rest(&Skeleton::standard())
    }

    #[test]
    fn a_slide_is_as_fast_as_it_is() {
        let sliding = clip((0..60).map(|frame| {
            let mut pose = standing();
            pose.root_position.z += 0.2 * frame as f32 / 60.0;
            pose
        }));
        let slips = contact_slips(&sliding);
        assert_eq!(slips.len(), 2 * (60 - 6));
        assert!(
            slips.iter().all(|slip| (slip - 0.2).abs() < 1e-3),
            "{slips:?}"
        );
    }

    #[test]
    fn a_slide_that_ends_shows_in_the_landing_alone() {
        // Down after half a second, sliding on for 50 ms.
        let landing = clip((0..60).map(|frame| {
            let mut pose = standing();
            pose.root_position.y += if frame < 30 { 0.1 } else { 0.0 };
            pose.root_position.z += 0.3 * frame.min(33) as f32 / 60.0;
            pose
        }));
        let slips = slips(&landing);
        assert!(
            slips.landing.iter().all(|slip| (slip - 0.3).abs() < 1e-3),
            "{slips:?}"
        );
        assert_eq!(slips.landing.len(), 2 * 2);
        let slow = slips.standing.iter().filter(|slip| **slip < 1e-3).count();
        assert!(slow >= slips.standing.len() - 2, "{slips:?}");
    }

    #[test]
    fn a_foot_that_rolls_on_its_toes_does_not_slip() {
        // The ankle turns about the ball, which stays; the hips follow.
        let skeleton = Skeleton::standard();
        let ball = skeleton.offset(footfall_core::Joint::LeftToes) + skeleton.feet[0].ball;
        let rolling = clip((0..60).map(|frame| {
            let turn = Quat::from_rotation_x(0.01 * frame as f32);
            let mut pose = standing();
            pose.root_position += ball - turn * ball;
            for joint in [
                footfall_core::Joint::LeftFoot,
                footfall_core::Joint::RightFoot,
            ] {
                pose.rotations[joint.index()] = turn;
            }
            for joint in [
                footfall_core::Joint::LeftToes,
                footfall_core::Joint::RightToes,
            ] {
                pose.rotations[joint.index()] = turn.inverse();
            }
            pose
        }));
        let slips = contact_slips(&rolling);
        assert!(slips.len() > 100);
        assert!(slips.iter().all(|slip| *slip < 0.015), "{slips:?}");
    }

    #[test]
    fn feet_in_the_air_and_fast_feet_do_not_stand() {
        let floating = clip((0..60).map(|_| {
            let mut pose = standing();
            pose.root_position.y += 0.1;
            pose
        }));
        assert!(contact_slips(&floating).is_empty());
        let racing = clip((0..60).map(|frame| {
            let mut pose = standing();
            pose.root_position.z += frame as f32 / 60.0;
            pose
        }));
        assert!(contact_slips(&racing).is_empty());
    }
}
