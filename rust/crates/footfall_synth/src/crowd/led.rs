//! A crowd's walker that makes another's steps: one of the same seed, on another machine.

use super::own::{Chance, OwnWalk, variation};
use super::{CrowdWalker, Workshop};
use crate::config::MAX_DT_SECS;
use crate::controls::{Controls, GaitChoice};
use crate::footstep::Footstep;
use crate::gait::{Amplitude, Gait, StepControls};
use crate::plan::{Planner, StepDraw, WINDOW};
use crate::source::{Aim, StepBuffers, StepWindow};
use footfall_core::{GroundTransform, Side};
use std::sync::Arc;

/// Aim of a led step. Places are of the foot that lands, under the walker's heading when the step is over, and seen from where the walk began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LedAim {
    /// Place where it leads by itself.
    None,
    /// There.
    Place(GroundTransform),
    /// Itself, rather than its foot, to there: it comes to rest.
    Rest(GroundTransform),
    /// Place to which this takes the one where it leads by itself: the one before led elsewhere by as much.
    Moved(GroundTransform),
}

/// A step that a walker is to take because another one has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedStep {
    /// [Number](CrowdWalker::number) of the step.
    pub number: u16,
    /// Controls that it obeys.
    pub controls: Controls,
    /// Place where it leads. One step goes at most 0.2 m and 20° out of its way.
    pub aim: LedAim,
}

/// A moment of a walk to begin at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedBeginning {
    /// [Number](CrowdWalker::number) of the step.
    pub number: u16,
    /// Share of it that has passed, from 0 to 1.
    pub share: f32,
    /// Controls that it obeys. The gait is taken as it is.
    pub controls: Controls,
    /// True for one who rests.
    pub rests: bool,
}

impl LedAim {
    /// Has a step that was just worked out lead there.
    pub(super) fn take(
        &self,
        plan_from_start: &GroundTransform,
        window: &mut StepWindow,
        buffers: &mut StepBuffers,
    ) {
        let place = match self {
            Self::None => return,
            Self::Place(place) | Self::Rest(place) => *place,
            Self::Moved(by) => {
                by.global(&window.planted().aim(plan_from_start, window.step(), false))
            }
        };
        let aim = Aim {
            place,
            rests: matches!(self, Self::Rest(_)),
        };
        window.aim_at(&aim, plan_from_start, buffers);
    }
}

impl CrowdWalker {
    /// Returns whether it walks in steps that it shares with others, which cannot be told.
    pub fn is_sharing(&self) -> bool {
        self.stroll.is_some()
    }

    /// Number of its own current step: even ones begin with the left foot's contact. It wraps. Steps that are [shared](Self::set_repeating) are not counted.
    pub fn number(&self) -> u16 {
        self.own.as_ref().map_or(0, |own| own.number())
    }

    /// Position of its chance, with which a walker of the same seed goes on to draw the same steps.
    pub fn chance_position(&self) -> u64 {
        let own = self.own.as_ref().filter(|_| !self.is_sharing());
        own.map_or(self.chance, |own| own.chance).position
    }

    /// Takes chance up where another walker of the same seed had it in the step of this number. Its draws become the same within a few strides.
    pub fn take_chance(&mut self, number: u16, chance_position: u64) {
        self.chance = Chance {
            position: chance_position,
            strides: u32::from(number.div_ceil(2)),
        };
        if let Some(own) = &mut self.own {
            own.chance = self.chance;
        }
    }

    /// The gait of its own current step.
    pub fn gait(&self) -> Gait {
        let own = self.own.as_ref();
        own.map_or(Gait::Walk, |own| own.ending.blend.gait)
    }

    /// Speed of its own current step, m/s.
    pub fn speed_mps(&self) -> f32 {
        let own = self.own.as_ref();
        own.map_or(0.0, |own| own.ending.velocity_mps.length())
    }

    /// Returns whether its own current step ends in a stand.
    pub fn comes_to_rest(&self) -> bool {
        self.own.as_ref().is_none_or(|own| own.comes_to_rest())
    }

    /// Place where the current step leads, seen from where the walk began: of the foot that lands, under the walker's heading when the step is over. `None` where no
    /// foot lands, and for steps that are shared.
    pub fn start_from_aim(&self) -> Option<GroundTransform> {
        let own = self.own.as_ref().filter(|_| !self.is_sharing())?;
        own.start_from_aim()
    }

    /// Lets time pass as [`step`](Self::step) does, through own steps that `next` gives: it is asked when one is over, and answers nothing while the walker is to rest.
    /// One that does not [come to rest](Self::comes_to_rest) has to be given a step. One that [shares](Self::is_sharing) steps stays where it is: let it [begin](Self::begin_led).
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
        if let Some(own) = &mut self.own {
            own.pass(secs);
        }
        while self.own.as_ref().is_some_and(|own| own.is_over()) {
            let led = next(self);
            let Some(own) = &mut self.own else { break };
            let Some(led) = led else {
                own.stay();
                break;
            };
            own.go_on(led.controls, Some(&led), workshop);
        }
        if let Some(own) = &mut self.own {
            if secs > 0.0 {
                own.live(secs, workshop);
            }
            self.footstep = own.footstep;
            self.start_from_character = own.start_from_character();
        }
    }

    /// Starts over at the origin, facing +Z, in the middle of a step of its own. The walker stays as it is where the model gives no trajectory.
    pub fn begin_led(&mut self, at: &LedBeginning, workshop: &mut Workshop) {
        self.footstep = None;
        if self.is_sharing() && self.go_alone(workshop).is_none() {
            return;
        }
        if let Some(own) = &mut self.own
            && own.begin_led(at, workshop).is_some()
        {
            self.start_from_character = GroundTransform::default();
        }
    }
}

impl OwnWalk {
    /// Number of the current step.
    pub(super) fn number(&self) -> u16 {
        let right = self.shape.timing.leading == Side::Right;
        let strides = self.chance.strides as u16;
        strides.wrapping_mul(2).wrapping_sub(u16::from(right))
    }

    fn start_from_aim(&self) -> Option<GroundTransform> {
        let landing = self.shape.timing.leading.other();
        let plant = self.ending.next.planter.as_ref()?.plants[landing.index()];
        let end = self.place_at(self.shape.timing.frames as f32);
        let foot = Footstep::seen_from(&self.plan_from_start, landing, &plant);
        Some(GroundTransform {
            position: foot.position,
            ..self.plan_from_start.local(&end)
        })
    }

    /// Starts over at the origin in the middle of a step; `None` where the model gives no trajectory.
    fn begin_led(&mut self, at: &LedBeginning, workshop: &mut Workshop) -> Option<()> {
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
        let Workshop {
            planner,
            window,
            buffers,
            ..
        } = &mut *workshop;
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
        self.settle(share, workshop);
        Some(())
    }

    /// Draws the step of this number and the one after it, in place of the last two of a window.
    pub(super) fn redraw(
        &self,
        number: u16,
        planner: &mut Planner,
        draws: &mut [StepDraw; WINDOW],
    ) {
        draws[1] = self.draw_of(number, planner);
        draws[2] = self.draw_of(number.wrapping_add(1), planner);
    }

    /// Takes chance to where it draws the step of this number; returns that. One stride back it takes what is at hand: going there would take chance from its beginning.
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
