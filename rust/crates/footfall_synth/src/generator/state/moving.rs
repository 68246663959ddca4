//! Part of a state for crouches and jumps.

use super::is_reasonable;
use crate::generator::{GaitGenerator, PendingJump};
use crate::moves::{CrouchMoment, Leap, Moves, PushMoment};
use crate::source::Steps;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Place of a jump that goes to none: far below any ground.
const NOWHERE: Vec3 = Vec3::new(0.0, -1e6, 0.0);

/// Crouch, push and jump of a walker, behind a [`State`](super::State).
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Moving {
    /// Depth of the crouch, and its rate of change, 1/s.
    crouch: [f32; 2],
    /// Push under way: its remaining velocity, and displacement and velocity of the hips, to the left and forwards.
    push: Option<[[f32; 2]; 3]>,
    /// Two-footed jump under way: rise, displacement to the left, up and ahead, and time since its beginning.
    jump: Option<([f32; 4], f32)>,
    /// Pending jump: rise, 0 for what its place requires, and its place relative to the start of the walk or [`NOWHERE`].
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
            asked: generator.pending_jump.map(|jump| {
                let place = jump.place.unwrap_or(NOWHERE);
                [jump.rise_m.unwrap_or(0.0), place.x, place.y, place.z]
            }),
            leap_m: match &generator.steps {
                Steps::Styled(steps) => steps.window.origin().request.leap_m,
                Steps::Switching(_) => None,
            },
        }
    }

    /// Restores the moves of a walker, with the part of a push that has not reached the hips; the place of a pending jump may be relative to the
    /// character, as it was in earlier versions.
    pub(super) fn resume(&self, generator: &mut GaitGenerator, coming: Vec2, is_seen: bool) {
        generator.pending_jump = self.asked.map(|[rise_m, x, y, z]| {
            let place = Vec3::new(x, y, z);
            PendingJump {
                rise_m: (rise_m > 0.0).then_some(rise_m),
                place: if is_seen {
                    (place != Vec3::ZERO).then(|| generator.start_from_seen(place))
                } else {
                    (place != NOWHERE).then_some(place)
                },
            }
        });
        if let Some(moves) = &mut generator.moves {
            let [amount, speed] = self.crouch;
            let jump = self.jump.map(|(leap, secs)| (leap_of(leap), secs));
            let [velocity, away, swing] = self.push.unwrap_or_default().map(Vec2::from);
            let push = PushMoment {
                velocity,
                coming,
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
