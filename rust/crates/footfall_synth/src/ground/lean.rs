//! Lean: the trunk bends into turns, ahead of a gain of speed and against a loss of it, and the hips sink.
//!
//! A body in balance leans so far that gravity and acceleration together point along it: the tangent of the angle is the acceleration over g, which is
//! `v·ω` in a turn. The trunk leans by a [`SHARE`] of it, and the head by half of that, because people keep their eyes level. Feet are placed as straight ahead, so that legs do not.
//! Legs that push the body aside or stop it are bent and aslant: the harder they do, the lower are the hips.

use super::frame::PlantedFrame;
use super::planter::Planter;
use super::planter_state::Lean;
use crate::gait::GRAVITY_MPS2;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Pose};
use glam::{Quat, Vec2, Vec3};

/// Share of the angle of balance by which the trunk leans beyond the legs, and the share of that which the neck takes back.
const SHARE: f32 = 0.5;
const HEAD_KEPT: f32 = 0.5;

/// Time for leaning and returning, seconds; in shorter steps a walker leans less.
const UNHURRIED_SECS: f32 = 0.4;

/// Acceleration below which nobody leans, m/s².
const UNNOTICED_MPS2: f32 = 0.3;

/// Largest lean of the trunk, radians.
const MOST_RAD: f32 = 0.22;

/// Sinking of the hips by a sideways acceleration, leg lengths per m/s², beyond the acceleration at which it begins, and over which it comes to that,
/// m/s²; and the share of a forward acceleration that counts, for which legs reach ahead or behind.
///
/// In turning runs of O3DE's actor, low-passed, hips are 2.4 cm lower than straight ahead at 1 to 2 m/s², 5.2 at 2 to 3, 7.4 at 3 to 4, and 10.3 at 4 to 5,
/// with legs of 0.87 m.
const SINKING: f32 = 0.028;
const FIRM_MPS2: f32 = 0.8;
const SOFT_MPS2: f32 = 0.4;
const FORWARD: f32 = 0.5;

/// Accelerations that the trunk leans against in a step: to the left and forwards, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pull {
    /// In the middle of the step, from the change of speed.
    pub(crate) within: Vec2,
    /// At the end of the step, from the continuing turn.
    pub(crate) after: Vec2,
}

/// Course of the lean in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    begin: Lean,
    /// Angles at the end, and their increase in the middle.
    end: Vec2,
    middle: Vec2,
    secs: f32,
}

impl Bend {
    pub(crate) fn new(begin: Lean, pull: &Pull, secs: f32) -> Self {
        let angle = |pull: Vec2| {
            let balance = ((pull.length() - UNNOTICED_MPS2).max(0.0) / GRAVITY_MPS2).atan();
            (SHARE * balance).min(MOST_RAD) * pull.normalize_or_zero()
        };
        Self {
            begin,
            end: angle(pull.after),
            // Nobody bends to and fro in an instant.
            middle: (secs / UNHURRIED_SECS).powi(2).min(1.0) * angle(pull.within),
            secs,
        }
    }

    /// Returns the lean at part `s` of the step. It begins with the angle and the rate at the end of the previous step, and ends at rest.
    pub(crate) fn at(&self, s: f32) -> Lean {
        let Self {
            begin,
            end,
            middle,
            secs,
        } = *self;
        let left = 1.0 - s;
        let (hump, slope) = if middle == Vec2::ZERO {
            (0.0, 0.0)
        } else {
            ((PI * s).sin().powi(2), PI * (2.0 * PI * s).sin())
        };
        let angle = begin.angle
            + smooth_step(s) * (end - begin.angle)
            + hump * middle
            + begin.rate * (secs * s * left * left);
        let rate = 6.0 * s * left * (end - begin.angle)
            + slope * middle
            + begin.rate * (secs * left * (1.0 - 3.0 * s));
        Lean {
            angle,
            rate: rate / secs,
        }
    }

    /// Returns true when the trunk does not lean in the step.
    fn is_none(&self) -> bool {
        self.begin == Lean::default() && [self.end, self.middle] == [Vec2::ZERO; 2]
    }
}

impl Lean {
    /// Returns the depth by which the hips sink, in leg lengths.
    pub(super) fn depth(&self) -> f32 {
        let balance = (self.angle * Vec2::new(1.0, FORWARD)).length() / SHARE;
        let pull = GRAVITY_MPS2 * balance.tan() + UNNOTICED_MPS2;
        let beyond = (pull - FIRM_MPS2).max(0.0);
        SINKING * beyond * beyond / (beyond + SOFT_MPS2)
    }
}

impl Planter {
    /// Bends the trunks of a step's frames, and lowers their hips. The legs have to be solved then.
    pub(crate) fn lean(&mut self, pull: &Pull, out: &mut [PlantedFrame]) {
        let last = (out.len() - 1) as f32;
        let bend = Bend::new(self.state.lean, pull, last * self.frame_secs);
        self.state.lean = bend.at(1.0);
        if bend.is_none() {
            return;
        }
        let leg_length = 0.5 * (self.leg_lengths[0] + self.leg_lengths[1]);
        for (index, frame) in out.iter_mut().enumerate() {
            let lean = bend.at(index as f32 / last);
            bend_trunk(frame, lean.angle);
            frame.pose.root_position.y -= leg_length * lean.depth();
        }
    }
}

/// Bends the spine to the left and forwards, and the neck part of the way back.
fn bend_trunk(frame: &mut PlantedFrame, angle: Vec2) {
    let pose = &mut frame.pose;
    let hips = frame.plan_from_ground.conjugate() * pose.rotation(Joint::Hips);
    let axis = Vec3::new(angle.y, 0.0, -angle.x);
    let bend = |pose: &mut Pose, joint: Joint, parent: Quat, axis: Vec3| {
        let rotation = &mut pose.rotations[joint.index()];
        // Twice the tangent of half of so small an angle is the angle.
        let half = 0.5 * (parent.conjugate() * axis);
        *rotation = (Quat::from_xyzw(half.x, half.y, half.z, 1.0) * *rotation).normalize();
    };
    bend(pose, Joint::Spine, hips, axis);
    let trunk = [Joint::Spine, Joint::Chest, Joint::UpperChest];
    let trunk = trunk
        .iter()
        .fold(hips, |parent, joint| parent * pose.rotation(*joint));
    bend(pose, Joint::Neck, trunk, -HEAD_KEPT * axis);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lean_goes_on_from_step_to_step() {
        let into_turn = Pull {
            within: Vec2::new(0.0, 3.0),
            after: Vec2::new(2.5, 0.0),
        };
        let begin = Lean {
            angle: Vec2::new(0.05, -0.02),
            rate: Vec2::new(0.3, 0.1),
        };
        let bend = Bend::new(begin, &into_turn, 0.5);
        assert!(bend.at(0.0).angle.distance(begin.angle) < 1e-6);
        assert!(bend.at(0.0).rate.distance(begin.rate) < 1e-5);
        assert!(bend.at(1.0).rate.length() < 1e-4);
        // Half of the angle whose tangent is 2.2 over 9.81.
        assert!((bend.at(1.0).angle.x - 0.11).abs() < 0.002);
        for s in [0.2, 0.5, 0.8] {
            let step = 1e-3;
            let slope = (bend.at(s + step).angle - bend.at(s - step).angle) / (2.0 * step * 0.5);
            assert!(slope.distance(bend.at(s).rate) < 0.01, "at {s}");
        }
    }

    #[test]
    fn hips_sink_by_what_a_body_pushes_against() {
        let turn = |mps2: f32| {
            let pull = Pull {
                within: Vec2::ZERO,
                after: Vec2::new(mps2, 0.0),
            };
            Bend::new(Lean::default(), &pull, 0.5).at(1.0).depth()
        };
        assert!(turn(0.5) == 0.0 && turn(1.0) < 0.005, "{}", turn(1.0));
        assert!((turn(3.5) - 0.065).abs() < 0.005, "{}", turn(3.5));
        assert!(turn(20.0) < 0.12, "{}", turn(20.0));
        assert!((turn(-3.0) - turn(3.0)).abs() < 1e-6);
    }

    #[test]
    fn trunks_bend_to_the_left_and_forwards_whatever_way_they_face() {
        for heading in [0.0, 2.0] {
            let facing = Quat::from_rotation_y(heading);
            let mut frame = PlantedFrame {
                plan_from_ground: facing,
                ..PlantedFrame::default()
            };
            frame.pose.rotations[Joint::Hips.index()] = facing;
            bend_trunk(&mut frame, Vec2::new(0.1, 0.2));
            let spine = facing * frame.pose.rotation(Joint::Spine);
            let up = facing.conjugate() * (spine * Vec3::Y);
            assert!(
                (up.x - 0.1).abs() < 0.01 && (up.z - 0.2).abs() < 0.01,
                "{up}"
            );
            assert_eq!(frame.pose.rotation(Joint::LeftUpperLeg), Quat::IDENTITY);
        }
    }
}
