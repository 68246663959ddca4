//! Steps of a hidden semi-Markov model in a mixture of styles.

use crate::detail::Detail;
use crate::error::SynthError;
use crate::generator::{GeneratorConfig, STANDING_SPEED_MPS};
use crate::pace::PaceTable;
use crate::plan::{Manner, Planner, StepShape};
use crate::space::{Blend, StyleSpace};
use crate::stage::Stage;
use crate::standing::Amplitude;
use crate::steps::{Ask, StepSource};
use crate::walker::{Request, Walker};
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_model::GaitModel;
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
    /// Speed of the current step.
    pub(crate) speed_mps: f32,
}

/// A mixture of styles and how fast it walks on this body.
#[derive(Debug)]
pub(crate) struct Worn {
    pub(crate) blend: Arc<Blend>,
    pub(crate) paces: PaceTable,
}

impl Worn {
    /// What the next step has to be, which `side` begins, after one at this place in the walk. `speed_mps` is the walk's and
    /// follows.
    pub(crate) fn request(
        &self,
        ask: &Ask,
        model: &GaitModel,
        before: StepPosition,
        side: Side,
        speed_mps: &mut f32,
    ) -> Request {
        let amplitude = ask.amplitude;
        let stops = amplitude.to < 1.0;
        let position = position_after(before, amplitude);
        if model.context(position, side).is_some() {
            // The model knows how this step gets to the speed of the walk or away from it.
            if !stops {
                *speed_mps = ask.speed_mps;
            }
        } else {
            *speed_mps = ask.speed_after(*speed_mps);
        }
        Request {
            manner: Manner {
                pace: self.paces.pace(f64::from(*speed_mps)),
                position,
                detail: ask.detail,
            },
            amplitude,
            turn_rate: ask.turn_rate,
            facing: self.paces.facing,
        }
    }

    /// A walk under way at the speed that suits it.
    pub(crate) fn first_request(&self, detail: Detail) -> Request {
        Request {
            manner: Manner {
                detail,
                ..Manner::inside(self.paces.pace(self.blend.model.speed.reference_mps))
            },
            amplitude: Amplitude::WALK,
            turn_rate: 0.0,
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
        let paces = PaceTable::measure(&planner, skeleton, &blend)?;
        let mut walker = Walker::new(skeleton, &blend);
        let speed = blend.model.speed.reference_mps;
        let worn = Worn { blend, paces };
        let request = worn.first_request(Detail::Full);
        let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
        walker.start(&mut planner, &worn.blend, draws, request)?;
        Ok(Self {
            space: Arc::clone(space),
            planner,
            walker,
            worn,
            retired: None,
            speed_mps: speed as f32,
        })
    }

    /// What the walker was restored to.
    pub(crate) fn resumed(
        space: &Arc<StyleSpace>,
        planner: Planner,
        walker: Walker,
        worn: Worn,
        speed_mps: f32,
    ) -> Self {
        Self {
            space: Arc::clone(space),
            planner,
            walker,
            worn,
            retired: None,
            speed_mps,
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
        if let Ok(paces) = PaceTable::measure(&self.planner, skeleton, &blend) {
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
        let started = self.walker.start(planner, blend, draws, request).is_ok();
        if started {
            self.speed_mps = 0.0;
        }
        started
    }

    fn advance(&mut self, ask: &Ask) {
        let before = self.walker.origin().request.manner.position;
        let side = self.walker.step().timing.leading.other();
        let model = self.space.model();
        let request = self
            .worn
            .request(ask, model, before, side, &mut self.speed_mps);
        let draw = self.planner.draw(self.walker.step().timing.leading);
        self.planner.wear(&self.worn.blend.model);
        self.walker
            .advance(&mut self.planner, &self.worn.blend, draw, request);
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
