//! Interface of a source of steps.

use crate::detail::Detail;
use crate::gait::{Gait, StepControls};
use crate::ground::PlantedStep;
use crate::plan::StepShape;

/// Function from a step and its place on the ground to the next factor on the legs' reach; `None` when the length is right.
pub(crate) type Stretches<'a> = dyn FnMut(&StepShape, &PlantedStep) -> Option<f32> + 'a;

/// Steps of one walker, planted one after the other.
pub(crate) trait StepSource {
    /// Returns the shape of the current step.
    fn shape(&self) -> &StepShape;

    /// Returns the current step on the ground.
    fn planted(&self) -> &PlantedStep;

    /// Returns the headings under which the walk goes along +Z, before the current step and after it, radians.
    fn facing(&self) -> [f32; 2];

    /// Returns the maximum speed, m/s.
    fn fastest_mps(&self) -> f32;

    /// Returns the gait of the current step.
    fn gait(&self) -> Gait;

    /// Restarts, standing; returns true on success.
    fn stand(&mut self, detail: Detail) -> bool;

    /// Generates the next step.
    fn advance(&mut self, controls: &StepControls);

    /// Replans the current step from a frame on; returns true if it did. The step then begins with that frame.
    fn replan(&mut self, _controls: &StepControls, _frame: usize) -> bool {
        false
    }

    /// Protects the current step from replanning.
    fn keep(&mut self) {}

    /// Returns true when the controls differ enough for the current step to be replanned if possible.
    fn needs_replan(&self, _controls: &StepControls) -> bool {
        false
    }

    /// Plants the current step again with the factors on the legs' reach that `next` returns, until it returns none; the walk continues
    /// at the resulting speed. First the step becomes quicker by the factor `haste` and shorter by
    /// the same factor, which keeps its speed. The very first step stays unchanged.
    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>);
}
