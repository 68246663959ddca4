//! Replication in a crowd: a walker that repeats the steps of one with the same seed on another machine.

use super::CrowdWalker;
use super::ending::{Chance, variation};
use super::led_step::{LedBeginning, LedStep};
use super::own::OwnWalk;
use super::tools::StepTools;
use super::workshop::Workshop;
use crate::config::MAX_DT_SECS;
use crate::controls::GaitChoice;
use crate::gait::{Amplitude, Gait, StepControls};
use crate::plan::{Planner, StepDraw, WINDOW, step_number};
use footfall_core::GroundTransform;
use std::sync::Arc;

impl CrowdWalker {
    /// Returns true when it walks in shared steps, which cannot be replicated.
    pub fn is_sharing(&self) -> bool {
        self.stroll.is_some()
    }

    /// Returns the number of its current own step: even ones begin with the left foot's contact. It wraps. [Shared](Self::set_repeating) steps are not counted.
    pub fn number(&self) -> u16 {
        self.own.as_ref().map_or(0, |own| own.number())
    }

    /// Returns the position of chance, from which a walker of the same seed draws the same steps.
    pub fn chance_position(&self) -> u64 {
        let own = self.own.as_ref().filter(|_| !self.is_sharing());
        own.map_or(self.chance, |own| own.chance).position
    }

    /// Sets chance to the position of another walker of the same seed in the step of this number. The draws become the same within a few strides.
    pub fn take_chance(&mut self, number: u16, chance_position: u64) {
        self.chance = Chance {
            position: chance_position,
            strides: u32::from(number.div_ceil(2)),
        };
        if let Some(own) = &mut self.own {
            own.chance = self.chance;
        }
    }

    /// Returns the gait of its current own step.
    pub fn gait(&self) -> Gait {
        let own = self.own.as_ref();
        own.map_or(Gait::Walk, |own| own.ending.blend.gait)
    }

    /// Returns the speed of its current own step, m/s.
    pub fn speed_mps(&self) -> f32 {
        let own = self.own.as_ref();
        own.map_or(0.0, |own| own.ending.velocity_mps.length())
    }

    /// Returns true when its current own step ends standing.
    pub fn comes_to_rest(&self) -> bool {
        self.own.as_ref().is_none_or(|own| own.comes_to_rest())
    }

    /// Returns the place where the current step ends, relative to the start of the walk: that of the landing foot, under the walker's heading at the end of the step. `None` if no
    /// foot lands, and for shared steps.
    pub fn start_from_aim(&self) -> Option<GroundTransform> {
        let own = self.own.as_ref().filter(|_| !self.is_sharing())?;
        own.start_from_aim()
    }

    /// Advances as [`step`](Self::step) does, through own steps from `next`. It is called at the end of a step and returns `None` while the walker is to rest.
    /// A walker that does not [come to rest](Self::comes_to_rest) needs a step. One that [shares](Self::is_sharing) steps stays where it is: let it [begin](Self::begin_led).
    pub fn step_led(
        &mut self,
        dt_secs: f32,
        workshop: &mut Workshop,
        mut next: impl FnMut(&Self) -> Option<LedStep>,
    ) {
        self.footstep = None;
        if self.is_sharing() {
            return;
        }
        let secs = dt_secs.min(MAX_DT_SECS);
        let mut rested = false;
        if let Some(own) = &mut self.own {
            rested = own.is_over();
            own.pass(secs);
        }
        while let Some(own) = self.own.as_mut().filter(|own| own.is_over()) {
            own.end_step(&mut rested);
            let led = next(self);
            let Some(own) = &mut self.own else { break };
            let Some(led) = led else {
                own.stay();
                break;
            };
            own.go_on(led.controls, Some(&led), &mut workshop.tools);
        }
        if let Some(own) = &mut self.own {
            if secs > 0.0 {
                own.live(secs, &mut workshop.tools);
            }
            self.footstep = own.footstep;
            self.start_from_character = own.start_from_character();
        }
    }

    /// Restarts at the origin, facing +Z, in the middle of an own step. The walker stays unchanged if the model gives no trajectory.
    pub fn begin_led(&mut self, at: &LedBeginning, workshop: &mut Workshop) {
        self.footstep = None;
        if self.is_sharing() && self.go_alone(workshop).is_none() {
            return;
        }
        if let Some(own) = &mut self.own
            && own.begin_led(at, &mut workshop.tools).is_some()
        {
            self.start_from_character = GroundTransform::default();
        }
    }
}

impl OwnWalk {
    /// Returns the number of the current step.
    pub(super) fn number(&self) -> u16 {
        step_number(self.chance.strides, self.shape.timing.leading)
    }

    fn start_from_aim(&self) -> Option<GroundTransform> {
        let end = self.place_at(self.shape.timing.frames as f32);
        Some(GroundTransform {
            position: self.closing_footstep()?.position,
            ..self.plan_from_start.local(&end)
        })
    }

    /// Creates a walk at the origin in the middle of a step; `None` if the model gives no trajectory.
    fn begin_led(&mut self, at: &LedBeginning, tools: &mut StepTools) -> Option<()> {
        let styled = Arc::clone(&self.styled.0);
        let measured = &styled.measured;
        let step_controls = StepControls {
            amplitude: Amplitude::WALK,
            ..StepControls::after(
                self.shape.amplitude,
                at.controls,
                measured.chooser.fastest_mps(),
                self.detail,
            )
        };
        let gait = match step_controls.gait {
            GaitChoice::Run => Gait::Run,
            GaitChoice::Auto | GaitChoice::Walk => Gait::Walk,
        };
        let mut velocity_mps = step_controls.velocity_mps;
        let (request, gait) = if at.rests {
            (measured.chooser.standing_request(self.detail), Gait::Walk)
        } else {
            measured
                .chooser
                .request(&step_controls, gait, &mut velocity_mps)
        };
        let blend = measured.blend_of(gait);
        let StepTools {
            planner,
            window,
            buffers,
            ..
        } = &mut *tools;
        let model = &blend.model;
        planner.become_walker(
            model,
            self.config.seed,
            variation(&self.config),
            self.walker,
        );
        let mut draws = self.ending.draws.clone();
        self.chance.resume(planner, &draws);
        draws[0] = self.draw_of(at.number.wrapping_sub(1), planner);
        self.redraw(at.number, planner, &mut draws);
        window.start(planner, blend, draws, request, buffers).ok()?;
        let ending = &mut *self.ending;
        ending.blend = Arc::clone(blend);
        ending.draws.clone_from(window.draws());
        ending.next = window.next_origin(request);
        ending.velocity_mps = velocity_mps;
        self.shape = *window.step();
        self.footstep = None;
        self.plan_from_start = GroundTransform::default();
        if let Some(life) = self.life.as_mut().filter(|_| at.rests) {
            life.stand();
        }
        let share = if at.rests {
            1.0
        } else {
            at.share.clamp(0.0, 0.95)
        };
        self.settle(share, tools);
        Some(())
    }

    /// Replaces the last two draws of a window by those of the step of this number and the next.
    pub(super) fn redraw(
        &self,
        number: u16,
        planner: &mut Planner,
        draws: &mut [StepDraw; WINDOW],
    ) {
        draws[1] = self.draw_of(number, planner);
        draws[2] = self.draw_of(number.wrapping_add(1), planner);
    }

    /// Advances chance to the step of this number and returns its draw. For one stride back it uses the last draw, since going back would draw everything again from the seed.
    fn draw_of(&self, number: u16, planner: &mut Planner) -> StepDraw {
        if planner.is_one_ahead_of(number) {
            return planner.draw_again(number);
        }
        planner.draw_of(number, || {
            let model = &self.styled.0.measured.blend.model;
            Planner::new(model, self.config.seed, variation(&self.config))
        })
    }
}
