//! Moves of the whole body on top of its steps: crouches, two-footed jumps, leans into climbs, and pushes.
//!
//! Steps determine the feet and the posture over them; [`crouch`] lowers the body there, [`jump`] takes it off the ground and back, and [`push`] displaces it. The first two are
//! learned postures relative to standing, applied by [`body`].

mod body;
mod climb;
mod crouch;
mod jump;
mod push;

use crate::gait::{Posture, standing_features};
use body::Body;
pub(crate) use climb::ClimbMoment;
use crouch::Crouch;
pub(crate) use crouch::CrouchMoment;
use footfall_core::{Pose, Skeleton};
use footfall_model::{CrouchModel, GaitModel};
use glam::{Vec2, Vec3};
pub use jump::JumpPhase;
pub(crate) use jump::Leap;
use jump::{Flown, JumpMoment, JumpTables};
pub(crate) use push::PushMoment;
use std::sync::Arc;

/// Moves of a model, shared by all of its walkers.
#[derive(Debug)]
pub(crate) struct MoveTables {
    jump: Option<JumpTables>,
    crouch: Option<CrouchModel>,
    standing: Posture,
}

/// Moves of one walker.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    tables: Arc<MoveTables>,
    body: Body,
    crouch: Crouch,
    jump: Option<JumpMoment>,
    push: PushMoment,
    climb: ClimbMoment,
}

impl MoveTables {
    pub(crate) fn of(model: &GaitModel) -> Self {
        let standing = standing_features(model);
        Self {
            jump: model
                .jump
                .as_ref()
                .map(|jump| JumpTables::of(jump, &standing)),
            crouch: model.crouch.clone(),
            standing,
        }
    }
}

impl Moves {
    /// Creates the moves of a walker.
    pub(crate) fn new(tables: &Arc<MoveTables>, skeleton: &Skeleton) -> Self {
        let tables = Arc::clone(tables);
        let body = Body::new(skeleton);
        Self {
            crouch: Crouch::new(tables.crouch.as_ref(), &tables.standing, body.leg_length),
            tables,
            body,
            jump: None,
            push: PushMoment::default(),
            climb: ClimbMoment::default(),
        }
    }

    /// Returns true when the model has two-footed jumps.
    pub(crate) fn can_jump(&self) -> bool {
        self.tables.jump.is_some()
    }

    /// Returns the maximum speed at this requested depth of crouch, m/s.
    pub(crate) fn fastest_mps(&self, amount: f32, upright: f32) -> f32 {
        self.crouch.fastest_mps(amount, upright)
    }

    /// Begins a two-footed jump.
    pub(crate) fn jump(&mut self, leap: Leap) {
        let Some(tables) = &self.tables.jump else {
            return;
        };
        self.jump = Some(JumpMoment::new(tables, leap, &self.body));
    }

    /// Pushes the body by a change of velocity to the left and forwards, m/s.
    pub(crate) fn push(&mut self, velocity: Vec2) {
        self.push.push(velocity);
    }

    /// Returns the part of a push that has not reached the hips yet, m/s, if there is one.
    pub(crate) fn coming(&self) -> Option<[f32; 2]> {
        let coming = self.push.coming;
        (coming != Vec2::ZERO).then(|| coming.to_array())
    }

    /// Sets the grade of the way.
    pub(crate) fn climb(&mut self, grade: f32) {
        self.climb.go_on(grade);
    }

    /// Returns the velocity of a push that remains to be followed with steps.
    pub(crate) fn stepped(&self) -> Vec2 {
        self.push.stepped()
    }

    /// Returns the phase of the jump under way.
    pub(crate) fn phase(&self) -> Option<JumpPhase> {
        self.jump.as_ref().map(JumpMoment::phase)
    }

    /// Returns the displacement of the jump under way to the left, up and ahead, metres.
    pub(crate) fn way(&self) -> Option<Vec3> {
        self.jump.as_ref().map(JumpMoment::way)
    }

    /// Advances by a time.
    pub(crate) fn step(&mut self, secs: f32, crouch: f32) {
        self.crouch.step(secs, crouch);
        self.push.step(secs);
        self.climb.step(secs);
        if let Some(jump) = &mut self.jump {
            jump.secs += secs;
        }
    }

    /// Returns the displacement of a jump that has just ended, once.
    pub(crate) fn landed(&mut self) -> Option<Vec3> {
        let jump = self.jump.filter(JumpMoment::is_over)?;
        self.jump = None;
        Some(jump.way())
    }

    /// Applies the moves to a pose that faces +Z; returns the progress of a jump under way.
    pub(crate) fn move_pose(&self, pose: &mut Pose) -> Option<Flown> {
        self.climb.bend(pose);
        self.push.give_way(&self.body, pose);
        self.crouch.lower(&self.body, pose);
        let (tables, jump) = (self.tables.jump.as_ref()?, self.jump.as_ref()?);
        Some(jump.move_pose(tables, &self.body, pose))
    }

    /// Returns the lean into the climb.
    pub(crate) fn climb_moment(&self) -> ClimbMoment {
        self.climb
    }

    /// Restores the lean into the climb.
    pub(crate) fn resume_climb(&mut self, climb: ClimbMoment) {
        self.climb = climb;
    }

    /// Returns the moves' part of a state: crouch, push, and the jump under way with the time since its beginning.
    pub(crate) fn moment(&self) -> (CrouchMoment, PushMoment, Option<(Leap, f32)>) {
        let jump = self.jump.map(|jump| (jump.leap, jump.secs));
        (self.crouch.moment, self.push, jump)
    }

    /// Restores the moves.
    pub(crate) fn resume(
        &mut self,
        crouch: CrouchMoment,
        push: PushMoment,
        jump: Option<(Leap, f32)>,
    ) {
        self.crouch.moment = crouch;
        self.push = push;
        self.jump = None;
        if let Some((leap, secs)) = jump {
            self.jump(leap);
            if let Some(jump) = &mut self.jump {
                jump.secs = secs;
            }
        }
    }
}
