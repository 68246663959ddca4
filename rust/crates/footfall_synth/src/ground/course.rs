//! Course of a step over the ground.

use super::displacement::Displacement;
use super::speed_change::SpeedChange;

/// Course of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    /// Turn rate at the end of the step, rad/s.
    pub(crate) turn_rate: f32,
    /// Headings of the features relative to the facing direction, before and after the step, radians.
    pub(crate) facing: [f32; 2],
    /// True when standing legs keep their generated lengths; they do not in a step that ends in flight.
    pub(crate) keeps_lengths: bool,
    /// True for a foot that lands slowly: a switching model's in a step to the side or backwards.
    pub(crate) lands_softly: bool,
    /// Direction of a run relative to the facing direction, radians, positive to the left; `None` when the generated legs determine it.
    pub(crate) direction: Option<f32>,
    /// Change of speed within the step.
    pub(crate) change: SpeedChange,
    /// Displacement of the end of the step.
    pub(crate) displacement: Displacement,
    /// Duration of the whole step, seconds.
    pub(crate) step_secs: f32,
}
