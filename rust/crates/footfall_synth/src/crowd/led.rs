//! A crowd's walker that makes another's steps: one of the same seed, on another machine.

use super::repeat::Base;
use super::{CrowdWalker, Workshop, variation};
use crate::controls::Controls;
use crate::footstep::Footstep;
use crate::gait::{Gait, GaitChoice};
use crate::plan::{Planner, StepDraw};
use crate::standing::Amplitude;
use crate::steps::Ask;
use crate::walker::{Aim, WINDOW, Walker};
use crate::workbench::Workbench;
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
        walker: &mut Walker,
        bench: &mut Workbench,
    ) {
        let place = match self {
            Self::None => return,
            Self::Place(place) | Self::Rest(place) => *place,
            Self::Moved(by) => {
                by.global(&walker.stage().aim(plan_from_start, walker.step(), false))
            }
        };
        let aim = Aim {
            place,
            rests: matches!(self, Self::Rest(_)),
        };
        walker.aim_at(&aim, plan_from_start, bench);
    }
}

impl CrowdWalker {
    /// Number of the current step: even ones begin with the left foot's contact. It wraps. Steps that are [repeated](Self::set_repeating) are not counted.
    pub fn number(&self) -> u16 {
        let right = self.shape.timing.leading == Side::Right;
        let strides = self.strides as u16;
        strides.wrapping_mul(2).wrapping_sub(u16::from(right))
    }

    /// Position of its chance, with which a walker of the same seed goes on to draw the same steps.
    pub fn chance_position(&self) -> u64 {
        self.chance_position
    }

    /// Takes chance up where another walker of the same seed had it in the step of this number. Its draws become the same within a few strides.
    pub fn take_chance(&mut self, number: u16, chance_position: u64) {
        self.strides = u32::from(number.div_ceil(2));
        self.chance_position = chance_position;
    }

    /// The gait of the current step.
    pub fn gait(&self) -> Gait {
        self.blend.gait
    }

    /// Speed of the current step, m/s.
    pub fn speed_mps(&self) -> f32 {
        self.velocity_mps.length()
    }

    /// Seconds since the current step began; for one who rests, since that was over, the length of the step.
    pub fn secs_of_step(&self) -> f32 {
        self.position / self.frame_rate_hz
    }

    /// Place where the current step leads, seen from where the walk began: of the foot that lands, under the walker's heading when the step is over. `None` where no
    /// foot lands, and for steps that are repeated.
    pub fn start_from_aim(&self) -> Option<GroundTransform> {
        if self.odd || self.repeating {
            return None;
        }
        let landing = self.shape.timing.leading.other();
        let plant = self.next.planter.as_ref()?.plants[landing.index()];
        let end = self.plan_from_start.local(&self.end());
        let foot = Footstep::seen_from(&self.plan_from_start, landing, &plant);
        Some(GroundTransform {
            position: foot.position,
            ..end
        })
    }

    /// Lets time pass as [`step`](Self::step) does, through the steps that `next` gives: it is asked when one is over, and answers nothing while the walker is to rest.
    /// One that does not [come to rest](Self::comes_to_rest) has to be given a step.
    pub fn step_led(
        &mut self,
        dt_secs: f32,
        workshop: &mut Workshop,
        mut next: impl FnMut(&Self) -> Option<LedStep>,
    ) {
        self.pass(dt_secs, workshop, |walker, workshop| {
            let led = next(walker);
            if let Some(led) = &led {
                walker.next_step(led.controls, Some(led), workshop);
            }
            led.is_some()
        });
    }

    /// Starts over at the origin, facing +Z, in the middle of a step. The walker stays as it is where the model gives no trajectory.
    pub fn begin_led(&mut self, at: &LedBeginning, workshop: &mut Workshop) {
        let styled = Arc::clone(&self.styled.0);
        let worn = &styled.worn;
        let ask = Ask {
            amplitude: Amplitude::WALK,
            ..Ask::after(&self.shape, at.controls, worn.fastest_mps(), self.detail)
        };
        let gait = match ask.gait {
            GaitChoice::Run => Gait::Run,
            GaitChoice::Auto | GaitChoice::Walk => Gait::Walk,
        };
        let mut velocity_mps = ask.velocity_mps;
        let (request, gait) = if at.rests {
            (worn.standing_request(self.detail), Gait::Walk)
        } else {
            worn.request(&ask, gait, &mut velocity_mps)
        };
        let blend = worn.dress(gait);
        let Workshop {
            planner,
            walker,
            bench,
            ..
        } = &mut *workshop;
        let model = &blend.model;
        planner.become_walker(
            model,
            self.config.seed,
            variation(&self.config),
            self.walker,
        );
        planner.resume(self.chance_position, &*self.draws);
        planner.count_strides(self.strides);
        let mut draws = (*self.draws).clone();
        draws[0] = self.draw_of(at.number.wrapping_sub(1), planner);
        self.redraw(at.number, planner, &mut draws);
        if walker.start(planner, blend, draws, request, bench).is_err() {
            return;
        }
        self.blend = Arc::clone(blend);
        (*self.draws).clone_from(walker.draws());
        *self.next = walker.next_origin(request);
        self.shape = *walker.step();
        self.velocity_mps = velocity_mps;
        self.base = Base::default();
        self.before = None;
        self.odd = false;
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
        self.start_from_character = GroundTransform::default();
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
            let model = &self.styled.0.worn.blend.model;
            Planner::new(model, self.config.seed, variation(&self.config))
        })
    }
}
