//! Resources that the walkers of a crowd share: styles on a body, and the buffers in which steps are worked out.

use super::rest::RestBench;
use crate::error::SynthError;
use crate::plan::Planner;
use crate::space::StyleSpace;
use crate::walker::Walker;
use crate::workbench::Workbench;
use crate::worn::Worn;
use footfall_core::Skeleton;
use std::sync::Arc;

/// A mixture of styles on a body, measured once for all walkers of a crowd that share it.
#[derive(Clone, Debug)]
pub struct StyledBody(pub(super) Arc<Styled>);

/// The parts of a [`StyledBody`].
#[derive(Debug)]
pub(super) struct Styled {
    pub(super) space: Arc<StyleSpace>,
    pub(super) skeleton: Skeleton,
    pub(super) worn: Worn,
}

impl StyledBody {
    /// Mixes the space's styles, weights as of [`GaitGenerator::set_style_weights`](crate::GaitGenerator::set_style_weights), and
    /// measures how fast they walk on this body: about two milliseconds.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used.
    pub fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
    ) -> Result<Self, SynthError> {
        skeleton.check()?;
        let blend = space.blend(style_weights);
        let average = Planner::new(&blend.model, 0, 0.0);
        let worn = space.at_bench(|bench| Worn::measure(&average, skeleton, blend, bench))?;
        Ok(Self(Arc::new(Styled {
            space: Arc::clone(space),
            skeleton: skeleton.clone(),
            worn,
        })))
    }

    /// The body.
    pub fn skeleton(&self) -> &Skeleton {
        &self.0.skeleton
    }

    /// The speed that suits it best, m/s.
    pub fn usual_speed_mps(&self) -> f32 {
        self.0.worn.blend.model.speed.reference_mps as f32
    }
}

/// Working memory for steps, for walkers of one model on one body; one a thread.
#[derive(Debug)]
pub struct Workshop {
    pub(super) planner: Planner,
    pub(super) walker: Walker,
    pub(super) bench: Workbench,
    pub(super) rest: RestBench,
}

impl Workshop {
    /// For walkers like this one.
    pub fn new(styled: &StyledBody) -> Self {
        let blend = &styled.0.worn.blend;
        Self {
            planner: Planner::new(&blend.model, 0, 0.0),
            walker: Walker::new(&styled.0.skeleton, blend),
            bench: Workbench::new(&blend.model),
            rest: RestBench::new(Planner::longest_step(&blend.model)),
        }
    }
}
