//! Walkers by the thousand: each keeps a step in a few kilobytes, and shares with all others what works steps out.
//!
//! A [`GaitGenerator`](crate::GaitGenerator) owns the buffers in which its steps are solved, some hundred kilobytes. A
//! [`CrowdWalker`] borrows them from a [`Workshop`], one a thread, for a moment about twice a second, and keeps the result: where every
//! joint is in each frame of its step. In between it costs an interpolation.

mod feet;
mod frames;
mod led;
mod repeat;
mod rest;
mod workshop;

use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::generator::{GeneratorConfig, MAX_DT_SECS, check};
use crate::plan::{MAX_COMPONENTS, Planner, StepDraw, StepShape};
use crate::space::Blend;
use crate::stage::Arrival;
use crate::standing::{Amplitude, Life};
use crate::steps::Ask;
use crate::walker::{Origin, WINDOW};
use footfall_core::GroundTransform;
use footfall_ik::Plant;
use frames::CrowdFrames;
pub use frames::CrowdPose;
use glam::Vec2;
pub use led::{LedAim, LedBeginning, LedStep};
use repeat::{Base, Before};
use rest::{Rest, RestBench, leave};
use std::sync::Arc;
pub use workshop::{StyledBody, Workshop};

/// One walker of a crowd: walks as a [`GaitGenerator`](crate::GaitGenerator) of its seed would, in a hundredth of the memory.
///
/// Its speed is that of the average walker of its styles: people of the same crowd who are asked for the same speed differ by a few
/// percent.
#[derive(Debug)]
pub struct CrowdWalker {
    config: GeneratorConfig,
    styled: StyledBody,
    /// The mixture of the current step.
    blend: Arc<Blend>,
    /// Identity of the walker: weights of the model's walker components.
    walker: [f64; MAX_COMPONENTS],
    chance_position: u64,
    /// Strides that chance has drawn.
    strides: u32,
    draws: Box<[StepDraw; WINDOW]>,
    /// Origin of the next step, all but its request. Boxed like the draws: most frames need neither.
    next: Box<Origin>,
    shape: StepShape,
    velocity_mps: Vec2,
    detail: Detail,
    /// Frames since the step began.
    position: f32,
    frame_rate_hz: f32,
    frames: CrowdFrames,
    /// Place of the frames' plan in the walker's.
    base: Base,
    /// Plant of the foot whose landing began the step, in the frames' plan.
    landing: Option<Plant>,
    /// The step before, to be walked again.
    before: Option<Before>,
    /// True when steps are repeated instead of worked out.
    repeating: bool,
    /// True when an odd number of steps was repeated, so that the step before the last one worked out is walked.
    odd: bool,
    plan_from_start: GroundTransform,
    start_from_character: GroundTransform,
    footstep: Option<Footstep>,
    /// Place of the body when the current step ends.
    arrival: Arrival,
    /// Its life as it stands; nothing where the model stands still.
    life: Option<Life>,
    /// Resting state; `None` before it first came to a stand.
    rest: Option<Box<Rest>>,
}

impl CrowdWalker {
    /// A walker at the origin, facing +Z, walking already at the speed that suits it; or standing.
    ///
    /// # Errors
    /// [`SynthError`] when a setting is not finite or the model gives no trajectory.
    pub fn new(
        styled: &StyledBody,
        config: &GeneratorConfig,
        standing: bool,
        workshop: &mut Workshop,
    ) -> Result<Self, SynthError> {
        let first = check(&styled.0.skeleton, config)?;
        let worn = &styled.0.worn;
        let Workshop {
            planner,
            walker,
            bench,
            ..
        } = &mut *workshop;
        *planner = Planner::new(&worn.blend.model, config.seed, variation(config));
        let request = if standing {
            worn.standing_request(Detail::Full)
        } else {
            worn.first_request(Detail::Full)
        };
        let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
        walker.start(planner, &worn.blend, draws, request, bench)?;
        let shape = *walker.step();
        let mut made = Self {
            config: *config,
            styled: styled.clone(),
            blend: Arc::clone(&worn.blend),
            walker: *planner.walker(),
            chance_position: 0,
            strides: 0,
            draws: Box::new(walker.draws().clone()),
            next: Box::new(walker.next_origin(request)),
            shape,
            velocity_mps: request.velocity_mps,
            detail: Detail::Full,
            position: 0.0,
            frame_rate_hz: styled.0.space.model().frame_rate_hz as f32,
            frames: CrowdFrames::default(),
            base: Base::default(),
            landing: None,
            before: None,
            repeating: false,
            odd: false,
            plan_from_start: GroundTransform::default(),
            start_from_character: GroundTransform::default(),
            footstep: None,
            arrival: Arrival::default(),
            life: Life::new(&styled.0.space, &styled.0.skeleton, config),
            rest: None,
        };
        if let Some(life) = made.life.as_mut().filter(|_| standing) {
            life.stand();
        }
        let share = if standing {
            1.0
        } else {
            (2.0 * config.phase.rem_euclid(1.0)).fract()
        };
        made.settle(share, workshop);
        Ok(made)
    }

    /// Takes over its first step, in the middle of it.
    fn settle(&mut self, share: f32, workshop: &mut Workshop) {
        self.take_over(workshop);
        self.position = share * self.shape.timing.frames as f32;
        self.landing = self.landing_of_step();
        self.plan_from_start = self.plan_from_character();
        self.live(0.0, workshop);
    }

    /// Sets how much it moves as it stands, as of [`GaitGenerator::set_standing_motion`](crate::GaitGenerator::set_standing_motion). Shows within a second.
    pub fn set_standing_motion(&mut self, amount: f32) {
        if let Some(life) = &mut self.life {
            life.set_amount(amount);
        }
    }

    /// Wears other styles from the next step on. They must be of the same model and body.
    pub fn wear(&mut self, styled: &StyledBody) {
        self.styled = styled.clone();
    }

    /// Sets the detail in which it is worked out, from the next step on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
    }

    /// Sets whether its last two steps are walked again and again instead of new ones being worked out, for walkers far away: it
    /// turns, but its speed stays. Those who start, stop or stand are not affected.
    pub fn set_repeating(&mut self, repeating: bool) {
        self.repeating = repeating;
    }

    /// Advances by `dt_secs`. Allocates nothing, but for a step that is longer than any before and for the first rest.
    pub fn step(&mut self, dt_secs: f32, controls: Controls, workshop: &mut Workshop) {
        self.pass(dt_secs, workshop, |walker, workshop| {
            let rests = walker.comes_to_rest() && controls.is_standing();
            if !rests && !walker.repeat_step(controls) {
                walker.next_step(controls, None, workshop);
            }
            !rests
        });
    }

    /// Lets time pass; `go_on` goes on to the next step, or returns false for one who rests.
    fn pass(
        &mut self,
        dt_secs: f32,
        workshop: &mut Workshop,
        mut go_on: impl FnMut(&mut Self, &mut Workshop) -> bool,
    ) {
        self.footstep = None;
        if dt_secs > 0.0 {
            self.position += dt_secs.min(MAX_DT_SECS) * self.frame_rate_hz;
        }
        while self.position >= self.shape.timing.frames as f32 {
            let frames = self.shape.timing.frames as f32;
            if !go_on(self, workshop) {
                self.position = frames;
                break;
            }
            self.position -= frames;
        }
        if dt_secs > 0.0 {
            self.live(dt_secs.min(MAX_DT_SECS), workshop);
        }
        self.start_from_character = self.plan_from_start.local(&self.plan_from_character());
    }

    /// Place and heading of the character, from where it began.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// Seconds until the next step begins, 0 for someone who rests.
    pub fn secs_to_next_step(&self) -> f32 {
        (self.shape.timing.frames as f32 - self.position).max(0.0) / self.frame_rate_hz
    }

    /// Returns whether it has come to a stand and rests.
    pub fn is_standing(&self) -> bool {
        self.comes_to_rest() && self.position >= self.shape.timing.frames as f32
    }

    /// Returns whether its current step ends in a stand.
    pub fn comes_to_rest(&self) -> bool {
        self.shape.amplitude.to < 1.0
    }

    /// Share of its stride that is behind it: 0 when the left foot lands, 0.5 when the right one does.
    pub fn phase(&self) -> f32 {
        let share = (self.position / self.shape.timing.frames as f32).min(1.0);
        let half = self.shape.timing.leading.index() as f32;
        (0.5 * (half + share)).fract()
    }

    /// Has memory bring what [`pose`](Self::pose) reads. Worth it for several walkers in a row, whose poses are then asked for in the same
    /// order: they lie in no cache.
    pub fn fetch_pose(&self) {
        let (frame, _) = self.frame_at(self.position);
        self.frames.fetch(frame);
    }

    /// The same for what a [`step`](Self::step) reads that stays within a step.
    pub fn fetch_place(&self) {
        let (frame, _) = self.frame_at(self.position);
        self.frames.fetch_place(frame);
    }

    /// Writes how it is posed in its own space.
    pub fn pose(&self, out: &mut CrowdPose) {
        if let (Some(life), Some(rest)) = (&self.life, &self.rest)
            && self.is_standing()
            && rest.pose(&life.moment, out)
        {
            return;
        }
        let (frame, weight) = self.frame_at(self.position);
        self.frames.blend(frame, weight, out);
    }

    /// Lets time pass for someone who stands, or has just begun to walk.
    fn live(&mut self, dt_secs: f32, workshop: &mut Workshop) {
        let stands = self.is_standing();
        let Some(life) = &mut self.life else { return };
        life.step(dt_secs, stands);
        if let Some(rest) = self.rest.as_mut().filter(|_| stands && !life.is_still()) {
            let skeleton = &self.styled.0.skeleton;
            rest.reach(life, self.detail, skeleton, &mut workshop.rest);
        }
    }

    /// Works out the next step; a led one is another walker's.
    fn next_step(&mut self, controls: Controls, led: Option<&LedStep>, workshop: &mut Workshop) {
        let end = self.end();
        let styled = Arc::clone(&self.styled.0);
        let worn = &styled.worn;
        let ask = Ask::after(&self.shape, controls, worn.fastest_mps(), self.detail);
        let leading = self.shape.timing.leading;
        let (request, gait) = worn.request(&ask, self.blend.gait, &mut self.velocity_mps);
        let blend = worn.dress(gait);
        let mut origin = Origin {
            request,
            ..(*self.next).clone()
        };
        if let (Some(feet), Some(last)) = (&origin.planter, self.frames.places.last()) {
            // Where repeated steps have brought it.
            origin.planter = Some(feet.moved(&last.place, &end));
        }
        let Workshop {
            planner,
            walker,
            bench,
            ..
        } = &mut *workshop;
        let model = &self.blend.model;
        planner.become_walker(
            model,
            self.config.seed,
            variation(&self.config),
            self.walker,
        );
        planner.resume(self.chance_position, &*self.draws);
        planner.count_strides(self.strides);
        let mut draws = (*self.draws).clone();
        draws.rotate_left(1);
        match led {
            Some(led) if led.number != self.number().wrapping_add(1) => {
                self.redraw(led.number, planner, &mut draws);
            }
            _ => draws[WINDOW - 1] = planner.draw(leading),
        }
        let blends = [&self.blend, blend];
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
        let done = core::mem::take(&mut self.frames);
        let before = self.before.take();
        self.frames = before.map_or_else(CrowdFrames::default, |before| before.frames);
        self.before = Some(Before {
            frames: done,
            shape: self.shape,
            landing: self.landing,
        });
        self.base = Base::default();
        self.blend = Arc::clone(blend);
        (*self.draws).clone_from(walker.draws());
        *self.next = walker.next_origin(request);
        self.shape = *walker.step();
        self.take_over(workshop);
        self.landing = self.landing_of_step();
        self.footstep = self.footstep_at(self.landing);
    }

    /// Keeps the step that was just worked out.
    fn take_over(&mut self, workshop: &mut Workshop) {
        self.chance_position = workshop.planner.chance_position();
        self.strides = workshop.planner.strides();
        self.arrival = workshop.walker.stage().arrival;
        let timing = self.shape.ground_timing();
        let stage = &workshop.walker.stage().frames[..=timing.frames];
        let RestBench {
            planted,
            pose,
            model_pose,
        } = &mut workshop.rest;
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
        self.frames
            .set(shown, &self.styled.0.skeleton, pose, model_pose);
    }

    /// The frame before a time of the step, and the weight of the one after it.
    fn frame_at(&self, position: f32) -> (usize, f32) {
        let position = position / self.shape.detail.stride() as f32;
        let frame = (position.floor() as usize).min(self.frames.len() - 2);
        (frame, position - frame as f32)
    }

    fn plan_from_character(&self) -> GroundTransform {
        let (frame, weight) = self.frame_at(self.position);
        let share = (self.position / self.shape.timing.frames as f32).min(1.0);
        let [from, to] = [frame, frame + 1].map(|frame| self.frames.places[frame].place);
        self.base.at(
            &GroundTransform {
                position: from.position.lerp(to.position, weight),
                heading: from.heading + weight * (to.heading - from.heading),
            },
            share,
        )
    }

    /// Place at which the current step ends.
    fn end(&self) -> GroundTransform {
        let last = self.frames.places.last();
        self.base
            .at(&last.map(|last| last.place).unwrap_or_default(), 1.0)
    }
}

fn variation(config: &GeneratorConfig) -> f64 {
    f64::from(config.variation.clamp(0.0, 2.0))
}
