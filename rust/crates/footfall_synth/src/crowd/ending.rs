//! End of an own step, from which the next one is generated.

use crate::config::GeneratorConfig;
use crate::ground::Arrival;
use crate::plan::{Planner, StepDraw, WINDOW};
use crate::source::{Blend, Origin};
use glam::Vec2;
use std::sync::Arc;

/// End of a step: all data from which the next one is generated.
#[derive(Clone, Debug)]
pub(super) struct Ending {
    /// The mixture of the step.
    pub(super) blend: Arc<Blend>,
    pub(super) draws: [StepDraw; WINDOW],
    /// Origin of the next step, all but its request.
    pub(super) next: Origin,
    pub(super) velocity_mps: Vec2,
    /// Place of the body when the step ends.
    pub(super) arrival: Arrival,
}

/// Progress of a walker's chance: position of the random generator, and number of strides drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Chance {
    pub(super) position: u64,
    pub(super) strides: u32,
}

impl Chance {
    /// Returns the progress of a planner.
    pub(super) fn of(planner: &Planner) -> Self {
        Self {
            position: planner.chance_position(),
            strides: planner.strides(),
        }
    }

    /// Restores the progress of a planner, after these steps.
    pub(super) fn resume(self, planner: &mut Planner, last: &[StepDraw]) {
        planner.resume(self.position, last);
        planner.count_strides(self.strides);
    }
}

/// Returns the variation of a walker, within bounds.
pub(super) fn variation(config: &GeneratorConfig) -> f64 {
    f64::from(config.variation.clamp(0.0, 2.0))
}
