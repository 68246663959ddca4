//! Fastest turn of joints: whatever a sensor says, no joint is thrown.
//!
//! Feet that are put down late or let go, and courses that part, are caught up with within a frame; a frame is too short for a leg. What is left to turn is turned in the
//! next ones.

use footfall_core::rotation::from_heading;
use footfall_core::{JOINT_COUNT, Joint, Pose, Side};
use glam::Quat;

/// No joint turns faster, rad/s: knees of people who run reach 15, those of sprinters 20.
pub(super) const MOST_RADPS: f32 = 20.0;

/// Joints as they were shown last; those of the hips against the body's heading.
#[derive(Clone, Debug)]
pub(super) struct Limit {
    shown: Option<[Quat; JOINT_COUNT]>,
}

impl Limit {
    pub(super) const NEW: Self = Self { shown: None };

    /// Holds the joints of a pose, whose body has this heading, back to what is possible in a time.
    pub(super) fn hold(&mut self, heading: f32, dt_secs: f32, pose: &mut Pose) {
        let level = from_heading(heading);
        pose.rotations[0] = level.inverse() * pose.rotations[0];
        if let Some(shown) = &self.shown {
            let most = MOST_RADPS * dt_secs;
            for side in Side::BOTH {
                // One share for a leg: its foot goes straight where it was to go.
                let leg = [side.upper_leg(), side.lower_leg(), side.foot()];
                hold(shown, &leg, most, pose);
            }
            for joint in Joint::ALL {
                hold(shown, &[joint], most, pose);
            }
        }
        self.shown = Some(pose.rotations);
        pose.rotations[0] = level * pose.rotations[0];
    }
}

/// Scales the rotations of all joints by one factor, so that the fastest turns by at most this angle, radians.
fn hold(shown: &[Quat; JOINT_COUNT], joints: &[Joint], most: f32, pose: &mut Pose) {
    let angles = joints.iter().map(|joint| {
        let n = joint.index();
        shown[n].angle_between(pose.rotations[n])
    });
    let fastest = angles.fold(0.0, f32::max);
    if fastest > most {
        for joint in joints {
            let n = joint.index();
            pose.rotations[n] = shown[n].slerp(pose.rotations[n], most / fastest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use glam::Vec3;

    #[test]
    fn a_leg_that_is_thrown_gets_there_as_a_whole_and_slow_joints_are_left_alone() {
        let dt_secs = 0.01;
        let mut limit = Limit::NEW;
        let mut pose = Pose::default();
        limit.hold(0.3, dt_secs, &mut pose);
        let side = Side::Left;
        let mut wanted = Pose::default();
        let mut turn = |joint: Joint, angle: f32| {
            wanted.rotations[joint.index()] = exp_map(Vec3::X * angle);
        };
        turn(side.lower_leg(), 1.0);
        turn(side.upper_leg(), -0.5);
        turn(side.toes(), 0.4);
        turn(Joint::Head, 0.1);
        let mut steps = 0;
        loop {
            let before = pose.clone();
            pose = wanted.clone();
            limit.hold(0.3, dt_secs, &mut pose);
            let angle = |joint: Joint| before.rotation(joint).angle_between(pose.rotation(joint));
            for joint in Joint::ALL {
                assert!(
                    angle(joint) < 1.01 * MOST_RADPS * dt_secs,
                    "{}",
                    joint.name()
                );
            }
            if steps == 0 {
                assert!((angle(Joint::Head) - 0.1).abs() < 1e-3);
                assert!((angle(side.upper_leg()) - 0.1).abs() < 1e-3);
                assert!((angle(side.lower_leg()) - 0.2).abs() < 1e-3);
            }
            if pose == wanted || steps > 9 {
                break;
            }
            steps += 1;
        }
        assert!((4..=6).contains(&steps), "{steps}");
    }

    #[test]
    fn turning_the_character_is_no_turn_of_its_joints() {
        let mut limit = Limit::NEW;
        let facing = |heading: f32| {
            let mut pose = Pose::default();
            pose.rotations[0] = from_heading(heading);
            pose
        };
        limit.hold(0.0, 0.01, &mut facing(0.0));
        let mut pose = facing(2.0);
        limit.hold(2.0, 0.01, &mut pose);
        assert!(pose.rotations[0].angle_between(from_heading(2.0)) < 0.01);
    }
}
