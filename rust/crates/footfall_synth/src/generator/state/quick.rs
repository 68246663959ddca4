//! Saving a step that was made to obey in its middle.

use super::{State, is_reasonable};
use crate::gait::AppliedControls;
use crate::generator::GaitGenerator;
use crate::ground::{Lean, PlanterState};
use crate::plan::Remainder;
use crate::source::Steps;
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Data needed to go on with a step that was made to obey in its middle.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Quick {
    /// Velocity of the step before and of this one, as their requests had them.
    pub(super) velocities_mps: [[f32; 2]; 2],
    /// Requests that the step obeys: velocity and turning; true where it stops, and where it was stretched.
    obeys: ([f32; 2], f32, bool, bool),
    /// The state that its rest begins in, the share of that which is left, and the share of the whole step that had passed.
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

    /// Of a state that knows no such steps: one whose speed does not change.
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

    pub(super) fn lean(&self) -> Lean {
        let [angle, rate] = self.lean.map(Vec2::from);
        Lean { angle, rate }
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
