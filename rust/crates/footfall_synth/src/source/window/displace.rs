//! Steps that are made to end elsewhere, and draws that are not the next of chance.

use super::Walker;
use crate::ground::Aside;
use crate::plan::{StepDraw, TIE, WINDOW};
use crate::source::buffers::Workbench;

impl Walker {
    /// Has the current step end elsewhere than it would; whether it does. The first step came from nowhere and stays.
    pub(crate) fn step_aside(&mut self, more: Aside, bench: &mut Workbench) -> bool {
        let Some(feet) = self.origin.planter else {
            return false;
        };
        self.origin.aside = self.origin.aside.and(more);
        self.stage.resume(&feet);
        // Nobody kept what it was made of.
        let changes = self.blend_before.gait != self.blend.gait;
        bench.go_on(
            &self.blend.statistics,
            &self.plans,
            &self.origin.tie,
            changes,
        );
        self.put_on_ground(1, TIE - 1, bench);
        true
    }

    /// Has the step after the current one be this.
    pub(crate) fn redraw_next(&mut self, draw: StepDraw) {
        self.draws[WINDOW - 1] = draw;
        self.stale = true;
    }
}
