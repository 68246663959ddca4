//! Part of a state for crouches and jumps.

use super::is_reasonable;
use crate::generator::GaitGenerator;
use crate::moves::{CrouchMoment, Leap, Moves, PushMoment};
use crate::source::Steps;
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Crouch, push and jump of a walker, behind a [`State`](super::State).
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Moving {
    /// Depth of the crouch, and its rate of change, 1/s.
    crouch: [f32; 2],
    /// Push under way: its remaining velocity, and displacement and velocity of the hips, to the left and forwards.
    push: Option<[[f32; 2]; 3]>,
    /// Two-footed jump under way: rise, displacement to the left, up and ahead, and time since its beginning.
    jump: Option<([f32; 4], f32)>,
    /// Pending jump.
    asked: Option<[f32; 4]>,
    /// Rise of the current step if it is a leap.
    pub(super) leap_m: Option<f32>,
}

impl Moving {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let (crouch, push, jump) = generator
            .moves
            .as_ref()
            .map_or_else(Default::default, Moves::moment);
        Self {
            crouch: [crouch.amount, crouch.speed],
            push: (push != PushMoment::default())
                .then(|| [push.velocity, push.away, push.speed].map(|way| way.to_array())),
            jump: jump.map(|(leap, secs)| (numbers_of(&leap), secs)),
            asked: generator.pending_jump.as_ref().map(numbers_of),
            leap_m: match &generator.steps {
                Steps::Styled(steps) => steps.window.origin().request.leap_m,
                Steps::Switching(_) => None,
            },
        }
    }

    /// Restores the moves of a walker.
    pub(super) fn resume(&self, generator: &mut GaitGenerator) {
        generator.pending_jump = self.asked.map(leap_of);
        if let Some(moves) = &mut generator.moves {
            let [amount, speed] = self.crouch;
            let jump = self.jump.map(|(leap, secs)| (leap_of(leap), secs));
            let [velocity, away, swing] = self.push.unwrap_or_default().map(Vec2::from);
            let push = PushMoment {
                velocity,
                away,
                speed: swing,
            };
            moves.resume(CrouchMoment { amount, speed }, push, jump);
        }
    }

    pub(super) fn is_sensible(&self) -> bool {
        let jump = self.jump.map(|(leap, _)| leap);
        let leaps = jump.into_iter().chain(self.asked).flatten();
        let secs = self.jump.map(|(_, secs)| secs);
        let numbers = leaps
            .chain(self.crouch)
            .chain(self.push.into_iter().flatten().flatten())
            .chain(secs)
            .chain(self.leap_m);
        secs.is_none_or(|secs| secs >= 0.0) && numbers.map(f64::from).all(is_reasonable)
    }
}

fn numbers_of(leap: &Leap) -> [f32; 4] {
    let [left, up, ahead] = leap.way.to_array();
    [leap.rise_m, left, up, ahead]
}

fn leap_of([rise_m, left, up, ahead]: [f32; 4]) -> Leap {
    Leap {
        rise_m,
        way: [left, up, ahead].into(),
    }
}
