//! Resources that the walkers of a crowd share: styles on a body, and the workshop in which steps are generated.

use super::frames::CrowdPose;
use super::own::OwnWalk;
use super::rest::RestBuffers;
use super::shared::SharedSteps;
use crate::error::SynthError;
use crate::plan::Planner;
use crate::source::{MeasuredBlend, StepBuffers, StepWindow, StyleSpace};
use footfall_core::Skeleton;
use std::sync::{Arc, OnceLock};

/// Maximum number of unused own walks that are kept for reuse.
const SPARES: usize = 1024;

/// A mixture of styles on a body, measured once for all walkers of a crowd that share it.
#[derive(Clone, Debug)]
pub struct StyledBody(pub(super) Arc<Styled>, pub(super) u32);

/// The parts of a [`StyledBody`].
#[derive(Debug)]
pub(super) struct Styled {
    pub(super) space: Arc<StyleSpace>,
    pub(super) skeleton: Skeleton,
    pub(super) measured: MeasuredBlend,
    shared: OnceLock<SharedSteps>,
}

impl StyledBody {
    /// Mixes the space's styles, weights as of [`GaitGenerator::set_style_weights`](crate::GaitGenerator::set_style_weights), and
    /// measures their paces on this body, and generates the steps that distant walkers share: about ten milliseconds.
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
        let measured = space
            .with_buffers(|buffers| MeasuredBlend::measure(&average, skeleton, blend, buffers))?;
        let styled = Arc::new(Styled {
            space: Arc::clone(space),
            skeleton: skeleton.clone(),
            measured,
            shared: OnceLock::new(),
        });
        let made = Self(styled, 0);
        let steps = SharedSteps::record(&made, &mut Workshop::new(&made))?;
        made.0.shared.get_or_init(|| steps);
        Ok(made)
    }

    /// Sets a number, by which walkers identify the body whose [poses](Self::shared_pose) they share.
    #[must_use]
    pub fn numbered(self, number: u32) -> Self {
        Self(self.0, number)
    }

    /// Returns the number that was set.
    pub const fn number(&self) -> u32 {
        self.1
    }

    /// Returns the number of poses that distant walkers share.
    pub fn shared_poses(&self) -> usize {
        self.0.shared().poses().len()
    }

    /// Writes a shared pose.
    pub fn shared_pose(&self, pose: usize, out: &mut CrowdPose) {
        let pose = &self.0.shared().poses()[pose];
        out.blend(pose, pose, 0.0);
    }

    /// Returns the body.
    pub fn skeleton(&self) -> &Skeleton {
        &self.0.skeleton
    }

    /// Returns the usual speed, that of the recordings, m/s.
    pub fn usual_speed_mps(&self) -> f32 {
        self.0.measured.blend.model.speed.reference_mps as f32
    }
}

impl Styled {
    /// Returns the steps that distant walkers share.
    pub(super) fn shared(&self) -> &SharedSteps {
        self.shared.get_or_init(SharedSteps::default)
    }
}

/// Working memory for the steps of walkers of one model on one body; one per thread.
#[derive(Debug)]
pub struct Workshop {
    pub(super) planner: Planner,
    pub(super) window: StepWindow,
    pub(super) buffers: StepBuffers,
    pub(super) rest: RestBuffers,
    /// Unused own walks.
    #[expect(
        clippy::vec_box,
        reason = "handed on from walker to walker as they are"
    )]
    pub(super) spares: Vec<Box<OwnWalk>>,
}

impl Workshop {
    /// Keeps an unused own walk, as long as there is room.
    pub(super) fn spare(&mut self, own: Option<Box<OwnWalk>>) {
        if self.spares.len() < SPARES {
            self.spares.extend(own);
        }
    }

    /// Creates a workshop for walkers of this body.
    pub fn new(styled: &StyledBody) -> Self {
        let blend = &styled.0.measured.blend;
        Self {
            planner: Planner::new(&blend.model, 0, 0.0),
            window: StepWindow::new(&styled.0.skeleton, blend),
            buffers: StepBuffers::new(&blend.model),
            rest: RestBuffers::new(Planner::longest_step(&blend.model)),
            spares: Vec::with_capacity(SPARES),
        }
    }
}
