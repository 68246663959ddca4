//! Random draw of a step.

use super::window::TIE_LEN;
use footfall_core::Side;
use footfall_model::layout::mirror;

/// Maximum number of components of variation in a model.
pub(crate) const MAX_COMPONENTS: usize = 16;

/// Random draw of a step; its pace may still change.
#[derive(Clone, Debug)]
pub(crate) struct StepDraw {
    pub(crate) side: Side,
    pub(crate) weights: [f64; MAX_COMPONENTS],
}

impl StepDraw {
    /// Has this draw of a step that ends standing be one of the other foot, if the next step begins with the same, and mirrors the features of its last frames. Returns true if it did.
    pub(crate) fn change_feet(&mut self, next: Side, end: &mut [f32; TIE_LEN]) -> bool {
        let same = self.side == next;
        if same {
            self.side = next.other();
            mirror(end);
        }
        same
    }
}
