//! Changes of a step by another walker's: a displaced end, and another draw.

use super::StepWindow;
use crate::ground::Displacement;
use crate::plan::{Planner, StepDraw, WINDOW};
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

    /// Replaces the draw of the step after the current one. If that lifts the same foot, the current step, which has to end standing, counts as one of the other foot.
    pub(crate) fn redraw_next(&mut self, planner: &mut Planner, draw: StepDraw) {
        let [.., current, next] = &mut self.draws;
        *next = draw;
        self.stale = true;
        if current.change_feet(next.side, &mut self.end) {
            let plan = &mut self.plans[WINDOW - 2];
            let request = &self.origin.request;
            planner.plan_step(current, request.manner, &self.blend.statistics, plan);
            plan.shape.set_amplitude(request.amplitude);
        }
    }
}
