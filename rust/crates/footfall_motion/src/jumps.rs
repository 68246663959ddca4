//! Jumps off both feet: from standing, through a load and a flight, to standing again.

use footfall_core::rotation::{from_heading, heading, wrap_angle};
use footfall_core::{Clip, Joint, ModelPose, Pose, Side, forward_kinematics};
use glam::Vec3;

/// Height of the ball of a foot above its standing level at which it is in the air, metres: at take-off the tips of the toes leave last.
const LIFTED_M: f32 = 0.045;
/// Share of the frames in which a foot that jumps now and then is lower than on the ground, by noise.
const BELOW_GROUND_SHARE: f64 = 0.05;
/// Range of the duration of flights, seconds: shorter ones are hops on the spot or noise, longer ones do not occur.
const FLIGHT_SECS: [f64; 2] = [0.18, 0.9];
/// Both feet leave the ground, and land, within so short a time, seconds.
const TOGETHER_SECS: f64 = 0.1;
/// Longest duration of loads and landings, seconds.
const LONGEST_PHASE_SECS: f64 = 1.3;
/// Hips that are so much lower than in standing have left it, as a share of their height in the T-pose, and hips of those who stand are at least as
/// high as the second share.
const LEFT_STANDING_SHARE: f32 = 0.015;
const STANDING_SHARE: f32 = 0.88;
/// Hips that rise faster than this push off, m/s.
const PUSHING_MPS: f32 = 0.1;
/// Hips of a standing person go no faster over the ground, m/s.
const STANDING_MPS: f32 = 0.4;
/// Trunks of standing people lean forwards less than this, radians, and of those who begin to jump no further beyond their most upright posture.
const STOOPED_RAD: f32 = 0.15;
const LEANING_RAD: f32 = 0.05;
/// Trunk and arms begin so much earlier than the hips at most, seconds.
const EARLIER_SECS: f64 = 0.8;
/// Least rise of the hips above standing, as a share of their height in the T-pose: feet that are drawn up are no jump.
const LEAST_RISE_SHARE: f32 = 0.08;
/// Largest turn within a jump, radians: farther turns make another kind of jump, in which trunk and arms turn first.
const MOST_TURN_RAD: f32 = 1.9;

/// One jump, in frames of its clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Jump {
    /// The last frame of standing before it: upright, with the hips high.
    pub begin: usize,
    /// The last frame before the hips go up to take off.
    pub push: usize,
    /// The last frame in which a foot bears.
    pub take_off: usize,
    /// The first frame in which a foot bears again.
    pub landing: usize,
    /// The frame in which the hips are lowest after that.
    pub lowest: usize,
    /// The first frame of standing after it.
    pub end: usize,
}

/// The jumps off both feet in a clip, without its first frames: those that begin upright, end standing and do not turn far.
pub fn two_footed_jumps(clip: &Clip, skip_frames: usize) -> Vec<Jump> {
    let poses = clip.poses.get(skip_frames..).unwrap_or_default();
    if poses.is_empty() {
        return Vec::new();
    }
    let feet = Side::BOTH.map(|side| in_the_air(clip, poses, side));
    let flies: Vec<bool> = feet[0]
        .iter()
        .zip(&feet[1])
        .map(|(l, r)| *l && *r)
        .collect();
    let rate = clip.frame_rate_hz;
    let seconds = |frames: usize| frames as f64 / rate;
    let body = Body { clip, poses };
    footfall_core::FrameSpan::runs(&flies)
        .into_iter()
        .filter(|flight| {
            let secs = seconds(flight.last + 1 - flight.first);
            (FLIGHT_SECS[0]..FLIGHT_SECS[1]).contains(&secs)
        })
        .filter(|flight| {
            let most = (TOGETHER_SECS * rate).round() as usize;
            feet.iter().all(|airborne| {
                let alone_before = flight.first.saturating_sub(most + 1);
                let alone_after = (flight.last + most + 1).min(airborne.len() - 1);
                !airborne[alone_before] && !airborne[alone_after]
            })
        })
        .filter_map(|flight| {
            let take_off = flight.first.checked_sub(1)?;
            let landing = flight.last + 1;
            let begin = body.stands_before(take_off)?;
            let (lowest, end) = body.stands_after(landing)?;
            let jump = Jump {
                begin,
                push: body.pushes_from(begin, take_off),
                take_off,
                landing,
                lowest,
                end,
            };
            (body.rises(&jump) && body.is_straight(&jump)).then_some(Jump {
                begin: jump.begin + skip_frames,
                push: jump.push + skip_frames,
                take_off: jump.take_off + skip_frames,
                landing: jump.landing + skip_frames,
                lowest: jump.lowest + skip_frames,
                end: jump.end + skip_frames,
            })
        })
        .collect()
}

/// In which frames the ball of a foot is in the air.
fn in_the_air(clip: &Clip, poses: &[Pose], side: Side) -> Vec<bool> {
    let mut body = ModelPose::default();
    let heights: Vec<f32> = poses
        .iter()
        .map(|pose| {
            forward_kinematics(&clip.skeleton, pose, &mut body);
            body.position(side.toes()).y
        })
        .collect();
    let mut sorted = heights.clone();
    sorted.sort_by(f32::total_cmp);
    let ground = sorted[(BELOW_GROUND_SHARE * (sorted.len() - 1) as f64) as usize];
    heights
        .iter()
        .map(|height| *height > ground + LIFTED_M)
        .collect()
}

/// The hips of a recording.
struct Body<'a> {
    clip: &'a Clip,
    poses: &'a [Pose],
}

impl Body<'_> {
    fn height(&self, frame: usize) -> f32 {
        self.poses[frame].root_position.y
    }

    /// Frames of the longest load or landing.
    fn longest(&self) -> usize {
        (LONGEST_PHASE_SECS * self.clip.frame_rate_hz) as usize
    }

    /// The last frame of standing before a take-off.
    fn stands_before(&self, take_off: usize) -> Option<usize> {
        let first = take_off.saturating_sub(self.longest());
        let lowest = self.lowest(first..=take_off)?;
        let standing = (first..=lowest).map(|frame| self.height(frame));
        let left = self.left_standing(standing)?;
        let sinks = (first..=lowest).rev().find(|f| self.height(*f) > left)?;
        let begin = self.upright_before(sinks)?;
        self.is_slow(begin).then_some(begin)
    }

    /// The last frame up to this one in which the trunk is upright: it and the arms begin a jump before the hips sink.
    fn upright_before(&self, sinks: usize) -> Option<usize> {
        let earlier = (EARLIER_SECS * self.clip.frame_rate_hz) as usize;
        let first = sinks.saturating_sub(earlier);
        let leans: Vec<f32> = (first..=sinks).map(|frame| self.lean(frame)).collect();
        let upright = leans.iter().copied().fold(f32::INFINITY, f32::min);
        let within = leans
            .iter()
            .rposition(|lean| *lean < upright + LEANING_RAD)?;
        (upright < STOOPED_RAD).then_some(first + within)
    }

    /// Angle by which the trunk leans forwards, radians.
    fn lean(&self, frame: usize) -> f32 {
        let pose = &self.poses[frame];
        let body = ModelPose::of(&self.clip.skeleton, pose);
        let trunk = body.position(Joint::Neck) - body.position(Joint::Hips);
        let ahead = from_heading(heading(pose.rotation(Joint::Hips))) * Vec3::Z;
        trunk.dot(ahead).atan2(trunk.y)
    }

    /// The last frame before a take-off in which the hips do not go up yet.
    fn pushes_from(&self, begin: usize, take_off: usize) -> usize {
        let rate = self.clip.frame_rate_hz as f32;
        let rises = |frame: &usize| {
            let [from, to] = [frame - 1, frame + 1];
            0.5 * rate * (self.height(to) - self.height(from)) > PUSHING_MPS
        };
        let first = (begin + 1..take_off).rev().take_while(rises).last();
        first.unwrap_or(take_off).saturating_sub(1).max(begin)
    }

    /// The frame in which hips are lowest after a landing, and the first of standing after it.
    fn stands_after(&self, landing: usize) -> Option<(usize, usize)> {
        let last = (landing + self.longest()).min(self.poses.len() - 1);
        let soon = (landing + self.longest() / 2).min(last);
        let lowest = self.lowest(landing..=soon)?;
        let standing = (lowest..=last).map(|frame| self.height(frame));
        let left = self.left_standing(standing)?;
        let end = (lowest..=last).find(|frame| self.height(*frame) > left)?;
        self.is_slow(end).then_some((lowest, end))
    }

    fn lowest(&self, mut frames: core::ops::RangeInclusive<usize>) -> Option<usize> {
        let first = frames.next()?;
        Some(frames.fold(first, |lowest, frame| {
            if self.height(frame) < self.height(lowest) {
                frame
            } else {
                lowest
            }
        }))
    }

    /// The height below which hips have left standing, where they stand as high as these at most.
    fn left_standing(&self, heights: impl Iterator<Item = f32>) -> Option<f32> {
        let own = self.clip.skeleton.hip_height();
        let standing = heights.fold(0.0, f32::max);
        (standing > STANDING_SHARE * own).then_some(standing - LEFT_STANDING_SHARE * own)
    }

    fn is_slow(&self, frame: usize) -> bool {
        let reach = (0.05 * self.clip.frame_rate_hz).ceil() as usize;
        let [from, to] = [
            frame.saturating_sub(reach),
            (frame + reach).min(self.poses.len() - 1),
        ];
        let way = self.poses[to].root_position - self.poses[from].root_position;
        let secs = (to - from).max(1) as f32 / self.clip.frame_rate_hz as f32;
        way.with_y(0.0).length() < STANDING_MPS * secs
    }

    /// Returns true when the hips go up in a jump, rather than the feet.
    fn rises(&self, jump: &Jump) -> bool {
        let heights = (jump.take_off..=jump.landing).map(|frame| self.height(frame));
        let standing = self.height(jump.begin).max(self.height(jump.end));
        heights.fold(0.0, f32::max) > standing + LEAST_RISE_SHARE * self.clip.skeleton.hip_height()
    }

    /// Returns true when a jump goes forwards or up, and does not turn.
    fn is_straight(&self, jump: &Jump) -> bool {
        let [from, to] = [jump.begin, jump.end].map(|frame| &self.poses[frame]);
        let faces = |pose: &Pose| heading(pose.rotation(Joint::Hips));
        let turn = wrap_angle(faces(to) - faces(from));
        let way = to.root_position - from.root_position;
        let ahead = from_heading(faces(from)) * Vec3::Z;
        let aside = (way.with_y(0.0) - way.dot(ahead) * ahead).length();
        turn.abs() < MOST_TURN_RAD && aside < 0.2 + 0.3 * way.dot(ahead).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::Skeleton;
    use glam::Quat;

    const RATE: f64 = 60.0;

    /// A body whose hips follow these heights above standing: below it the knees of the jumping legs bend, the other leg is held up all the time.
    fn clip(heights: &[f32], jumps_on: [bool; 2]) -> Clip {
        let skeleton = Skeleton::standard();
        let [thigh, shank] =
            [Joint::LeftLowerLeg, Joint::LeftFoot].map(|joint| skeleton.offset(joint).length());
        let poses = heights.iter().map(|up| {
            let mut pose = Pose::rest(&skeleton);
            pose.root_position.y += up;
            for side in Side::BOTH {
                let drop = (-up.min(0.0)).min(thigh);
                let bend = if jumps_on[side.index()] {
                    (1.0 - drop / (thigh + shank)).acos()
                } else {
                    1.2
                };
                let mut set = |joint: Joint, angle: f32| {
                    pose.rotations[joint.index()] = Quat::from_rotation_x(angle);
                };
                set(side.upper_leg(), -bend);
                set(side.lower_leg(), 2.0 * bend);
                set(side.foot(), -bend);
            }
            pose
        });
        Clip {
            skeleton: skeleton.clone(),
            frame_rate_hz: RATE,
            poses: poses.collect(),
        }
    }

    /// A second of standing, a load of 0.6 s, a flight, a landing of 0.6 s, and standing.
    fn heights(flight_secs: f32) -> Vec<f32> {
        let speed = 0.5 * 9.81 * flight_secs;
        let dip = |s: f32| -0.25 * (core::f32::consts::PI * s).sin();
        let mut heights = vec![0.0; 60];
        heights.extend((1..36).map(|frame| dip(frame as f32 / 36.0)));
        let frames = (flight_secs * RATE as f32).round() as usize;
        heights.extend((0..=frames).map(|frame| {
            let t = frame as f32 / RATE as f32;
            (speed * t - 0.5 * 9.81 * t * t).max(0.0)
        }));
        heights.extend((1..36).map(|frame| dip(frame as f32 / 36.0)));
        heights.extend([0.0; 60]);
        heights
    }

    #[test]
    fn a_jump_is_found_with_its_phases() {
        let jumps = two_footed_jumps(&clip(&heights(0.5), [true; 2]), 0);
        let [jump] = jumps[..] else {
            panic!("{jumps:?}");
        };
        let near = |frame: usize, expected: usize| frame.abs_diff(expected) <= 3;
        assert!(near(jump.begin, 60), "{jump:?}");
        assert!(near(jump.push, 78), "{jump:?}");
        assert!(near(jump.lowest, 142), "{jump:?}");
        assert!(near(jump.take_off, 96), "{jump:?}");
        assert!(near(jump.landing, 124), "{jump:?}");
        assert!(near(jump.end, 161), "{jump:?}");
    }

    /// Leans the trunk of a clip forwards by this angle between two frames, and as far for the rest of the load.
    fn lean(clip: &mut Clip, from: usize, to: usize, angle: f32) {
        for (frame, pose) in clip.poses.iter_mut().enumerate().take(90) {
            let share = (frame as f32 - from as f32) / (to - from) as f32;
            pose.rotations[Joint::Spine.index()] =
                Quat::from_rotation_x(angle * share.clamp(0.0, 1.0));
        }
    }

    #[test]
    fn a_jump_begins_with_the_trunk_and_out_of_an_upright_one_only() {
        let mut leaning = clip(&heights(0.5), [true; 2]);
        lean(&mut leaning, 30, 70, 0.8);
        let jumps = two_footed_jumps(&leaning, 0);
        let [jump] = jumps[..] else {
            panic!("{jumps:?}");
        };
        assert!(jump.begin.abs_diff(33) <= 3, "{jump:?}");
        let mut stooped = clip(&heights(0.5), [true; 2]);
        lean(&mut stooped, 0, 1, 0.8);
        stooped.poses[0] = stooped.poses[1].clone();
        assert!(two_footed_jumps(&stooped, 0).is_empty());
    }

    #[test]
    fn a_step_on_one_leg_and_a_bow_are_none() {
        let one_leg = two_footed_jumps(&clip(&heights(0.5), [true, false]), 0);
        assert!(one_leg.is_empty(), "{one_leg:?}");
        let short = two_footed_jumps(&clip(&heights(0.12), [true; 2]), 0);
        assert!(short.is_empty(), "{short:?}");
        assert!(two_footed_jumps(&clip(&[], [true; 2]), 0).is_empty());
        assert!(two_footed_jumps(&clip(&heights(0.5), [true; 2]), 999).is_empty());
    }

    #[test]
    fn who_does_not_stand_before_makes_no_jump_out_of_standing() {
        let mut hopping = heights(0.4);
        hopping.drain(..75);
        assert!(two_footed_jumps(&clip(&hopping, [true; 2]), 0).is_empty());
    }
}
