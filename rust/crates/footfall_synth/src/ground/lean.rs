//! Lean: the trunk bends into turns, ahead of a gain of speed and against a loss of it.
//!
//! A body in balance leans so far that gravity and acceleration together point along it: the tangent of the angle is the acceleration over g, which is
//! `v·ω` in a turn. The legs lean by the places of the feet; here the trunk adds its [`SHARE`], and the head half of that, because people keep their eyes level.

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

impl Planter {
    /// Bends the trunks of a step's frames.
    pub(crate) fn lean(&mut self, pull: &Pull, out: &mut [PlantedFrame]) {
        let last = (out.len() - 1) as f32;
        let bend = Bend::new(self.state.lean, pull, last * self.frame_secs);
        self.state.lean = bend.at(1.0);
        if bend.is_none() {
            return;
        }
        for (index, frame) in out.iter_mut().enumerate() {
            bend_trunk(frame, bend.at(index as f32 / last).angle);
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
