//! Workshop in which the walkers of a thread generate their steps.

use super::own::OwnWalk;
use super::styled_body::StyledBody;
use super::tools::StepTools;

/// Maximum number of unused own walks that are kept for reuse.
const SPARES: usize = 1024;

/// Working memory for the steps of walkers of one model on one body; one per thread.
#[derive(Debug)]
pub struct Workshop {
    pub(super) tools: StepTools,
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
        Self {
            tools: StepTools::new(styled),
            spares: Vec::with_capacity(SPARES),
        }
    }
}
