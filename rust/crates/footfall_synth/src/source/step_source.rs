//! Sources of a walker's steps.

use crate::detail::Detail;
use crate::gait::{Gait, StepControls};
use crate::ground::PlantedStep;
use crate::plan::StepShape;

/// The next factor on the legs' reach, made of a step and the ground that it is on; `None` when it lies well.
pub(crate) type Stretches<'a> = dyn FnMut(&StepShape, &PlantedStep) -> Option<f32> + 'a;

/// One walker's steps, put on the ground one after the other.
pub(crate) trait StepSource {
    /// The step that is on the ground now.
    fn shape(&self) -> &StepShape;

    /// The ground that it is on.
    fn planted(&self) -> &PlantedStep;

    /// Headings under which the walk goes along +Z, before the current step and after it, radians.
    fn facing(&self) -> [f32; 2];

    /// Fastest speed that it goes at, m/s.
    fn fastest_mps(&self) -> f32;

    /// The gait of the step that is on the ground now.
    fn gait(&self) -> Gait;

    /// Starts over, standing; whether it could.
    fn stand(&mut self, detail: Detail) -> bool;

    /// Goes on to the next step.
    fn advance(&mut self, controls: &StepControls);

    /// Has the rest of the current step obey something new from a frame of it on; whether it does. The step then begins with that frame.
    fn replan(&mut self, _controls: &StepControls, _frame: usize) -> bool {
        false
    }

    /// Leaves the current step as it is, whatever else is asked for.
    fn keep(&mut self) {}

    /// Returns whether so much else is asked for that the current step would obey it where it can.
    fn needs_replan(&self, _controls: &StepControls) -> bool {
        false
    }

    /// Puts the current step on the ground anew, again and again, with the factors on the legs' reach that `next` makes of where it
    /// lies; the walk goes on from the speed that this gives. Before, it becomes quicker by the factor
    /// `haste` and shorter by as much, which is the same speed. The first step of all stays as it is.
    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>);
}
