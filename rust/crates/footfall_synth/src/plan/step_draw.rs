//! Random draw of a step.

use footfall_core::Side;

/// Maximum number of components of variation in a model.
pub(crate) const MAX_COMPONENTS: usize = 16;

/// Random draw of a step; its pace may still change.
#[derive(Clone, Debug)]
pub(crate) struct StepDraw {
    pub(crate) side: Side,
    pub(crate) weights: [f64; MAX_COMPONENTS],
}
