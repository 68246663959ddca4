//! Climbs in a saved state.

use super::is_reasonable;
use crate::generator::GaitGenerator;
use crate::moves::{ClimbMoment, Moves};
use serde::{Deserialize, Serialize};

/// Lean into a climb, behind a [`State`](super::State): the grade, the angle and its rate of change; `None` on level ground.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Climbing(Option<[f32; 3]>);

impl Climbing {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let moves = generator.moves.as_ref();
        let moment = moves.map(Moves::climb_moment).unwrap_or_default();
        let level = moment == ClimbMoment::default();
        Self((!level).then_some([moment.grade, moment.lean, moment.speed]))
    }

    /// Restores the lean of a walker.
    pub(super) fn resume(&self, generator: &mut GaitGenerator) {
        let [grade, lean, speed] = self.0.unwrap_or_default();
        if let Some(moves) = &mut generator.moves {
            moves.resume_climb(ClimbMoment { grade, lean, speed });
        }
    }

    pub(super) fn is_sensible(&self) -> bool {
        let numbers = self.0.into_iter().flatten();
        numbers.map(f64::from).all(is_reasonable)
    }
}
