//! Tools with which the steps of a crowd's walkers are generated.

use super::rest::RestBuffers;
use super::styled_body::StyledBody;
use crate::plan::Planner;
use crate::source::{StepBuffers, StepWindow};

/// Planner, window and buffers, for walkers of one model on one body.
#[derive(Debug)]
pub(super) struct StepTools {
    pub(super) planner: Planner,
    pub(super) window: StepWindow,
    pub(super) buffers: StepBuffers,
    pub(super) rest: RestBuffers,
}

impl StepTools {
    /// Makes tools for walkers of this body.
    pub(super) fn new(styled: &StyledBody) -> Self {
        let blend = &styled.0.measured.blend;
        Self {
            planner: Planner::new(&blend.model, 0, 0.0),
            window: StepWindow::new(&styled.0.skeleton, blend),
            buffers: StepBuffers::new(&blend.model),
            rest: RestBuffers::new(Planner::longest_step(&blend.model)),
        }
    }
}
