//! Steps that are made to end elsewhere, and draws that are not the next of chance.

use super::super::buffers::StepBuffers;
use super::StepWindow;
use crate::ground::Displacement;
use crate::plan::{StepDraw, TIE, WINDOW};

impl StepWindow {
    /// Has the current step end elsewhere than it would; whether it does. The first step came from nowhere and stays.
    pub(crate) fn displace(&mut self, more: Displacement, buffers: &mut StepBuffers) -> bool {
        let Some(feet) = self.origin.planter else {
            return false;
        };
        self.origin.displacement = self.origin.displacement.and(more);
        self.planted.resume(&feet);
        // Nobody kept what it was made of.
        let changes = self.blend_before.gait != self.blend.gait;
        buffers.go_on(
            &self.blend.statistics,
            &self.plans,
            &self.origin.tie,
            changes,
        );
        self.plant(1, TIE - 1, buffers);
        true
    }

    /// Has the step after the current one be this.
    pub(crate) fn redraw_next(&mut self, draw: StepDraw) {
        self.draws[WINDOW - 1] = draw;
        self.stale = true;
    }
}
