//! Climbs: the trunk leans forward uphill and back downhill.

use crate::ground::HEAD_KEPT;
use footfall_core::ease::settled;
use footfall_core::{Joint, Pose};
use glam::Quat;

/// Lean of the trunk uphill and downhill as a share of the slope's angle; the neck takes part of it back, for people keep their eyes level.
const UPHILL: f32 = 0.2;
const DOWNHILL: f32 = 0.1;

/// Steepest grade that has an effect, rise over run.
const STEEPEST: f32 = 1.0;

/// Rate of the critically damped spring by which the trunk follows, 1/s.
const RATE: f32 = 4.0;

/// Lean that counts as none, radians and rad/s.
const LEAST: f32 = 1e-4;

/// A trunk on a slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ClimbMoment {
    /// Grade of the way, rise over run, positive uphill.
    pub(crate) grade: f32,
    /// Forward lean of the trunk, radians, and its rate of change.
    pub(crate) lean: f32,
    pub(crate) speed: f32,
}

impl ClimbMoment {
    /// Sets the grade of the way; 0 if it is not finite.
    pub(super) fn go_on(&mut self, grade: f32) {
        self.grade = if grade.is_finite() {
            grade.clamp(-STEEPEST, STEEPEST)
        } else {
            0.0
        };
    }

    pub(super) fn step(&mut self, secs: f32) {
        if *self == Self::default() {
            return;
        }
        let share = if self.grade > 0.0 { UPHILL } else { DOWNHILL };
        let wanted = share * self.grade.atan();
        let (away, speed) = settled(self.lean - wanted, self.speed, RATE, secs);
        *self = Self {
            lean: wanted + away,
            speed,
            ..*self
        };
        if wanted == 0.0 && self.lean.abs() < LEAST && self.speed.abs() < LEAST {
            (self.lean, self.speed) = (0.0, 0.0);
        }
    }

    /// Bends the trunk of a pose that faces +Z.
    pub(super) fn bend(&self, pose: &mut Pose) {
        if self.lean == 0.0 {
            return;
        }
        for (joint, angle) in [
            (Joint::Spine, self.lean),
            (Joint::Neck, -HEAD_KEPT * self.lean),
        ] {
            let rotation = &mut pose.rotations[joint.index()];
            *rotation = (Quat::from_rotation_x(angle) * *rotation).normalize();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{ModelPose, Skeleton, forward_kinematics};

    #[test]
    fn trunks_lean_into_the_way_up_and_come_back_to_upright() {
        let skeleton = Skeleton::standard();
        let ahead = |moment: &ClimbMoment| {
            let mut pose = Pose::rest(&skeleton);
            moment.bend(&mut pose);
            let mut model = ModelPose::default();
            forward_kinematics(&skeleton, &pose, &mut model);
            let up = model.rotation(Joint::UpperChest) * glam::Vec3::Y;
            up.z.asin()
        };
        let mut moment = ClimbMoment::default();
        for (grade, least, most) in [(0.6, 0.1, 0.115), (-0.6, -0.06, -0.05), (0.0, -1e-6, 1e-6)] {
            moment.go_on(grade);
            let mut before = moment.speed;
            for _ in 0..240 {
                moment.step(1.0 / 60.0);
                assert!((moment.speed - before).abs() * 60.0 < 4.0);
                before = moment.speed;
            }
            assert!(
                (least..most).contains(&ahead(&moment)),
                "{}",
                ahead(&moment)
            );
        }
        assert_eq!(moment, ClimbMoment::default());
        moment.go_on(f32::NAN);
        assert_eq!(moment, ClimbMoment::default());
    }

    #[test]
    fn a_lean_is_the_same_however_time_is_cut() {
        let mut whole = ClimbMoment::default();
        whole.go_on(0.5);
        let mut halves = whole;
        whole.step(0.4);
        halves.step(0.2);
        halves.step(0.2);
        assert!((whole.lean - halves.lean).abs() < 1e-6);
    }
}
