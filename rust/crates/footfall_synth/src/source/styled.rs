//! Steps of a hidden semi-Markov model in a mixture of styles.

use super::measured::Worn;
use super::step_source::{StepSource, Stretches};
use super::style_space::{Blend, StyleSpace};
use super::window::Walker;
use crate::config::GeneratorConfig;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::gait::{Ask, Gait, Obeyed, Request};
use crate::ground::Stage;
use crate::plan::{Planner, StepShape, WINDOW};
use footfall_core::{Side, Skeleton};
use glam::Vec2;
use std::sync::Arc;

/// A planner and a walker in a mixture of styles.
#[derive(Debug)]
pub(crate) struct StyledSteps {
    pub(crate) space: Arc<StyleSpace>,
    pub(crate) planner: Planner,
    pub(crate) walker: Walker,
    /// Mixture of styles of the next step.
    pub(crate) worn: Worn,
    /// A mixture that the next step lets go of, kept so that it is not freed there.
    retired: Option<Arc<Blend>>,
    /// Velocity of the current step, as its request has it.
    pub(crate) velocity_mps: Vec2,
    /// Requests that the current step was made to obey.
    pub(crate) obeyed: Obeyed,
}

impl StyledSteps {
    /// Walking already, with the initial contact of the foot `first`.
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
        let mut planner = walker_of(space, config);
        let blend = space.blend(style_weights);
        planner.wear(&blend.model);
        let mut walker = Walker::new(skeleton, &blend);
        let (worn, request) = space.at_bench(|bench| {
            let worn = Worn::measure(&planner, skeleton, blend, bench)?;
            let request = worn.chooser.first_request(Detail::Full);
            let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
            walker.start(&mut planner, &worn.blend, draws, request, bench)?;
            Ok::<_, SynthError>((worn, request))
        })?;
        Ok(Self {
            space: Arc::clone(space),
            planner,
            walker,
            worn,
            retired: None,
            velocity_mps: request.velocity_mps,
            obeyed: Obeyed::default(),
        })
    }

    /// The mixture that the next step wears.
    pub(crate) fn worn(&self) -> &Blend {
        &self.worn.blend
    }

    pub(crate) fn set_style_weights(&mut self, skeleton: &Skeleton, weights: &[f32]) {
        let worn = self.worn.blend.weights.iter().copied();
        if self.space.weights(weights).eq(worn) {
            return;
        }
        let blend = self.space.blend(weights);
        // The planner of a checked model gives a trajectory; were it not to, the walker keeps its style.
        let measured = self
            .space
            .at_bench(|bench| Worn::measure(&self.planner, skeleton, blend, bench));
        if let Ok(worn) = measured {
            self.retired = Some(Arc::clone(self.walker.blends()[0]));
            self.worn = worn;
        }
    }
    /// Has the rest of the current step, from a frame of it on, be what is asked for; whether it does.
    pub(crate) fn go_over(&mut self, ask: &Ask, frame: usize) -> bool {
        // Styles may have changed since the step began.
        self.planner.wear(&self.walker.blends()[1].model);
        let (worn, velocity) = (&self.worn, &mut self.velocity_mps);
        let request = |before: &Request, frames: f64, passed: f64| {
            worn.chooser
                .rest_request(ask, before, frames, passed, velocity)
        };
        let (planner, walker) = (&mut self.planner, &mut self.walker);
        let replanned = self
            .space
            .at_bench(|bench| walker.replan(planner, frame, request, bench));
        if replanned {
            self.obeyed = Obeyed::of(ask);
        }
        replanned
    }
}

impl StepSource for StyledSteps {
    fn shape(&self) -> &StepShape {
        self.walker.step()
    }

    fn stage(&self) -> &Stage {
        self.walker.stage()
    }

    fn facing(&self) -> [f32; 2] {
        let origin = self.walker.origin();
        [origin.facing_before, origin.request.facing]
    }

    fn fastest_mps(&self) -> f32 {
        self.worn.chooser.fastest_mps()
    }

    fn gait(&self) -> Gait {
        self.walker.blends()[1].gait
    }

    fn stand(&mut self, detail: Detail) -> bool {
        let first = self.walker.step().timing.leading;
        let request = self.worn.chooser.standing_request(detail);
        let draws = [first.other(), first, first.other()].map(|side| self.planner.draw(side));
        self.planner.wear(&self.worn.blend.model);
        let (planner, blend) = (&mut self.planner, &self.worn.blend);
        // The model gave a trajectory when the generator was made, so it gives one now.
        let walker = &mut self.walker;
        let started = self
            .space
            .at_bench(|bench| walker.start(planner, blend, draws, request, bench).is_ok());
        if started {
            self.velocity_mps = Vec2::ZERO;
            self.obeyed = Obeyed::default();
        }
        started
    }

    fn advance(&mut self, ask: &Ask) {
        self.obeyed = Obeyed::of(ask);
        let gait = self.gait();
        let (request, gait) = self.worn.chooser.request(ask, gait, &mut self.velocity_mps);
        let next = self.walker.draws()[WINDOW - 1].side;
        let draw = self.planner.draw(next.other());
        let blend = self.worn.dress(gait);
        self.planner.wear(&blend.model);
        let (planner, walker) = (&mut self.planner, &mut self.walker);
        self.space
            .at_bench(|bench| walker.advance(planner, blend, draw, request, bench));
    }

    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>) {
        let haste = f64::from(haste);
        // Styles may have changed since the step began.
        self.planner.wear(&self.walker.blends()[1].model);
        let (planner, walker) = (&mut self.planner, &mut self.walker);
        let whole = self
            .space
            .at_bench(|bench| walker.stretch(planner, haste, next, bench));
        self.velocity_mps *= whole;
        self.obeyed.stretched = true;
    }

    fn keep(&mut self) {
        self.obeyed.stretched = true;
    }

    fn is_news(&self, ask: &Ask) -> bool {
        !self.obeyed.stretched && self.obeyed.differs_from(ask) && self.gait() == Gait::Walk
    }

    fn replan(&mut self, ask: &Ask, frame: usize) -> bool {
        if !self.is_news(ask) {
            return false;
        }
        self.go_over(ask, frame)
    }
}

/// The walker that a seed draws.
pub(crate) fn walker_of(space: &StyleSpace, config: &GeneratorConfig) -> Planner {
    let variation = f64::from(config.variation.clamp(0.0, 2.0));
    Planner::new(space.model(), config.seed, variation)
}
