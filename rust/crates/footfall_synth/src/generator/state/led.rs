//! Count of strides and displacement of the step in a saved state.

use super::is_reasonable;
use crate::generator::GaitGenerator;
use crate::ground::Displacement;
use crate::source::Steps;
use serde::{Deserialize, Serialize};

/// Number of strides drawn, and displacement of the current step, behind a [`State`](super::State).
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Led {
    pub(super) strides: u32,
    /// Way over the ground and turn; `None` when the step ends as planned.
    displacement: Option<[f32; 4]>,
}

impl Led {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let Steps::Styled(steps) = &generator.steps else {
            return Self::default();
        };
        let displacement = steps.window.origin().displacement;
        let [x, y, z] = displacement.way.to_array();
        Self {
            strides: steps.planner.strides(),
            displacement: (displacement != Displacement::NONE).then_some([
                x,
                y,
                z,
                displacement.turn,
            ]),
        }
    }

    pub(super) fn displacement(&self) -> Displacement {
        self.displacement
            .map_or(Displacement::NONE, |[x, y, z, turn]| Displacement {
                way: [x, y, z].into(),
                turn,
            })
    }

    pub(super) fn is_sensible(&self) -> bool {
        let numbers = self.displacement.into_iter().flatten();
        numbers.map(f64::from).all(is_reasonable)
    }
}
