//! The next step of a walker of a crowd, generated in a workshop and kept.

use super::led::LedStep;
use super::own::{Chance, OwnWalk, variation};
use super::rest::{Rest, RestBench, leave};
use super::workshop::Workshop;
use crate::controls::Controls;
use crate::gait::{Amplitude, Ask};
use crate::plan::{Planner, WINDOW};
use crate::source::Origin;
use std::sync::Arc;

impl OwnWalk {
    /// Works out the next step; a led one is another walker's.
    pub(super) fn next_step(
        &mut self,
        controls: Controls,
        led: Option<&LedStep>,
        workshop: &mut Workshop,
    ) {
        let natural = self.number().wrapping_add(1);
        let styled = Arc::clone(&self.styled.0);
        let worn = &styled.worn;
        let ask = Ask::after(
            self.shape.amplitude,
            controls,
            worn.chooser.fastest_mps(),
            self.detail,
        );
        let leading = self.shape.timing.leading;
        let ending = &mut *self.ending;
        let (request, gait) =
            worn.chooser
                .request(&ask, ending.blend.gait, &mut ending.velocity_mps);
        let blend = worn.dress(gait);
        let origin = Origin {
            request,
            ..ending.next.clone()
        };
        let Workshop {
            planner,
            walker,
            bench,
            ..
        } = &mut *workshop;
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
        match led {
            Some(led) if led.number != natural => self.redraw(led.number, planner, &mut draws),
            _ if self.even => draws[WINDOW - 1] = Planner::mean_draw(leading),
            _ => draws[WINDOW - 1] = planner.draw(leading),
        }
        let blends = [&self.ending.blend, blend];
        // The model gave a trajectory when the walker was made, so it gives one now.
        if walker
            .restore(planner, blends, draws, origin, bench)
            .is_err()
        {
            return;
        }
        if let Some(led) = led {
            led.aim.take(&self.plan_from_start, walker, bench);
        }
        let ending = &mut *self.ending;
        ending.blend = Arc::clone(blend);
        ending.draws.clone_from(walker.draws());
        ending.next = walker.next_origin(request);
        self.shape = *walker.step();
        self.take_over(workshop);
        self.landing = self.landing_of_step();
        self.footstep = self.footstep_at(self.landing);
    }

    /// Keeps the step that was just worked out.
    pub(super) fn take_over(&mut self, workshop: &mut Workshop) {
        self.chance = Chance::of(&workshop.planner);
        self.ending.arrival = workshop.walker.stage().arrival;
        let timing = self.shape.ground_timing();
        let stage = &workshop.walker.stage().frames[..=timing.frames];
        let RestBench { planted, frames } = &mut workshop.rest;
        let mut shown = stage;
        if let Some(life) = &self.life {
            if let (true, Some(last)) = (self.shape.amplitude.to < 1.0, stage.last()) {
                match &mut self.rest {
                    Some(rest) => rest.begin(last),
                    none => *none = Some(Box::new(Rest::new(last))),
                }
            }
            if !life.is_still() && self.shape.amplitude != Amplitude::STAND {
                planted.clear();
                planted.extend_from_slice(stage);
                let apart = self.shape.detail.stride() as f32 / self.frame_rate_hz;
                leave(life, planted, apart);
                shown = planted;
            }
        }
        self.frames.set(shown, &self.styled.0.skeleton, frames);
    }
}
