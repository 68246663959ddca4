//! Two-footed jump out of standing: dip, push-off, flight, absorption and recovery.
//!
//! The body's posture comes from the model. The hips follow it while the feet bear, with the speed at take-off and landing that the flight
//! requires; in between they are on a parabola. Feet roll off over their toes and land on them, in their old place or the
//! requested one.

mod course;
mod tables;

use super::body::Body;
use course::Course;
use footfall_core::Pose;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{exp_map, log_map};
use footfall_ik::FootTarget;
use footfall_model::{JUMP_PHASES, JUMP_RESPONSES};
use glam::Vec3;
pub(super) use tables::JumpTables;

/// The phases of a model's jump.
const DIP: usize = 0;
const PUSH: usize = 1;
const FLIGHT: usize = 2;
const ABSORPTION: usize = 3;
const RECOVERY: usize = 4;

/// Part of the flight by which the feet leave their stance for the jump's posture, and part from which they approach the landing.
const FREED_BY: f32 = 0.5;
const REACHING_FROM: f32 = 0.45;

/// Request for a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Leap {
    /// Rise of the hips above their height before the jump, metres.
    pub(crate) rise_m: f32,
    /// Displacement of the feet to the left, up and ahead, metres.
    pub(crate) way: Vec3,
}

/// A phase of a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JumpPhase {
    /// The body goes down and pushes off; feet bear.
    Load,
    /// No foot bears.
    Flight,
    /// The legs take up the fall; feet bear.
    Landing,
}

/// A jump that is under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JumpMoment {
    pub(crate) leap: Leap,
    /// Time since it began, seconds.
    pub(crate) secs: f32,
    course: Course,
}

/// Progress of a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Flown {
    /// Displacement of the character to the left, up and ahead since the jump began, metres.
    pub(crate) place: Vec3,
    /// True when the feet bear.
    pub(crate) bears: bool,
}

/// Durations of a jump's phases, and the scale of its postures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Timing {
    /// Factors of the model's slopes.
    factors: [f32; JUMP_RESPONSES],
    /// Scale of the postures, smaller for jumps lower than recorded ones.
    scale: f32,
    secs: [f32; JUMP_PHASES],
}

impl JumpMoment {
    pub(super) fn new(tables: &JumpTables, leap: Leap, body: &Body) -> Self {
        Self {
            leap,
            secs: 0.0,
            course: Course::new(tables, leap, body),
        }
    }

    /// Returns the phase, and the part of it that has passed.
    fn passed(&self) -> (usize, f32) {
        let mut left = self.secs;
        for (phase, secs) in self.course.timing.secs.into_iter().enumerate() {
            if left < secs || phase + 1 == JUMP_PHASES {
                return (phase, (left / secs).min(1.0));
            }
            left -= secs;
        }
        (JUMP_PHASES - 1, 1.0)
    }

    pub(super) fn phase(&self) -> JumpPhase {
        match self.passed().0 {
            DIP | PUSH => JumpPhase::Load,
            FLIGHT => JumpPhase::Flight,
            _ => JumpPhase::Landing,
        }
    }

    /// Returns the displacement at the end, to the left, up and ahead.
    pub(super) fn way(&self) -> Vec3 {
        self.course.way()
    }

    pub(super) fn is_over(&self) -> bool {
        self.secs >= self.course.timing.secs.iter().sum()
    }

    /// Applies the jump to a standing pose that faces +Z. The pose is relative to the [displaced](Flown) character.
    pub(super) fn move_pose(&self, tables: &JumpTables, body: &Body, pose: &mut Pose) -> Flown {
        let (phase, s) = self.passed();
        let course = &self.course;
        let plants = body.plants(pose);
        let turned = |phase: usize, s: f32| {
            let beside = tables.beside(phase, s, &course.timing);
            let mut turned = pose.clone();
            Body::turn(&beside, &mut turned);
            turned.root_position += course.hips(phase, s, &beside);
            turned
        };
        let mut moved = turned(phase, s);
        let landing = course.way();
        let targets = match phase {
            DIP => body.on_toes(&plants, Vec3::ZERO, 0.0, &moved),
            PUSH => body.on_toes(&plants, Vec3::ZERO, smooth_step(s), &moved),
            FLIGHT => {
                let ends = [turned(PUSH, 1.0), turned(ABSORPTION, 0.0)];
                let places = [Vec3::ZERO, landing];
                let planted: [[FootTarget; 2]; 2] =
                    core::array::from_fn(|end| body.on_toes(&plants, places[end], 1.0, &ends[end]));
                let free = ends.each_ref().map(|pose| body.feet(pose));
                let now = body.feet(&moved);
                let mut targets = core::array::from_fn(|side| {
                    let ends = [0, 1].map(|end| (&planted[end][side], &free[end][side]));
                    in_flight(&now[side], ends, s)
                });
                body.within_reach(&moved, &mut targets);
                targets
            }
            ABSORPTION => body.on_toes(&plants, landing, 1.0 - smooth_step(s), &moved),
            _ => body.on_toes(&plants, landing, 0.0, &moved),
        };
        body.stand(&targets, &mut moved);
        let place = course.place(phase, s);
        moved.root_position -= place;
        *pose = moved;
        Flown {
            place,
            bears: phase != FLIGHT,
        }
    }
}

/// Returns a foot in flight: its place in the jump's posture, blended from its stance and to its landing. `ends` are the planted and the free
/// foot, at take-off and at landing.
fn in_flight(free: &FootTarget, ends: [(&FootTarget, &FootTarget); 2], s: f32) -> FootTarget {
    let shares = [
        1.0 - smooth_step(s / FREED_BY),
        smooth_step((s - REACHING_FROM) / (1.0 - REACHING_FROM)),
    ];
    let mut target = *free;
    let mut toes = Vec3::ZERO;
    for ((planted, free), share) in ends.into_iter().zip(shares) {
        target.ankle += share * (planted.ankle - free.ankle);
        let turn = log_map(planted.foot * free.foot.inverse());
        target.foot = exp_map(share * turn) * target.foot;
        toes += share * log_map(planted.foot.inverse() * planted.toes);
    }
    target.toes = target.foot * exp_map(toes);
    target
}

#[cfg(test)]
mod tests;
