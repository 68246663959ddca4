//! Jumps of a walker, from request to landing; and pushes.
//!
//! A standing walker jumps off both feet ([`moves`](crate::moves)). One that walks or runs forwards leaps: the next step is a step of the run whose flight lasts as
//! long as the rise takes ([`StepPlan::leap`](crate::plan::StepPlan::leap)), or the step that reaches the place that it is to land on
//! ([`run_up`](super::run_up)). One that goes sideways, backwards or very slowly stops first.

use super::GaitGenerator;
use super::run_up::RunUp;
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

/// Pending jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PendingJump {
    /// Rise of the hips above their height before the jump, metres; `None` for what the place requires.
    pub(crate) rise_m: Option<f32>,
    /// Place to land on, relative to the start of the walk; its height is that above the ground before the jump.
    pub(crate) place: Option<Vec3>,
}

/// Returns the rise of a jump to a place relative to the character, metres.
fn rise_to(place: Vec3) -> f32 {
    let level = RISE_TO_PLACE_M + RISE_BY_DISTANCE * place.with_y(0.0).length();
    level.max(place.y + RISE_ABOVE_PLACE_M)
}

impl GaitGenerator {
    /// Requests one jump in which the hips rise by this height above their current one, standing, walking or running, metres; 0.1 to 0.5 is typical of adults. It begins as soon as
    /// the feet allow: at once for a standing walker, with the next step for one that walks or runs forwards faster than 0.8 m/s (a leap off one foot onto the other),
    /// and after a stop for all others. Further requests while a jump is pending or under way have no effect.
    ///
    /// Returns true if there will be a jump: not with a model without jumps, nor for a rise that is not finite or too small.
    pub fn jump(&mut self, rise_m: f32) -> bool {
        self.request_jump(Some(rise_m), None)
    }

    /// Requests one jump that lands at a place relative to the character as it is now: metres to the left, up and ahead.
    ///
    /// A walker or runner that goes forwards to a place on the level leaps there without stopping, off one foot onto the other, once the place is near enough: the foot lands at it,
    /// along the way, and the body passes over it. No leap lands on places nearer than about 0.6 s or farther than 4 s of the way, more than 0.15 m higher or lower, or more than
    /// 0.35 m to the side of the way. For these, and for walkers who go another way, the walker stops first and jumps off both feet. Then a place
    /// beyond the reach of people (about twice the leg length ahead, two thirds of it to the side or back) is not reached: the jump goes as far as it can in that direction.
    ///
    /// Returns true if there will be a jump, as [`jump`](Self::jump) does.
    pub fn jump_to(&mut self, place: Vec3) -> bool {
        self.request_jump(None, Some(place))
    }

    /// Requests a jump by this rise, or by what its place requires, to a place relative to the character if there is one, as [`jump`](Self::jump) does.
    pub(crate) fn request_jump(&mut self, rise_m: Option<f32>, to: Option<Vec3>) -> bool {
        let possible = self.moves.as_ref().is_some_and(Moves::can_jump);
        let sensible = to.is_none_or(Vec3::is_finite)
            && rise_m.is_none_or(|rise| rise.is_finite() && rise >= LEAST_RISE_M);
        if !possible || !sensible {
            return false;
        }
        if self.pending_jump.is_none() && self.jump_phase().is_none() {
            self.pending_jump = Some(PendingJump {
                rise_m,
                place: to.map(|to| self.start_from_seen(to)),
            });
        }
        true
    }

    /// Returns a place relative to the start of the walk, given relative to the character.
    pub(crate) fn start_from_seen(&self, place: Vec3) -> Vec3 {
        let character = self.start_from_character();
        character.position + from_heading(character.heading) * place
    }

    /// Returns a place relative to the character, given relative to the start of the walk.
    pub(crate) fn seen_from_start(&self, place: Vec3) -> Vec3 {
        let character = self.start_from_character();
        from_heading(-character.heading) * (place - character.position)
    }

    /// Returns the phase of the current jump; `None` while it is pending.
    pub fn jump_phase(&self) -> Option<JumpPhase> {
        let both = self.moves.as_ref().and_then(Moves::phase);
        both.or_else(|| self.leap_phase())
    }

    /// Returns true in the flight of a two-footed jump, which moves the character itself up and down; a leap lifts the body above it.
    pub fn soars(&self) -> bool {
        self.moves.as_ref().and_then(Moves::phase) == Some(JumpPhase::Flight)
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

    /// Pushes the walker by a change of velocity, m/s, to its left and forwards: an impulse over the mass of the body. The body gives way within a tenth of a second, trunk
    /// first and hands last, sways over its feet and returns; a push of more than 0.3 m/s is followed by steps in its direction, out of standing and while walking. More than 2 m/s, which would throw people over, counts as 2 m/s.
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
        let Some(jump) = self.pending_jump else {
            return false;
        };
        let velocity = controls.velocity();
        let direction = velocity.x.atan2(velocity.y).abs();
        let walks = self.shape().amplitude.to >= 1.0;
        let runs = matches!(&self.steps, Steps::Styled(steps) if steps.blend().running.is_some());
        let forwards =
            walks && runs && direction < WIDEST_RUN_RAD && velocity.length() >= LEAST_LEAP_MPS;
        forwards
            && jump
                .place
                .is_none_or(|place| self.run_up(place, controls).is_some())
    }

    /// Returns the rise of the next step's leap, if it is one, and the aim of the next step if it leads to a place.
    pub(crate) fn next_leap(&mut self, controls: &Controls) -> (Option<f32>, Option<RunUp>) {
        let Some(jump) = self.pending_jump.filter(|_| self.leaps(controls)) else {
            return (None, None);
        };
        let run_up = jump.place.and_then(|place| self.run_up(place, controls));
        let rise_m = match run_up {
            Some(run_up) => run_up.rise_m,
            None => jump.rise_m,
        };
        if rise_m.is_some() {
            self.pending_jump = None;
        }
        (rise_m, run_up)
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
            && let Some(jump) = self.pending_jump.take()
        {
            let way = jump
                .place
                .map_or(Vec3::ZERO, |place| self.seen_from_start(place));
            let rise_m = jump.rise_m.unwrap_or_else(|| rise_to(way));
            if let Some(moves) = &mut self.moves {
                moves.jump(Leap { rise_m, way });
            }
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
