//! Steps of a hidden semi-Markov model in a mixture of styles.

use crate::detail::Detail;
use crate::error::SynthError;
use crate::generator::{GeneratorConfig, STANDING_SPEED_MPS};
use crate::pace::PaceTable;
use crate::plan::{Manner, Planner, StepShape};
use crate::space::{Blend, StyleSpace};
use crate::stage::Stage;
use crate::standing::Amplitude;
use crate::steps::{Ask, StepSource, Stretches};
use crate::strafe::pelvis_turn;
use crate::walker::{Request, Walker};
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_model::GaitModel;
use glam::Vec2;
use std::sync::Arc;

/// A planner and a walker in a mixture of styles.
#[derive(Debug)]
pub(crate) struct StyledSteps {
    pub(crate) space: Arc<StyleSpace>,
    pub(crate) planner: Planner,
    pub(crate) walker: Walker,
    /// What the next step wears.
    pub(crate) worn: Worn,
    /// A mixture that the next step lets go of, kept so that it is not freed there.
    retired: Option<Arc<Blend>>,
    /// Velocity of the current step, as its request has it.
    pub(crate) velocity_mps: Vec2,
}

/// A mixture of styles and how fast it walks on this body.
#[derive(Debug)]
pub(crate) struct Worn {
    pub(crate) blend: Arc<Blend>,
    pub(crate) paces: PaceTable,
}

impl Worn {
    /// What the next step has to be, which `side` begins, after one at this place in the walk. `velocity_mps` is the walk's
    /// and follows.
    pub(crate) fn request(
        &self,
        ask: &Ask,
        model: &GaitModel,
        before: StepPosition,
        side: Side,
        velocity_mps: &mut Vec2,
    ) -> Request {
        let amplitude = ask.amplitude;
        let stops = amplitude.to < 1.0;
        let position = position_after(before, amplitude);
        if model.context(position, side).is_some() {
            // The model knows how this step gets to the speed of the walk or away from it.
            if !stops {
                *velocity_mps = ask.velocity_mps;
            }
        } else {
            *velocity_mps = ask.velocity_after(*velocity_mps);
        }
        Request {
            manner: Manner {
                pace: self.paces.pace_towards(*velocity_mps),
                position,
                detail: ask.detail,
            },
            amplitude,
            turn_rate: ask.turn_rate,
            velocity_mps: *velocity_mps,
            facing: self.paces.facing + pelvis_turn(*velocity_mps),
        }
    }

    /// A walk under way at the speed that suits it.
    pub(crate) fn first_request(&self, detail: Detail) -> Request {
        let speed = self.blend.model.speed.reference_mps;
        Request {
            manner: Manner {
                detail,
                ..Manner::inside(self.paces.pace(speed))
            },
            amplitude: Amplitude::WALK,
            turn_rate: 0.0,
            velocity_mps: speed as f32 * Vec2::Y,
            facing: self.paces.facing,
        }
    }

    /// Someone who stands.
    pub(crate) fn standing_request(&self, detail: Detail) -> Request {
        Request {
            manner: Manner {
                detail,
                ..Manner::inside(self.paces.pace(f64::from(STANDING_SPEED_MPS)))
            },
            amplitude: Amplitude::STAND,
            velocity_mps: Vec2::ZERO,
            ..self.first_request(detail)
        }
    }
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
            let paces = PaceTable::measure(&planner, skeleton, &blend, bench)?;
            let worn = Worn { blend, paces };
            let request = worn.first_request(Detail::Full);
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
        })
    }

    /// What the walker was restored to.
    pub(crate) fn resumed(
        space: &Arc<StyleSpace>,
        planner: Planner,
        walker: Walker,
        worn: Worn,
        velocity_mps: Vec2,
    ) -> Self {
        Self {
            space: Arc::clone(space),
            planner,
            walker,
            worn,
            retired: None,
            velocity_mps,
        }
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
            .at_bench(|bench| PaceTable::measure(&self.planner, skeleton, &blend, bench));
        if let Ok(paces) = measured {
            self.retired = Some(Arc::clone(self.walker.blends()[0]));
            self.worn = Worn { blend, paces };
        }
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

    fn stand(&mut self, detail: Detail) -> bool {
        let first = self.walker.step().timing.leading;
        let request = self.worn.standing_request(detail);
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
        }
        started
    }

    fn advance(&mut self, ask: &Ask) {
        let before = self.walker.origin().request.manner.position;
        let side = self.walker.step().timing.leading.other();
        let model = self.space.model();
        let request = self
            .worn
            .request(ask, model, before, side, &mut self.velocity_mps);
        let draw = self.planner.draw(self.walker.step().timing.leading);
        self.planner.wear(&self.worn.blend.model);
        let Self {
            planner,
            walker,
            worn,
            ..
        } = self;
        self.space
            .at_bench(|bench| walker.advance(planner, &worn.blend, draw, request, bench));
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
    }
}

/// The walker that a seed draws.
pub(crate) fn walker_of(space: &StyleSpace, config: &GeneratorConfig) -> Planner {
    let variation = f64::from(config.variation.clamp(0.0, 2.0));
    Planner::new(space.model(), config.seed, variation)
}

/// The place of a step in its walk. That a step is the last but one is known only when it is over.
fn position_after(before: StepPosition, amplitude: Amplitude) -> StepPosition {
    match (amplitude.from < 1.0, amplitude.to < 1.0) {
        (true, false) => StepPosition::First,
        (false, true) => StepPosition::Last,
        (false, false) if before == StepPosition::First => StepPosition::Second,
        _ => StepPosition::Inside,
    }
}
