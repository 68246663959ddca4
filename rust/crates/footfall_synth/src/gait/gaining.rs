//! Steps in which a walker gains speed for a run: quicker and shorter ones.
//!
//! People who run up to a speed take steps as quick as those of that speed from the beginning, push off behind and land under their hips. Steps as long as
//! those of a steady walk would be lunges.

use super::request::{StepControls, StepRequest};
use footfall_core::ease::smooth_step;

/// Increase of the tempo in the walked steps before a run; strides are shorter by as much. O3DE's actor takes 2.9 to 3.3 steps a second while he gains 2 to 3 m/s² at 2.4 m/s, and 3.1 at a
/// steady 2.4 m/s.
const QUICKER: f32 = 0.25;

/// Requested speeds from which the increase sets in and is whole, m/s; the first is that which a walked step reaches.
const WANTED_MPS: [f32; 2] = [2.0, 2.8];

/// Turn rate with which a step is as long as others, rad/s: hips would have to go round a foot in too short a time.
const TURNING_RADPS: f32 = 1.5;

impl StepRequest {
    /// Returns the request for a walked step before a run: quicker and shorter.
    pub(super) fn gaining(mut self, controls: &StepControls) -> Self {
        let [from, to] = WANTED_MPS;
        let runs = smooth_step((controls.velocity_mps.length() - from) / (to - from));
        let straight = 1.0 - smooth_step(self.turn_rate.abs() / TURNING_RADPS);
        let quicker = QUICKER * straight * runs;
        self.manner.pace = self.manner.pace.quicker(f64::from(1.0 + quicker));
        self
    }
}
