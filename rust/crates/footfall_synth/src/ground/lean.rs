//! Lean: the body leans into turns, pelvis and trunk ahead of a gain of speed and against a loss of it, and the hips sink.
//!
//! A body in balance leans so far that gravity and acceleration together point along it: the tangent of the angle is the acceleration over g, which is
//! `v·ω` in a turn. Legs, pelvis, trunk and head lean into a turn as one, so that feet come down outside the hips. Against a change of speed pelvis and
//! trunk lean, and the neck takes part of it back.

use super::frame::PlantedFrame;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use super::planter_state::Lean;
use crate::gait::GRAVITY_MPS2;
use core::f32::consts::PI;
use footfall_core::Joint;
use footfall_core::ease::smooth_step;
use glam::{Quat, Vec2, Vec3};

/// Share of the angle of balance by which bodies lean into turns, and lean of the legs beside that of the pelvis.
///
/// Pelvis and chest of O3DE's actor, walking and running, lean by 6°, 10°, 14° and 18° where 8°, 14°, 19° and 23° would be balance. His feet are
/// 13, 20, 26 and 31 cm outside his hips then, with legs of 0.87 m.
const INTO_TURN: f32 = 0.72;
const LEGS: f32 = 1.3;

/// Share of the angle of balance by which pelvis and trunk lean against a change of speed, and the share of that which the neck takes back.
const AGAINST_CHANGE: f32 = 0.75;
const HEAD_KEPT: f32 = 0.5;

/// Time for leaning and returning, seconds; in shorter steps a walker leans less.
const UNHURRIED_SECS: f32 = 0.4;

/// Change of speed below which no trunk leans, m/s².
const UNNOTICED_MPS2: f32 = 0.3;

/// Largest lean into a turn, and of the trunk against a change of speed, radians.
const MOST_RAD: Vec2 = Vec2::new(0.33, 0.22);

/// Greatest acceleration of a lean into a turn, rad/s²: the hips move aside over their feet.
const TIPPING_RADPS2: f32 = 8.0;

/// Sinking of the hips, leg lengths per m/s², beyond the acceleration at which it begins, and over which it comes to that, m/s²; and the shares of sideways
/// and forward accelerations that count: legs that lean into a turn lower the hips already, and legs reach ahead or behind.
///
/// In turning runs of O3DE's actor hips are 4 cm lower than straight ahead at 2 to 3 m/s², and 5 to 7 at 3 to 4.
const SINKING: f32 = 0.028;
const FIRM_MPS2: f32 = 0.8;
const SOFT_MPS2: f32 = 0.4;
const SINKING_FOR: Vec2 = Vec2::new(0.5, 0.7);

/// Accelerations that the body leans against in a step: to the left and forwards, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pull {
    /// In the middle of the step, from the change of speed.
    pub(crate) within: Vec2,
    /// At the end of the step, from the continuing turn and from what is left of the change.
    pub(crate) after: Vec2,
}

/// Returns the lean against an acceleration to the left and forwards.
fn against(mps2: Vec2) -> Vec2 {
    let into_turn = INTO_TURN * (mps2.x / GRAVITY_MPS2).atan();
    let noticed = (mps2.y.abs() - UNNOTICED_MPS2).max(0.0);
    let change = AGAINST_CHANGE * (noticed / GRAVITY_MPS2).atan();
    Vec2::new(into_turn, change.copysign(mps2.y)).clamp(-MOST_RAD, MOST_RAD)
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
        let mut end = against(pull.after);
        let most = TIPPING_RADPS2 * secs * secs / 6.0;
        end.x = end.x.clamp(begin.angle.x - most, begin.angle.x + most);
        // Nobody bends to and fro in an instant.
        let unhurried = (secs / UNHURRIED_SECS).powi(2).min(1.0);
        Self {
            begin,
            end,
            middle: unhurried * against(pull.within) - Vec2::new(0.0, 0.5 * end.y),
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

    /// Leans the generated bodies of a step into its turn, about their hips. Feet stay level.
    pub(super) fn lean_over(&self, generated: &mut [GeneratedFrame]) {
        if self.is_none() {
            return;
        }
        let last = (generated.len() - 1) as f32;
        for (index, frame) in generated.iter_mut().enumerate() {
            let angle = self.at(index as f32 / last).angle;
            let [body, legs] = [1.0, LEGS].map(|share| Quat::from_rotation_z(-share * angle.x));
            let bowed = body * Quat::from_rotation_x(angle.y);
            frame.hips = bowed * frame.hips;
            for leg in &mut frame.legs {
                let reach = leg.ankle - leg.hip;
                leg.ankle = body * leg.hip + legs * reach;
                leg.hip = bowed * leg.hip;
            }
        }
    }

    /// Returns true when nothing leans in the step.
    fn is_none(&self) -> bool {
        self.begin == Lean::default() && [self.end, self.middle] == [Vec2::ZERO; 2]
    }
}

impl Lean {
    /// Returns the distance to the left by which the hips are beside the feet's path, in leg lengths.
    pub(super) fn aside(&self) -> f32 {
        (LEGS * self.angle.x).sin()
    }

    /// Returns the depth by which the hips sink, in leg lengths.
    pub(super) fn depth(&self) -> f32 {
        let balance = self.angle.abs() / Vec2::new(INTO_TURN, AGAINST_CHANGE);
        let [turn, change] = [balance.x, balance.y].map(|balance| GRAVITY_MPS2 * balance.tan());
        let pull = (SINKING_FOR * Vec2::new(turn, change + UNNOTICED_MPS2)).length();
        let beyond = (pull - FIRM_MPS2).max(0.0);
        SINKING * beyond * beyond / (beyond + SOFT_MPS2)
    }
}

impl Planter {
    /// Leans the generated bodies of a step over their feet.
    pub(crate) fn lean_over(&mut self, bend: &Bend, generated: &mut [GeneratedFrame]) {
        bend.lean_over(generated);
        self.state.lean = bend.at(1.0);
    }

    /// Raises the heads of a step's frames, and lowers their hips. The legs have to be solved then.
    pub(crate) fn sink(&self, bend: &Bend, out: &mut [PlantedFrame]) {
        if bend.is_none() {
            return;
        }
        let last = (out.len() - 1) as f32;
        let leg_length = 0.5 * (self.leg_lengths[0] + self.leg_lengths[1]);
        for (index, frame) in out.iter_mut().enumerate() {
            let lean = bend.at(index as f32 / last);
            raise_head(frame, lean.angle.y);
            frame.pose.root_position.y -= leg_length * lean.depth();
        }
    }
}

/// Turns the neck back by part of a trunk's lean forwards.
fn raise_head(frame: &mut PlantedFrame, angle: f32) {
    let pose = &mut frame.pose;
    let trunk = [Joint::Hips, Joint::Spine, Joint::Chest, Joint::UpperChest];
    let trunk = trunk.iter().fold(frame.level.conjugate(), |parent, joint| {
        parent * pose.rotation(*joint)
    });
    let neck = &mut pose.rotations[Joint::Neck.index()];
    // Twice the tangent of half of so small an angle is the angle.
    let half = trunk.conjugate() * (-0.5 * HEAD_KEPT * angle * Vec3::X);
    *neck = (Quat::from_xyzw(half.x, half.y, half.z, 1.0) * *neck).normalize();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::generated::Stride;
    use footfall_core::lanes::f32x8;
    use footfall_core::{Side, Skeleton};

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
        // The angle of balance's tangent is 2.5 over 9.81.
        assert!((bend.at(1.0).angle.x - 0.72 * 0.2495).abs() < 0.002);
        for s in [0.2, 0.5, 0.8] {
            let step = 1e-3;
            let slope = (bend.at(s + step).angle - bend.at(s - step).angle) / (2.0 * step * 0.5);
            assert!(slope.distance(bend.at(s).rate) < 0.01, "at {s}");
        }
    }

    #[test]
    fn hips_sink_by_what_a_body_pushes_against() {
        let depth = |after: Vec2| {
            let pull = Pull {
                within: Vec2::ZERO,
                after,
            };
            Bend::new(Lean::default(), &pull, 0.8).at(1.0).depth()
        };
        let turn = |mps2: f32| depth(Vec2::new(mps2, 0.0));
        assert!(turn(1.5) == 0.0 && turn(2.5) < 0.008, "{}", turn(2.5));
        assert!((turn(4.0) - 0.025).abs() < 0.003, "{}", turn(4.0));
        assert!((turn(-3.0) - turn(3.0)).abs() < 1e-6);
        let change = |mps2: f32| depth(Vec2::new(0.0, mps2));
        assert!(change(1.0) == 0.0, "{}", change(1.0));
        assert!((change(2.5) - 0.019).abs() < 0.002, "{}", change(2.5));
        assert!(change(20.0) < 0.04, "{}", change(20.0));
        assert!((change(-3.0) - change(3.0)).abs() < 1e-6);
    }

    #[test]
    fn bodies_lean_over_their_feet() {
        let skeleton = Skeleton::standard();
        let lean_over = |x: f32, y: f32, frames: &mut [GeneratedFrame]| {
            let begin = Lean {
                angle: Vec2::new(x, y),
                rate: Vec2::ZERO,
            };
            Bend::new(begin, &Pull::default(), 0.5).lean_over(frames);
        };
        let poses = [PlantedFrame::default(), PlantedFrame::default()];
        let mut frames = [GeneratedFrame::default(), GeneratedFrame::default()];
        let stride = Stride {
            scale: f32x8::ONE,
            upright: f32x8::ONE,
            tall: f32x8::ONE,
        };
        GeneratedFrame::fill(&mut frames, &poses, &skeleton, |_| stride);
        let upright = frames.clone();
        lean_over(0.2, 0.0, &mut frames);
        let up = frames[0].hips * Vec3::Y;
        assert!((up.x - 0.2_f32.sin()).abs() < 1e-4 && up.z.abs() < 1e-6);
        for side in Side::BOTH {
            let [before, after] = [&upright, &frames].map(|frames| frames[0].legs[side.index()]);
            let [reached, reaches] = [before, after].map(|leg| leg.ankle - leg.hip);
            assert!((reached.length() - reaches.length()).abs() < 1e-5);
            let aside = LEGS * 0.2;
            assert!((reached.angle_between(reaches) - aside).abs() < 0.01 && reaches.x < reached.x);
            assert_eq!(before.foot, after.foot);
        }
        let mut bowed = upright.clone();
        lean_over(0.0, 0.2, &mut bowed);
        let up = bowed[0].hips * Vec3::Y;
        assert!(up.x.abs() < 1e-6 && (up.z - 0.2_f32.sin()).abs() < 1e-4);
        for side in Side::BOTH {
            let ankle = |frames: &[GeneratedFrame]| frames[0].legs[side.index()].ankle;
            assert!(ankle(&upright).distance(ankle(&bowed)) < 1e-6);
        }
    }

    #[test]
    fn heads_are_raised_whatever_way_they_face() {
        for heading in [0.0, 2.0] {
            let facing = Quat::from_rotation_y(heading);
            let mut frame = PlantedFrame {
                level: facing,
                ..PlantedFrame::default()
            };
            let bowed = Quat::from_rotation_x(0.2);
            frame.pose.rotations[Joint::Hips.index()] = facing * bowed;
            raise_head(&mut frame, 0.2);
            let up = bowed * (frame.pose.rotation(Joint::Neck) * Vec3::Y);
            assert!(up.x.abs() < 1e-4 && (up.z - 0.1).abs() < 0.01, "{up}");
        }
    }
}
