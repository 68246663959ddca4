//! Random draw of a step.

use footfall_core::Side;

/// Components of the variation that a step can hold; a model has no more.
pub(crate) const MAX_COMPONENTS: usize = 16;

/// Random draw of a step; its pace may still change.
#[derive(Clone, Debug)]
pub(crate) struct StepDraw {
    pub(crate) side: Side,
    pub(crate) weights: [f64; MAX_COMPONENTS],
}
