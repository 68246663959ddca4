//! Led walks: steps with the numbers, controls and ends of another walker's.

use super::queue::Planning;
use crate::config::GeneratorConfig;
use crate::controls::{Controls, GaitChoice};
use crate::gait::{Amplitude, AppliedControls, Gait, StepControls};
use crate::generator::GaitGenerator;
use crate::ground::Displacement;
use crate::plan::Deadline;
use crate::source::{Aim, StepSource as _, Steps, StyledSteps};

/// Moment of a walk at which to begin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    pub(super) number: u16,
    /// Share of the step that has passed.
    pub(super) share: f32,
    pub(super) controls: Controls,
    pub(super) rests: bool,
}

impl StyledSteps {
    /// Returns the share of the current step that had passed when it was last planned.
    pub(super) fn passed(&self) -> f32 {
        self.window
            .origin()
            .remainder
            .map_or(0.0, |rest| rest.passed)
    }

    /// Restarts in the step of this number; returns true on success.
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

    /// Returns the number of the current step, and the share of it that has passed.
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

    /// Restarts at the origin, in the middle of a step; returns true on success.
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

    /// Generates the step of this number, in the sender's way where its planning is known.
    pub(super) fn next_led(
        &mut self,
        number: u16,
        controls: &Controls,
        as_planned: Option<&Planning>,
    ) {
        let config = self.config;
        if let Some(steps) = self.styled_mut() {
            steps.go_on_with(&config, number);
        }
        let rise_m = as_planned.map_or(0.0, |planning| planning.rise_m);
        if rise_m > 0.0 {
            self.jump(rise_m);
        }
        self.next_step(controls, as_planned.map(|planning| planning.brakes));
        // A jump that is not this step's leap is dropped.
        self.pending_jump = None;
    }

    /// Replans the current step at the sender's frame, or later if necessary; returns true if it did. `before` is the position in the previous frame.
    pub(super) fn replan_led(
        &mut self,
        as_planned: &Planning,
        (before, must): (f32, bool),
    ) -> bool {
        let frames = self.shape().timing.frames as f32;
        let (position, detail) = (self.position, self.detail);
        let fastest = self.steps.source().fastest_mps();
        let step_controls = StepControls {
            brakes: Some(as_planned.brakes),
            ..StepControls::after(self.shape().amplitude, as_planned.controls, fastest, detail)
        };
        let Some(steps) = self.styled_mut() else {
            return false;
        };
        let passed = steps.passed();
        let wanted = ((as_planned.planned.share() - passed) / (1.0 - passed) * frames).round();
        // Frames already shown stay.
        let in_time = wanted > before && wanted <= position;
        let frame = if in_time { wanted } else { position.floor() };
        let needed = in_time || must || steps.needs_replan(&step_controls);
        let replanned = needed
            && frame > 0.0
            && steps.replan_from(&step_controls, frame as usize, Deadline::LED);
        if replanned {
            self.position -= frame;
        }
        replanned
    }

    /// Returns the displacement from the end of the current step to its aim, relative to the start of the walk.
    pub(super) fn off(&self, aim: &Aim) -> Displacement {
        aim.off(&self.start_from_aim(aim.rests))
    }

    /// Returns the frames of the current step since this share of it.
    pub(super) fn frames_since(&self, share: f32) -> f32 {
        let Steps::Styled(steps) = &self.steps else {
            return self.position;
        };
        let whole = self.shape().timing.frames as f32 / (1.0 - steps.passed());
        self.position + (steps.passed() - share) * whole
    }

    /// Advances the walk by frames, at a tempo of the follower's choice.
    pub(super) fn pass_led(&mut self, frames: f32) {
        self.position += frames;
    }

    /// Returns the frames until the end of the current step.
    pub(super) fn frames_left(&self) -> f32 {
        self.shape().timing.frames as f32 - self.position
    }
}
