//! Course of a step over the ground.

use super::displacement::Displacement;
use super::speed_change::SpeedChange;

/// Course of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// Headings of the features from where the walker faces, before the step and after it, radians.
    pub(crate) facing: [f32; 2],
    /// True where standing legs are to be as long as generated; those of a step that ends in flight are not.
    pub(crate) keeps_lengths: bool,
    /// Direction of a run from where the walker faces, radians, positive to the left; none where the generated legs choose it.
    pub(crate) direction: Option<f32>,
    /// Change of speed within it.
    pub(crate) change: SpeedChange,
    /// Displacement of its end.
    pub(crate) displacement: Displacement,
    /// Duration of the whole step, seconds.
    pub(crate) step_secs: f32,
}
