//! Place in chance and corrections of the way in a saved state.

use super::is_reasonable;
use crate::generator::GaitGenerator;
use crate::ground::Aside;
use crate::source::Steps;
use serde::{Deserialize, Serialize};

/// Strides that chance has drawn, and how far the current step ends from where it was planned, behind a [`State`](super::State).
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Led {
    pub(super) strides: u32,
    /// Way over the ground and turn; `None` where it ends as planned.
    aside: Option<[f32; 4]>,
}

impl Led {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let Steps::Styled(steps) = &generator.steps else {
            return Self::default();
        };
        let aside = steps.walker.origin().aside;
        let [x, y, z] = aside.way.to_array();
        Self {
            strides: steps.planner.strides(),
            aside: (aside != Aside::NONE).then_some([x, y, z, aside.turn]),
        }
    }

    pub(super) fn aside(&self) -> Aside {
        self.aside.map_or(Aside::NONE, |[x, y, z, turn]| Aside {
            way: [x, y, z].into(),
            turn,
        })
    }

    pub(super) fn is_sensible(&self) -> bool {
        let numbers = self.aside.into_iter().flatten();
        numbers.map(f64::from).all(is_reasonable)
    }
}
