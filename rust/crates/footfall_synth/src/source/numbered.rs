//! Numbers of a walker's steps.

use super::StyledSteps;
use super::styled::planner_of;
use crate::config::GeneratorConfig;
use crate::plan::{StepDraw, step_number};

impl StyledSteps {
    /// Returns the number of the current step: even ones begin with the left foot's contact. It wraps.
    pub(crate) fn number(&self) -> u16 {
        step_number(self.planner.strides(), self.window.step().timing.leading)
    }

    /// Advances chance to the step of this number and returns its draw.
    pub(crate) fn draw_of(&mut self, config: &GeneratorConfig, number: u16) -> StepDraw {
        let Self {
            planner,
            space,
            measured,
            ..
        } = self;
        planner.draw_of(number, || {
            let mut fresh = planner_of(space, config);
            fresh.set_model(&measured.blend.model);
            fresh
        })
    }

    /// Has the step of this number follow the current one. With another foot than usual, the current one has to end standing.
    pub(crate) fn go_on_with(&mut self, config: &GeneratorConfig, number: u16) {
        if self.number().wrapping_add(1) != number {
            let draw = self.draw_of(config, number);
            // Styles may have changed since the step began.
            self.planner.set_model(&self.window.blends()[1].model);
            self.window.redraw_next(&mut self.planner, draw);
        }
    }
}
