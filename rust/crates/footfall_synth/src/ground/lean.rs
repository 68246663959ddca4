//! Lean: the body leans into turns, ahead of a gain of speed and against a loss of it, and the hips sink in turns.
//!
//! A body in balance leans so far that gravity and acceleration together point along it: the tangent of the angle is the acceleration over g, which is
//! `v·ω` in a turn. Legs, pelvis, trunk and head lean into a turn as one, so that feet come down outside the hips. Against a change of speed pelvis and
//! trunk lean, and the neck takes part of it back. The foot of the next landing comes down less far ahead of hips that gain speed, and farther ahead of those that
//! lose it; its leg keeps that lean while it stands, so that the hips travel as asked.

use super::frame::PlantedFrame;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use super::planter_state::Lean;
use crate::gait::GRAVITY_MPS2;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Side};
use glam::{Quat, Vec2, Vec3};

/// Share of the angle of balance by which bodies lean into turns, and lean of the legs beside that of the pelvis.
///
/// Pelvis and chest of O3DE's actor, walking and running, lean by 6°, 10°, 14° and 18° where 8°, 14°, 19° and 23° would be balance. His feet are
/// 13, 20, 26 and 31 cm outside his hips then, with legs of 0.87 m.
const INTO_TURN: f32 = 0.72;
const LEGS: f32 = 1.3;

/// Share of the angle of balance by which pelvis and trunk lean against a change of speed, and the share of a trunk's lean that the neck takes back.
const AGAINST_CHANGE: f32 = 0.75;
pub(crate) const HEAD_KEPT: f32 = 0.5;

/// Lean of a landing leg for a loss of speed and for a gain, per lean of the pelvis beyond that from which it sets in; that; and the largest lean of the leg in an
/// unhurried step and in a quick one, whose foot reaches farther ahead to land at the same place, radians.
///
/// Feet of O3DE's actor, running, land 0.40 m ahead of his hips where he loses 4.5 m/s², 0.26 where he loses 3, 0.10 in an even run, and 0.13 behind where he gains 3.
/// Walking they land as in an even walk while he gains or loses 2 m/s².
const LANDING: [f32; 2] = [3.3, 1.5];
const FIRM_RAD: f32 = 0.05;
const MOST_LANDING_RAD: [f32; 2] = [0.3, 0.4];

/// Share of its length that a leg reaches for its lean backwards, against a loss of speed, and forwards; beyond, the hips sink.
const STRETCHED: [f32; 2] = [0.97, 0.99];

/// Time for leaning and returning, seconds; in shorter steps a walker leans less.
const UNHURRIED_SECS: f32 = 0.4;

/// Change of speed below which no trunk leans, m/s².
const UNNOTICED_MPS2: f32 = 0.3;

/// Largest lean into a turn, and against a change of speed, radians.
const MOST_RAD: Vec2 = Vec2::new(0.33, 0.22);

/// Largest lean of the trunk ahead of a gain of speed, radians; legs land as for the whole of it.
///
/// Walkers here gain speed twice as fast as people set out, whose trunks lean by 4 to 6° more than standing, those of runners by 10 to 14° (O3DE's actor, CMU).
const MOST_AHEAD_RAD: f32 = 0.12;

/// Greatest acceleration of a lean into a turn, rad/s²: the hips move aside over their feet.
const TIPPING_RADPS2: f32 = 8.0;

/// Sinking of the hips in a turn, leg lengths per m/s², beyond the acceleration at which it begins, and over which it comes to that, m/s²; legs that lean lower
/// the hips already.
///
/// In turning runs of O3DE's actor hips are 4 cm lower than straight ahead at 2 to 3 m/s², and 5 to 7 at 3 to 4.
const SINKING: f32 = 0.016;
const FIRM_MPS2: f32 = 1.6;
const SOFT_MPS2: f32 = 0.8;

/// Accelerations that the body leans against in a step: to the left and forwards, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pull {
    /// In the middle of the step, from the change of speed.
    pub(crate) within: Vec2,
    /// At the end of the step, from the continuing turn and from what is left of the change.
    pub(crate) after: Vec2,
    /// True at the beginning and at the end of the step where the walker is at rest.
    pub(crate) rests: [bool; 2],
}

/// Returns the lean against an acceleration to the left and forwards.
fn against(mps2: Vec2) -> Vec2 {
    let into_turn = INTO_TURN * (mps2.x / GRAVITY_MPS2).atan();
    let noticed = (mps2.y.abs() - UNNOTICED_MPS2).max(0.0);
    let change = AGAINST_CHANGE * (noticed / GRAVITY_MPS2).atan();
    Vec2::new(into_turn, change.copysign(mps2.y)).clamp(-MOST_RAD, MOST_RAD)
}

/// Returns the lean of a landing leg in a step at whose end pelvis and trunk lean forwards by so much, and which lasts this share of an unhurried one.
fn landing(forwards: f32, unhurried: f32) -> f32 {
    let [loss, gain] = LANDING;
    let [most, most_quick] = MOST_LANDING_RAD;
    let beyond = (forwards.abs() - FIRM_RAD).max(0.0);
    if forwards < 0.0 {
        -((loss * beyond).min(most) / unhurried).min(most_quick)
    } else {
        unhurried.powi(2) * (gain * beyond).min(most)
    }
}

/// Course of the lean in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    begin: Lean,
    /// Angles at the end, and their increase in the middle.
    end: Vec2,
    middle: Vec2,
    /// Lean of the leg that lands, forwards.
    landing: f32,
    secs: f32,
    rests: [bool; 2],
}

impl Bend {
    pub(crate) fn new(begin: Lean, pull: &Pull, secs: f32) -> Self {
        let [mut within, mut end] = [pull.within, pull.after].map(against);
        let most = TIPPING_RADPS2 * secs * secs / 6.0;
        end.x = end.x.clamp(begin.angle.x - most, begin.angle.x + most);
        // Nobody bends to and fro in an instant.
        let unhurried = (secs / UNHURRIED_SECS).min(1.0);
        let landing = if pull.rests[1] {
            0.0
        } else {
            landing(end.y, unhurried)
        };
        for lean in [&mut within, &mut end] {
            lean.y = lean.y.min(MOST_AHEAD_RAD);
        }
        Self {
            begin,
            end,
            middle: unhurried.powi(2) * within - Vec2::new(0.0, 0.5 * end.y),
            landing,
            secs,
            rests: pull.rests,
        }
    }

    /// Returns the lean at part `s` of the step, with the leg that stands in it. It begins with the angle and the rate at the end of the previous step, and ends
    /// at rest.
    pub(crate) fn at(&self, s: f32) -> Lean {
        let Self {
            begin,
            end,
            middle,
            secs,
            ..
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
            leg: begin.leg + smooth_step(s) * (self.leg_end() - begin.leg),
        }
    }

    /// Returns the lean of the standing leg as the step ends: that with which it landed, so that the hips go as far as asked. Who sets out leans over the
    /// standing foot, and who comes to rest brings the hips over it.
    fn leg_end(&self) -> f32 {
        if self.rests == [false; 2] {
            self.begin.leg
        } else {
            self.landing
        }
    }

    /// Returns the lean with which the next step begins: its standing leg is the one that lands.
    fn next(&self) -> Lean {
        Lean {
            leg: self.landing,
            ..self.at(1.0)
        }
    }

    /// Leans the generated bodies of a step about their hips; `leading` stands. Feet stay level.
    pub(super) fn lean_over(
        &self,
        generated: &mut [GeneratedFrame],
        leading: Side,
        leg_lengths: [f32; 2],
    ) {
        if self.is_none() {
            return;
        }
        let last = (generated.len() - 1) as f32;
        for (index, frame) in generated.iter_mut().enumerate() {
            let s = index as f32 / last;
            let Lean { angle, leg, .. } = self.at(s);
            let [body, legs] = [1.0, LEGS].map(|share| Quat::from_rotation_z(-share * angle.x));
            let bowed = body * Quat::from_rotation_x(angle.y);
            frame.hips = bowed * frame.hips;
            let swinging = self.begin.leg + smooth_step(s) * (self.landing - self.begin.leg);
            for side in Side::BOTH {
                let forwards = if side == leading { leg } else { swinging };
                let leg = &mut frame.legs[side.index()];
                let reach = slanted(leg.ankle - leg.hip, forwards, leg_lengths[side.index()]);
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

    /// Returns the depth by which the hips sink in a turn, in leg lengths.
    pub(super) fn depth(&self) -> f32 {
        let pull = GRAVITY_MPS2 * (self.angle.x.abs() / INTO_TURN).tan();
        let beyond = (pull - FIRM_MPS2).max(0.0);
        SINKING * beyond * beyond / (beyond + SOFT_MPS2)
    }
}

impl Planter {
    /// Leans the generated bodies of a step over their feet.
    pub(crate) fn lean_over(
        &mut self,
        bend: &Bend,
        leading: Side,
        generated: &mut [GeneratedFrame],
    ) {
        bend.lean_over(generated, leading, self.leg_lengths);
        self.state.lean = bend.next();
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

/// Returns the reach of a leg of this length that leans forwards: its foot is farther behind the hips, at the same height where the leg is long enough.
fn slanted(mut reach: Vec3, forwards: f32, leg_length: f32) -> Vec3 {
    if forwards == 0.0 {
        return reach;
    }
    let length = reach.length();
    reach.z -= length * forwards.sin();
    let growth = reach.length() - length;
    if growth <= 0.0 {
        return reach;
    }
    // The straighter the leg, the less it stretches.
    let stretched = STRETCHED[usize::from(forwards > 0.0)];
    let room = (stretched * leg_length - length).max(0.0);
    reach.normalize() * (length + growth * room / (room + growth))
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
mod tests;
