//! Generation of the next own step in a workshop.

use super::ending::{Chance, variation};
use super::led_step::LedStep;
use super::own::OwnWalk;
use super::rest::{Rest, RestBuffers, leave};
use super::tools::StepTools;
use crate::controls::Controls;
use crate::gait::{Amplitude, StepControls, lifts_other_foot};
use crate::plan::{Planner, WINDOW};
use crate::source::Origin;
use crate::standing::Life;
use std::sync::Arc;

impl OwnWalk {
    /// Generates the next step; a led step repeats another walker's.
    pub(super) fn next_step(
        &mut self,
        controls: Controls,
        led: Option<&LedStep>,
        tools: &mut StepTools,
    ) {
        let rested = self.comes_to_rest();
        let natural = self.number().wrapping_add(1);
        let number = match led {
            Some(led) => led.number,
            None if self.sets_out_otherwise(&controls) => natural.wrapping_add(1),
            None => natural,
        };
        let styled = Arc::clone(&self.styled.0);
        let measured = &styled.measured;
        let step_controls = StepControls::after(
            self.shape.amplitude,
            controls,
            measured.chooser.fastest_mps(),
            self.detail,
        );
        let leading = self.shape.timing.leading;
        let ending = &mut *self.ending;
        let (request, gait) =
            measured
                .chooser
                .request(&step_controls, ending.blend.gait, &mut ending.velocity_mps);
        let blend = measured.blend_of(gait);
        let mut origin = Origin {
            request,
            ..ending.next.clone()
        };
        let StepTools {
            planner,
            window,
            buffers,
            ..
        } = &mut *tools;
        let model = &ending.blend.model;
        planner.become_walker(
            model,
            self.config.seed,
            variation(&self.config),
            self.walker,
        );
        self.chance.resume(planner, &ending.draws);
        let mut draws = ending.draws.clone();
        draws.rotate_left(1);
        if number != natural {
            self.redraw(number, planner, &mut draws);
            let [before, next, _] = &mut draws;
            before.change_feet(next.side, &mut origin.tie);
        } else if self.even {
            draws[WINDOW - 1] = Planner::mean_draw(leading);
        } else {
            draws[WINDOW - 1] = planner.draw(leading);
        }
        let blends = [&self.ending.blend, blend];
        // The model gave a trajectory when the walker was made, so it gives one now.
        if window
            .restore(planner, blends, draws, origin, buffers)
            .is_err()
        {
            return;
        }
        if let Some(led) = led {
            led.aim.take(&self.plan_from_start, window, buffers);
        }
        let ending = &mut *self.ending;
        ending.blend = Arc::clone(blend);
        ending.draws.clone_from(window.draws());
        ending.next = window.next_origin(request);
        self.shape = *window.step();
        self.take_over(tools);
        self.landing = self.landing_of_step();
        // A walker at rest has both feet on the ground.
        if !rested {
            self.footstep = self.footstep_at(self.landing);
        }
    }

    /// Returns true when people who stand as it does set out for these controls with the other foot than the one whose turn it is.
    fn sets_out_otherwise(&self, controls: &Controls) -> bool {
        if self.even || !self.comes_to_rest() || controls.is_standing() {
            return false;
        }
        let aside = self.life.as_ref().map_or(0.0, Life::aside);
        lifts_other_foot(controls, aside, self.shape.timing.leading)
    }

    /// Keeps the step that was just generated.
    pub(super) fn take_over(&mut self, tools: &mut StepTools) {
        self.chance = Chance::of(&tools.planner);
        self.ending.arrival = tools.window.planted().arrival;
        let timing = self.shape.ground_timing();
        let step = &tools.window.planted().frames[..=timing.frames];
        let RestBuffers { planted, frames } = &mut tools.rest;
        let mut shown = step;
        if let Some(life) = &self.life {
            if let (true, Some(last)) = (self.shape.amplitude.to < 1.0, step.last()) {
                match &mut self.rest {
                    Some(rest) => rest.begin(last),
                    none => *none = Some(Box::new(Rest::new(last))),
                }
            }
            if !life.is_still() && self.shape.amplitude != Amplitude::STAND {
                planted.clear();
                planted.extend_from_slice(step);
                let apart = self.shape.detail.stride() as f32 / self.frame_rate_hz;
                leave(life, planted, apart);
                shown = planted;
            }
        }
        self.frames.set(shown, &self.styled.0.skeleton, frames);
    }
}
