//! Replanned steps in a saved state.

use super::{State, is_reasonable};
use crate::gait::AppliedControls;
use crate::generator::GaitGenerator;
use crate::ground::{Lean, PlanterState};
use crate::plan::Remainder;
use crate::source::Steps;
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Data needed to continue a replanned step.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Quick {
    /// Requested velocities of the previous step and of this one.
    pub(super) velocities_mps: [[f32; 2]; 2],
    /// Applied controls: velocity and turn rate; true if the step stops, and if it was stretched.
    obeys: ([f32; 2], f32, bool, bool),
    /// First state of the remainder, the share of it that is left, and the share of the whole step that had passed.
    remainder: Option<(u8, f32, f32)>,
    /// Lean of the trunk as the step begins, and its rate of change.
    lean: [[f32; 2]; 2],
}

impl Quick {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let lean_of = |feet: Option<PlanterState>| {
            feet.map_or_else(Default::default, |feet| {
                [feet.lean.angle, feet.lean.rate].map(|part| part.to_array())
            })
        };
        let steps = match &generator.steps {
            Steps::Styled(steps) => steps,
            Steps::Switching(steps) => {
                return Self {
                    lean: lean_of(steps.origin.planter),
                    ..Self::default()
                };
            }
        };
        let (origin, applied) = (steps.window.origin(), &steps.applied);
        let velocities = [origin.velocity_before_mps, origin.request.velocity_mps];
        Self {
            velocities_mps: velocities.map(|velocity| velocity.to_array()),
            obeys: (
                applied.velocity_mps.to_array(),
                applied.turn_rate,
                applied.stops,
                applied.stretched,
            ),
            remainder: origin
                .remainder
                .map(|remainder| (remainder.state as u8, remainder.left, remainder.passed)),
            lean: lean_of(origin.planter),
        }
    }

    /// Default for earlier versions of states: a step of constant speed.
    pub(super) fn of_slow(state: &State) -> Self {
        Self {
            velocities_mps: [state.velocity_mps; 2],
            obeys: (
                state.velocity_mps,
                state.turn_rate,
                state.amplitude[1] < 1.0,
                false,
            ),
            remainder: None,
            lean: Default::default(),
        }
    }

    /// Returns the lean of a body whose standing leg leans forwards by `leg`, radians.
    pub(super) fn lean(&self, leg: f32) -> Lean {
        let [angle, rate] = self.lean.map(Vec2::from);
        Lean { angle, rate, leg }
    }

    pub(super) fn applied(&self) -> AppliedControls {
        let (velocity, turn_rate, stops, stretched) = self.obeys;
        AppliedControls {
            velocity_mps: velocity.into(),
            turn_rate,
            stops,
            stretched,
        }
    }

    pub(super) fn remainder(&self) -> Option<Remainder> {
        self.remainder.map(|(state, left, passed)| Remainder {
            state: state.into(),
            left,
            passed,
        })
    }

    pub(super) fn is_sensible(&self) -> bool {
        let (applied, turn_rate, ..) = self.obeys;
        let numbers = self
            .velocities_mps
            .into_iter()
            .chain(self.lean)
            .flatten()
            .chain(applied);
        let reasonable = numbers.chain([turn_rate]).map(f64::from).all(is_reasonable);
        reasonable
            && self
                .remainder()
                .is_none_or(|remainder| remainder.is_sensible())
    }
}
