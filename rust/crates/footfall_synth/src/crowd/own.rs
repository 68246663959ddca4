//! Own steps of a crowd's walker, the same as those of a generator of its seed, in a few kilobytes.

use super::ending::{Chance, Ending, variation};
use super::frames::{CrowdFrames, CrowdPose};
use super::led_step::LedStep;
use super::rest::Rest;
use super::styled_body::StyledBody;
use super::tools::StepTools;
use crate::config::{GeneratorConfig, check};
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::ground::Arrival;
use crate::plan::{MAX_COMPONENTS, Planner, StepShape};
use crate::standing::Life;
use footfall_core::{GroundTransform, Side};
use footfall_ik::Plant;
use std::sync::Arc;

/// Walk of one walker in own steps.
#[derive(Debug)]
pub(super) struct OwnWalk {
    pub(super) config: GeneratorConfig,
    pub(super) styled: StyledBody,
    /// Identity of the walker: weights of the model's walker components.
    pub(super) walker: [f64; MAX_COMPONENTS],
    pub(super) chance: Chance,
    /// Boxed, because most frames do not need it.
    pub(super) ending: Box<Ending>,
    pub(super) shape: StepShape,
    pub(super) detail: Detail,
    /// Frames since the step began.
    pub(super) position: f32,
    pub(super) frame_rate_hz: f32,
    pub(super) frames: CrowdFrames,
    /// Plant of the foot whose landing began the step.
    pub(super) landing: Option<Plant>,
    pub(super) plan_from_start: GroundTransform,
    pub(super) footstep: Option<Footstep>,
    /// Standing motion; `None` if the model stands still.
    pub(super) life: Option<Life>,
    /// Resting state; `None` before the first stop.
    pub(super) rest: Option<Box<Rest>>,
    /// True when all steps are mean ones, without chance.
    pub(super) even: bool,
}

impl OwnWalk {
    /// Creates a walk at the origin, facing +Z, at the usual speed or standing.
    ///
    /// # Errors
    /// [`SynthError`] when a setting is not finite or the model gives no trajectory.
    pub(super) fn new(
        styled: &StyledBody,
        config: &GeneratorConfig,
        standing: bool,
        tools: &mut StepTools,
    ) -> Result<Self, SynthError> {
        let first = check(&styled.0.skeleton, config)?;
        let measured = &styled.0.measured;
        let StepTools {
            planner,
            window,
            buffers,
            ..
        } = &mut *tools;
        *planner = Planner::new(&measured.blend.model, config.seed, variation(config));
        let request = if standing {
            measured.chooser.standing_request(Detail::Full)
        } else {
            measured.chooser.walking_request(Detail::Full)
        };
        let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
        window.start(planner, &measured.blend, draws, request, buffers)?;
        let ending = Ending {
            blend: Arc::clone(&measured.blend),
            draws: window.draws().clone(),
            next: window.next_origin(request),
            velocity_mps: request.velocity_mps,
            arrival: Arrival::default(),
        };
        let mut made = Self {
            life: Life::new(styled.0.space.standing(), &styled.0.skeleton, config),
            ..Self::before(styled, config, *planner.walker(), (ending, *window.step()))
        };
        if let Some(life) = made.life.as_mut().filter(|_| standing) {
            life.stand();
        }
        let share = if standing {
            1.0
        } else {
            (2.0 * config.phase.rem_euclid(1.0)).fract()
        };
        made.settle(share, tools);
        Ok(made)
    }

    /// Makes a walk whose first step, of this shape and ending, is not kept yet.
    pub(super) fn before(
        styled: &StyledBody,
        config: &GeneratorConfig,
        walker: [f64; MAX_COMPONENTS],
        (ending, shape): (Ending, StepShape),
    ) -> Self {
        Self {
            config: *config,
            styled: styled.clone(),
            walker,
            chance: Chance::default(),
            ending: Box::new(ending),
            shape,
            detail: Detail::Full,
            position: 0.0,
            frame_rate_hz: styled.0.space.model().frame_rate_hz as f32,
            frames: CrowdFrames::default(),
            landing: None,
            plan_from_start: GroundTransform::default(),
            footstep: None,
            life: None,
            rest: None,
            even: false,
        }
    }

    /// Keeps the first step and begins in the middle of it.
    pub(super) fn settle(&mut self, share: f32, tools: &mut StepTools) {
        self.take_over(tools);
        self.position = share * self.shape.timing.frames as f32;
        self.landing = self.landing_of_step();
        self.plan_from_start = self.plan_from_character();
        self.live(0.0, tools);
    }

    /// Advances by `dt_secs`. Allocates only for a step longer than all previous ones and for the first rest. If `ends` is true, the walk stays at the end of the current step,
    /// and the remaining time is returned, seconds.
    pub(super) fn step(
        &mut self,
        dt_secs: f32,
        controls: Controls,
        ends: bool,
        tools: &mut StepTools,
    ) -> Option<f32> {
        let mut rested = self.is_over();
        self.pass(dt_secs);
        let mut left = None;
        while self.is_over() {
            self.end_step(&mut rested);
            if ends {
                left = Some(self.stay());
                break;
            }
            if self.comes_to_rest() && controls.is_standing() {
                self.stay();
                break;
            }
            self.go_on(controls, None, tools);
        }
        if dt_secs > 0.0 {
            self.live(dt_secs, tools);
        }
        left
    }

    /// Advances in its step, possibly beyond the end.
    pub(super) fn pass(&mut self, dt_secs: f32) {
        self.footstep = None;
        if dt_secs > 0.0 {
            self.position += dt_secs * self.frame_rate_hz;
        }
    }

    /// Returns true when its step has ended.
    pub(super) fn is_over(&self) -> bool {
        self.position >= self.shape.timing.frames as f32
    }

    /// Stays at the end of its step; returns the time that has passed since, seconds.
    pub(super) fn stay(&mut self) -> f32 {
        let frames = self.shape.timing.frames as f32;
        let left = (self.position - frames) / self.frame_rate_hz;
        self.position = frames;
        left
    }

    /// Reports the contact of the foot that comes to rest where a step has just ended standing, and not if the walker already `rested`.
    pub(super) fn end_step(&mut self, rested: &mut bool) {
        if self.comes_to_rest() && !*rested {
            self.footstep = self.closing_footstep();
            if let (Some(life), Some(ended)) = (&mut self.life, &self.ending.next.planter) {
                life.come_to_rest(ended);
            }
        }
        *rested = false;
    }

    /// Continues with the next step after the end of one; a led step repeats another walker's.
    pub(super) fn go_on(
        &mut self,
        controls: Controls,
        led: Option<&LedStep>,
        tools: &mut StepTools,
    ) {
        self.position -= self.shape.timing.frames as f32;
        self.next_step(controls, led, tools);
    }

    /// Returns the time until the next step begins, seconds; 0 for a resting walker.
    pub(super) fn secs_to_next_step(&self) -> f32 {
        (self.shape.timing.frames as f32 - self.position).max(0.0) / self.frame_rate_hz
    }

    /// Returns the time since the current step began, seconds; for a resting walker its duration.
    pub(super) fn secs_of_step(&self) -> f32 {
        self.position / self.frame_rate_hz
    }

    /// Returns true when the walker has stopped and rests.
    pub(super) fn is_standing(&self) -> bool {
        self.comes_to_rest() && self.is_over()
    }

    /// Returns true when its step ends standing.
    pub(super) fn comes_to_rest(&self) -> bool {
        self.shape.amplitude.to < 1.0
    }

    /// Returns the phase of the stride: 0 at the left foot's landing, 0.5 at the right one's.
    pub(super) fn phase(&self) -> f32 {
        let share = (self.position / self.shape.timing.frames as f32).min(1.0);
        let half = self.shape.timing.leading.index() as f32;
        (0.5 * (half + share)).fract()
    }

    /// Prefetches the memory that [`pose`](Self::pose) reads.
    pub(super) fn fetch_pose(&self) {
        let (frame, _) = self.frame_at(self.position);
        self.frames.fetch(frame);
    }

    /// Prefetches the memory that a [`step`](Self::step) without a new step reads.
    pub(super) fn fetch_place(&self) {
        let (frame, _) = self.frame_at(self.position);
        self.frames.fetch_place(frame);
    }

    /// Writes the pose in the character's own space.
    pub(super) fn pose(&self, out: &mut CrowdPose) {
        if let (Some(life), Some(rest)) = (&self.life, &self.rest)
            && self.is_standing()
            && rest.pose(&life.moment, out)
        {
            return;
        }
        let (frame, weight) = self.frame_at(self.position);
        self.frames.blend(frame, weight, out);
    }

    /// Advances the standing motion of a walker that stands, or has just begun to walk.
    pub(super) fn live(&mut self, dt_secs: f32, tools: &mut StepTools) {
        let stands = self.is_standing();
        let Some(life) = &mut self.life else { return };
        life.step(dt_secs, stands);
        if let Some(rest) = self.rest.as_mut().filter(|_| stands && !life.is_still()) {
            let skeleton = &self.styled.0.skeleton;
            rest.reach(life, self.detail, skeleton, &mut tools.rest);
        }
    }

    /// Returns the frame before a time of the step, and the weight of the next one.
    pub(super) fn frame_at(&self, position: f32) -> (usize, f32) {
        // A power of two, except for shared steps.
        let each = self.shape.timing.frames as f32 / (self.frames.len() - 1) as f32;
        let position = position / each;
        let frame = (position.floor() as usize).min(self.frames.len() - 2);
        (frame, position - frame as f32)
    }

    /// Returns the foot that began the step.
    pub(super) fn side(&self) -> Side {
        self.shape.timing.leading
    }

    /// Returns the speed at the end of the step, m/s; `None` for one that ends standing.
    pub(super) fn speed_mps(&self) -> Option<f32> {
        let walks = self.shape.amplitude.to >= 1.0;
        walks.then(|| self.ending.velocity_mps.length())
    }

    /// Returns the place and heading of the character relative to its start.
    pub(super) fn start_from_character(&self) -> GroundTransform {
        self.plan_from_start.local(&self.plan_from_character())
    }

    pub(super) fn plan_from_character(&self) -> GroundTransform {
        self.place_at(self.position)
    }

    /// Returns the place in the plan this many frames after the step began.
    pub(super) fn place_at(&self, position: f32) -> GroundTransform {
        let (frame, weight) = self.frame_at(position);
        let [from, to] = [frame, frame + 1].map(|frame| self.frames.places[frame].place);
        GroundTransform {
            position: from.position.lerp(to.position, weight),
            heading: from.heading + weight * (to.heading - from.heading),
        }
    }
}
