//! Changes of a step by another walker's: a displaced end, and another draw.

use super::StepWindow;
use crate::ground::Displacement;
use crate::plan::{StepDraw, WINDOW};
use crate::source::buffers::StepBuffers;

impl StepWindow {
    /// Displaces the end of the current step; returns true if it did. The very first step stays unchanged.
    pub(crate) fn displace(&mut self, more: Displacement, buffers: &mut StepBuffers) -> bool {
        let Some(feet) = self.origin.planter else {
            return false;
        };
        self.origin.displacement = self.origin.displacement.and(more);
        self.planted.resume(&feet);
        // The solved trajectory was not kept.
        self.solve_and_plant(buffers);
        true
    }

    /// Replaces the draw of the step after the current one.
    pub(crate) fn redraw_next(&mut self, draw: StepDraw) {
        self.draws[WINDOW - 1] = draw;
        self.stale = true;
    }
}
