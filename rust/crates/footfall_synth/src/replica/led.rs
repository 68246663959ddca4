//! Walks whose steps are another walker's: which step comes next, what it obeys and where it ends.

use super::update::Planned;
use crate::config::GeneratorConfig;
use crate::controls::{Controls, GaitChoice};
use crate::gait::{Amplitude, AppliedControls, Gait, StepControls};
use crate::generator::GaitGenerator;
use crate::ground::Displacement;
use crate::plan::StepDraw;
use crate::source::{Aim, StepSource as _, Steps, StyledSteps, planner_of};
use footfall_core::{GroundTransform, Side};
use std::sync::Arc;

/// A walk in the middle of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    pub(super) number: u16,
    /// Share of the step that has passed.
    pub(super) share: f32,
    pub(super) controls: Controls,
    pub(super) rests: bool,
}

impl StyledSteps {
    /// Number of the current step: even ones begin with the left foot's contact. It wraps.
    pub(super) fn number(&self) -> u16 {
        let strides = self.planner.strides() as u16;
        let right = self.window.step().timing.leading == Side::Right;
        strides.wrapping_mul(2).wrapping_sub(u16::from(right))
    }

    /// Share of the current step that had passed when it was planned last.
    pub(super) fn passed(&self) -> f32 {
        self.window
            .origin()
            .remainder
            .map_or(0.0, |rest| rest.passed)
    }

    /// Takes chance to where it draws the step of this number; returns that.
    fn draw_of(&mut self, config: &GeneratorConfig, number: u16) -> StepDraw {
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

    /// Starts over in the step of this number; whether it could.
    fn begin(
        &mut self,
        config: &GeneratorConfig,
        at: &Beginning,
        step_controls: &StepControls,
    ) -> bool {
        let before = self.draw_of(config, at.number.wrapping_sub(1));
        let (first, next) = (before.side.other(), before.side);
        let draws = [before, self.planner.draw(first), self.planner.draw(next)];
        self.velocity_mps = step_controls.velocity_mps;
        let gait = match step_controls.gait {
            GaitChoice::Run => Gait::Run,
            GaitChoice::Auto | GaitChoice::Walk => Gait::Walk,
        };
        let (request, gait) = if at.rests {
            (
                self.measured.chooser.standing_request(step_controls.detail),
                Gait::Walk,
            )
        } else {
            self.measured
                .chooser
                .request(step_controls, gait, &mut self.velocity_mps)
        };
        self.applied = if at.rests {
            AppliedControls::default()
        } else {
            AppliedControls::of(step_controls)
        };
        let blend = self.measured.blend_of(gait);
        self.planner.set_model(&blend.model);
        let (planner, window) = (&mut self.planner, &mut self.window);
        self.space
            .with_buffers(|buffers| window.start(planner, blend, draws, request, buffers))
            .is_ok()
    }
}

impl GaitGenerator {
    fn styled_mut(&mut self) -> Option<&mut StyledSteps> {
        match &mut self.steps {
            Steps::Styled(steps) => Some(steps),
            Steps::Switching(_) => None,
        }
    }

    /// The current step, and the share of it that has passed.
    pub(super) fn progress(&self) -> (u16, f32) {
        let Steps::Styled(steps) = &self.steps else {
            return (0, 0.0);
        };
        let passed = steps.passed();
        (
            steps.number(),
            passed + (1.0 - passed) * self.share_of_step(),
        )
    }

    /// Place where the current step leads, from where the walk began: that of the foot that lands, under the walker's heading. That of a walker who rests is
    /// where it stands.
    pub(super) fn start_from_aim(&self, rests: bool) -> GroundTransform {
        let source = self.steps.source();
        source
            .planted()
            .aim(&self.plan_from_start, self.shape(), rests)
    }

    /// Starts over at the origin, in the middle of a step; whether it could.
    pub(super) fn begin_led(&mut self, at: &Beginning) -> bool {
        let (config, detail) = (self.config, self.detail);
        let fastest = self.steps.source().fastest_mps();
        let step_controls = StepControls {
            amplitude: Amplitude::WALK,
            ..StepControls::after(self.shape().amplitude, at.controls, fastest, detail)
        };
        let begun = self
            .styled_mut()
            .is_some_and(|steps| steps.begin(&config, at, &step_controls));
        if begun {
            let frames = self.shape().timing.frames as f32;
            let share = if at.rests {
                1.0
            } else {
                at.share.clamp(0.0, 0.95)
            };
            self.position = share * frames;
            self.plan_from_start = self.plan_from_character();
            self.answered = None;
            if let (true, Some(life)) = (at.rests, &mut self.life) {
                life.stand();
            }
        }
        begun
    }

    /// Goes on to the step of this number.
    pub(super) fn next_led(&mut self, number: u16, controls: &Controls, rise_m: f32) {
        let config = self.config;
        if let Some(steps) = self.styled_mut()
            && steps.number().wrapping_add(1) != number
        {
            let draw = steps.draw_of(&config, number);
            steps.window.redraw_next(draw);
        }
        if rise_m > 0.0 {
            self.jump(rise_m);
        }
        self.next_step(controls);
        // A leap that this step is not is none at all.
        self.pending_jump = None;
    }

    /// Plans the current step anew where its sender did, or later if it must be; whether it did. `before` is where the walk was in the frame before.
    pub(super) fn replan_led(
        &mut self,
        planned: Planned,
        controls: &Controls,
        (before, must): (f32, bool),
    ) -> bool {
        let frames = self.shape().timing.frames as f32;
        let (position, detail) = (self.position, self.detail);
        let fastest = self.steps.source().fastest_mps();
        let step_controls = StepControls::after(self.shape().amplitude, *controls, fastest, detail);
        let Some(steps) = self.styled_mut() else {
            return false;
        };
        let passed = steps.passed();
        let wanted = ((planned.share() - passed) / (1.0 - passed) * frames).round();
        // What was shown stays as it was.
        let in_time = wanted > before && wanted <= position;
        let frame = if in_time { wanted } else { position.floor() };
        let needed = in_time || must || steps.needs_replan(&step_controls);
        let possible = steps.gait() == Gait::Walk && frame > 0.0;
        let replanned = needed && possible && steps.replan_from(&step_controls, frame as usize);
        if replanned {
            self.position -= frame;
        }
        replanned
    }

    /// Way and turn from where the current step leads to where it should, seen from the start of the walk.
    pub(super) fn off(&self, aim: &Aim) -> Displacement {
        aim.off(&self.start_from_aim(aim.rests))
    }

    /// Has the current step, which has just been planned, lead where it should, as far as one step can.
    pub(super) fn aim_at(&mut self, aim: &Aim) {
        let plan_from_start = self.plan_from_start;
        if let Some(steps) = self.styled_mut() {
            let (space, window) = (Arc::clone(&steps.space), &mut steps.window);
            space.with_buffers(|buffers| window.aim_at(aim, &plan_from_start, buffers));
        }
    }

    /// Frames of the current step since it was at this share.
    pub(super) fn frames_since(&self, share: f32) -> f32 {
        let Steps::Styled(steps) = &self.steps else {
            return self.position;
        };
        let whole = self.shape().timing.frames as f32 / (1.0 - steps.passed());
        self.position + (steps.passed() - share) * whole
    }

    /// Shows the walk after time has passed at another pace.
    pub(super) fn pass_led(&mut self, frames: f32) {
        self.position += frames;
    }

    /// Returns true when the current step is over.
    pub(super) fn has_ended(&self) -> bool {
        self.position >= self.shape().timing.frames as f32
    }

    /// Leaves a step that is over; what is beyond it belongs to the next one.
    pub(super) fn leave_step(&mut self) {
        self.position -= self.shape().timing.frames as f32;
    }

    /// Rests at the end of the step.
    pub(super) fn rest_led(&mut self) {
        self.position = self.shape().timing.frames as f32;
    }

    /// Returns true when the current step ends standing.
    pub(super) fn comes_to_rest(&self) -> bool {
        self.shape().amplitude.to < 1.0
    }

    /// Frames until the current step is over.
    pub(super) fn frames_left(&self) -> f32 {
        self.shape().timing.frames as f32 - self.position
    }
}
