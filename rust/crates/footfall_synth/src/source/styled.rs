//! Steps of a hidden semi-Markov model in a mixture of styles.

use super::measured::MeasuredBlend;
use super::step_source::{StepSource, Stretches};
use super::style_space::{Blend, StyleSpace};
use super::window::StepWindow;
use crate::config::GeneratorConfig;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::gait::{AppliedControls, Gait, Passed, StepControls, StepRequest};
use crate::ground::PlantedStep;
use crate::plan::{Deadline, Planner, StepShape, WINDOW};
use footfall_core::{Side, Skeleton};
use glam::Vec2;
use std::sync::Arc;

/// Steps in a mixture of styles: a planner and a window of steps.
#[derive(Debug)]
pub(crate) struct StyledSteps {
    pub(crate) space: Arc<StyleSpace>,
    pub(crate) planner: Planner,
    pub(crate) window: StepWindow,
    /// Mixture of styles of the next step.
    pub(crate) measured: MeasuredBlend,
    /// Mixture that the next step releases, kept so that the step does not free memory.
    retired: Option<Arc<Blend>>,
    /// Requested velocity of the current step.
    pub(crate) velocity_mps: Vec2,
    /// Controls that the current step follows.
    pub(crate) applied: AppliedControls,
}

impl StyledSteps {
    /// Starts in the middle of a walk, with the initial contact of the foot `first`.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
        config: &GeneratorConfig,
        first: Side,
    ) -> Result<Self, SynthError> {
        let mut planner = planner_of(space, config);
        let blend = space.blend(style_weights);
        planner.set_model(&blend.model);
        let mut window = StepWindow::new(skeleton, &blend);
        let (measured, request) = space.with_buffers(|buffers| {
            let measured = MeasuredBlend::measure(&planner, skeleton, blend, buffers)?;
            let request = measured.chooser.walking_request(Detail::Full);
            let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
            window.start(&mut planner, &measured.blend, draws, request, buffers)?;
            Ok::<_, SynthError>((measured, request))
        })?;
        Ok(Self {
            space: Arc::clone(space),
            planner,
            window,
            measured,
            retired: None,
            velocity_mps: request.velocity_mps,
            applied: AppliedControls::default(),
        })
    }

    /// Returns the mixture of the next step.
    pub(crate) fn blend(&self) -> &Blend {
        &self.measured.blend
    }

    pub(crate) fn set_style_weights(&mut self, skeleton: &Skeleton, weights: &[f32]) {
        let current = self.measured.blend.weights.iter().copied();
        if self.space.weights(weights).eq(current) {
            return;
        }
        let blend = self.space.blend(weights);
        // A checked model gives a trajectory; if it did not, the walker would keep its style.
        let measured = self.space.with_buffers(|buffers| {
            MeasuredBlend::measure(&self.planner, skeleton, blend, buffers)
        });
        if let Ok(measured) = measured {
            self.retired = Some(Arc::clone(self.window.blends()[0]));
            self.measured = measured;
        }
    }

    /// Replans the current step from a frame on; returns true if it did.
    pub(crate) fn replan_from(
        &mut self,
        controls: &StepControls,
        frame: usize,
        deadline: Deadline,
    ) -> bool {
        // Styles may have changed since the step began.
        self.planner.set_model(&self.window.blends()[1].model);
        let (gait, measured, velocity) = (self.gait(), &self.measured, &mut self.velocity_mps);
        let request = |before: &StepRequest, passed: &Passed| {
            measured
                .chooser
                .remainder_request(controls, gait, before, passed, velocity)
        };
        let (planner, window) = (&mut self.planner, &mut self.window);
        let replanned = self
            .space
            .with_buffers(|buffers| window.replan(planner, (frame, deadline), request, buffers));
        if replanned {
            self.applied = AppliedControls::of(controls);
        }
        replanned
    }
}

impl StepSource for StyledSteps {
    fn shape(&self) -> &StepShape {
        self.window.step()
    }

    fn planted(&self) -> &PlantedStep {
        self.window.planted()
    }

    fn facing(&self) -> [f32; 2] {
        let origin = self.window.origin();
        [origin.facing_before, origin.request.facing]
    }

    fn fastest_mps(&self) -> f32 {
        self.measured.chooser.fastest_mps()
    }

    fn gait(&self) -> Gait {
        self.window.blends()[1].gait
    }

    fn stand(&mut self, detail: Detail) -> bool {
        let first = self.window.step().timing.leading;
        let request = self.measured.chooser.standing_request(detail);
        let draws = [first.other(), first, first.other()].map(|side| self.planner.draw(side));
        self.planner.set_model(&self.measured.blend.model);
        let (planner, blend) = (&mut self.planner, &self.measured.blend);
        // The model gave a trajectory when the generator was made, so it gives one now.
        let window = &mut self.window;
        let started = self.space.with_buffers(|buffers| {
            window
                .start(planner, blend, draws, request, buffers)
                .is_ok()
        });
        if started {
            self.velocity_mps = Vec2::ZERO;
            self.applied = AppliedControls::default();
        }
        started
    }

    fn advance(&mut self, controls: &StepControls) {
        self.applied = AppliedControls::of(controls);
        let gait = self.gait();
        let (request, gait) = self
            .measured
            .chooser
            .request(controls, gait, &mut self.velocity_mps);
        let next = self.window.draws()[WINDOW - 1].side;
        let draw = self.planner.draw(next.other());
        let blend = self.measured.blend_of(gait);
        self.planner.set_model(&blend.model);
        let (planner, window) = (&mut self.planner, &mut self.window);
        self.space
            .with_buffers(|buffers| window.advance(planner, blend, draw, request, buffers));
    }

    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>) {
        let haste = f64::from(haste);
        // Styles may have changed since the step began.
        self.planner.set_model(&self.window.blends()[1].model);
        let (planner, window) = (&mut self.planner, &mut self.window);
        let whole = self
            .space
            .with_buffers(|buffers| window.stretch(planner, haste, next, buffers));
        self.velocity_mps *= whole;
        self.applied.stretched = true;
    }

    fn keep(&mut self) {
        self.applied.stretched = true;
    }

    fn needs_replan(&self, controls: &StepControls) -> bool {
        !self.applied.stretched && self.applied.differs_from(controls)
    }

    fn replan(&mut self, controls: &StepControls, frame: usize) -> bool {
        if !self.needs_replan(controls) {
            return false;
        }
        self.replan_from(controls, frame, Deadline::OWN)
    }
}

/// Draws the walker of a seed.
pub(crate) fn planner_of(space: &StyleSpace, config: &GeneratorConfig) -> Planner {
    let variation = f64::from(config.variation.clamp(0.0, 2.0));
    Planner::new(space.model(), config.seed, variation)
}
