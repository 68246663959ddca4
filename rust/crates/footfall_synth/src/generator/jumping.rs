//! Jumps of a walker, from request to landing; and pushes.
//!
//! A standing walker jumps off both feet ([`moves`](crate::moves)). One that walks or runs forwards leaps: the next step is a step of the run whose flight lasts as
//! long as the rise takes ([`StepPlan::leap`](crate::plan::StepPlan::leap)). One that goes sideways, backwards or very slowly stops first.

use super::GaitGenerator;
use crate::controls::{Controls, FASTEST_RUN_MPS};
use crate::footstep::Footstep;
use crate::gait::WIDEST_RUN_RAD;
use crate::moves::{JumpPhase, Leap, Moves};
use crate::source::Steps;
use footfall_core::Side;
use footfall_core::rotation::from_heading;
use glam::{Vec2, Vec3};

/// Speed below which a walker does not leap, m/s.
const LEAST_LEAP_MPS: f32 = 0.8;

/// Rise of a jump to a place at the height of its beginning: metres, and share of the distance; and the height of the hips above the place.
const RISE_TO_PLACE_M: f32 = 0.2;
const RISE_BY_DISTANCE: f32 = 0.08;
const RISE_ABOVE_PLACE_M: f32 = 0.25;

/// Smallest rise of a jump, metres.
const LEAST_RISE_M: f32 = 0.01;

impl GaitGenerator {
    /// Requests one jump in which the hips rise by this height above their current one, standing, walking or running, metres; 0.1 to 0.5 is typical of adults. It begins as soon as
    /// the feet allow: at once for a standing walker, with the next step for one that walks or runs forwards faster than 0.8 m/s (a leap off one foot onto the other),
    /// and after a stop for all others. Further requests while a jump is pending or under way have no effect.
    ///
    /// Returns true if there will be a jump: not with a model without jumps, nor for a rise that is not finite or too small.
    pub fn jump(&mut self, rise_m: f32) -> bool {
        self.request_jump(Leap {
            rise_m,
            way: Vec3::ZERO,
        })
    }

    /// Requests one two-footed jump that lands at a place relative to the standing character: metres to the left, up and ahead. A moving walker
    /// stops first. A place beyond the reach of people (about twice the leg length ahead, two thirds of it to the side or
    /// back) is not reached: the jump goes as far as it can in that direction.
    ///
    /// Returns true if there will be a jump, as [`jump`](Self::jump) does.
    pub fn jump_to(&mut self, place: Vec3) -> bool {
        let level = RISE_TO_PLACE_M + RISE_BY_DISTANCE * place.with_y(0.0).length();
        self.request_jump(Leap {
            rise_m: level.max(place.y + RISE_ABOVE_PLACE_M),
            way: place,
        })
    }

    /// Requests this jump, as [`jump`](Self::jump) does.
    pub(crate) fn request_jump(&mut self, leap: Leap) -> bool {
        let possible = self.moves.as_ref().is_some_and(Moves::can_jump);
        let sensible = leap.way.is_finite() && leap.rise_m.is_finite();
        if !possible || !sensible || leap.rise_m < LEAST_RISE_M {
            return false;
        }
        if self.pending_jump.is_none() && self.jump_phase().is_none() {
            self.pending_jump = Some(leap);
        }
        true
    }

    /// Returns the phase of the current jump; `None` while it is pending.
    pub fn jump_phase(&self) -> Option<JumpPhase> {
        let both = self.moves.as_ref().and_then(Moves::phase);
        both.or_else(|| self.leap_phase())
    }

    /// Returns the phase of a leap. Its landing is the beginning of the next step, an ordinary one.
    fn leap_phase(&self) -> Option<JumpPhase> {
        let Steps::Styled(steps) = &self.steps else {
            return None;
        };
        steps.window.origin().request.leap_m?;
        let flies = self.feet_in_contact() == [false; 2];
        Some(if flies {
            JumpPhase::Flight
        } else {
            JumpPhase::Load
        })
    }

    /// Returns the controls of a walker that crouches, jumps or has a pending jump.
    pub(crate) fn steered(&self, controls: &Controls) -> Controls {
        let Some(moves) = &self.moves else {
            return *controls;
        };
        let waits = self.pending_jump.is_some() && !self.leaps(controls);
        if waits || moves.phase().is_some() {
            return Controls {
                crouch: controls.crouch,
                ..Controls::STAND
            };
        }
        let fastest = moves.fastest_mps(controls.crouch, FASTEST_RUN_MPS);
        let asked = Controls {
            speed_mps: controls.speed_mps.min(fastest),
            ..*controls
        };
        let pushed = moves.stepped();
        if pushed == Vec2::ZERO {
            return asked;
        }
        // A hard push is followed with steps; the walker returns to its way as the push fades.
        let velocity = asked.velocity() + pushed;
        Controls {
            speed_mps: velocity.length(),
            direction_rad: velocity.x.atan2(velocity.y),
            ..asked
        }
    }

    /// Pushes the walker by a change of velocity, m/s, to its left and forwards: an impulse over the mass of the body. The body sways over its feet and
    /// returns; a push of more than 0.3 m/s is followed by steps in its direction, out of standing and while walking. More than 2 m/s, which would throw people over, counts as 2 m/s.
    ///
    /// A push that is not finite, in a two-footed jump, or with a switching model has no effect.
    pub fn push(&mut self, velocity_mps: Vec2) {
        if let Some(moves) = &mut self.moves
            && velocity_mps.is_finite()
            && moves.phase().is_none()
        {
            moves.push(velocity_mps);
        }
    }

    /// Returns true when the requested jump can be a step.
    fn leaps(&self, controls: &Controls) -> bool {
        let Some(leap) = self.pending_jump else {
            return false;
        };
        let velocity = controls.velocity();
        let direction = velocity.x.atan2(velocity.y).abs();
        let walks = self.shape().amplitude.to >= 1.0;
        let runs = matches!(&self.steps, Steps::Styled(steps) if steps.blend().running.is_some());
        leap.way == Vec3::ZERO
            && walks
            && runs
            && direction < WIDEST_RUN_RAD
            && velocity.length() >= LEAST_LEAP_MPS
    }

    /// Returns the rise of the next step's leap, if it is one.
    pub(crate) fn next_leap(&mut self, controls: &Controls) -> Option<f32> {
        if self.leaps(controls) {
            self.pending_jump.take().map(|leap| leap.rise_m)
        } else {
            None
        }
    }

    /// Advances crouches and jumps, and begins pending ones.
    pub(crate) fn pass_moves(&mut self, secs: f32, controls: &Controls) {
        let stands = self.is_standing();
        let Some(moves) = &mut self.moves else { return };
        let before = moves.phase();
        moves.step(secs, controls.crouch);
        if let Some(way) = moves.landed() {
            self.shift(way);
        } else if before.is_none()
            && stands
            && let Some(leap) = self.pending_jump.take()
        {
            moves.jump(leap);
        } else if before != moves.phase() && moves.phase() == Some(JumpPhase::Landing) {
            self.report_landing();
        }
    }

    /// Displaces the character: to the left, up and ahead.
    fn shift(&mut self, way: Vec3) {
        let faced = from_heading(self.plan_from_character().heading);
        self.plan_from_start.position -= faced * way;
    }

    /// Reports the contacts of both feet after a jump.
    fn report_landing(&mut self) {
        let faced = self.plan_from_start.local(&self.plan_from_character());
        let Some(way) = self.moves.as_ref().and_then(Moves::way) else {
            return;
        };
        for side in Side::BOTH {
            let planted = self.steps.source().planted();
            let Some(plant) = planted.plant(side) else {
                continue;
            };
            let mut footstep = Footstep::seen_from(&self.plan_from_start, side, plant);
            footstep.position += from_heading(faced.heading) * way;
            self.report(footstep);
        }
    }
}
