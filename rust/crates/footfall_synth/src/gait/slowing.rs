//! Steps in which a runner slows down to stand: quicker and shorter ones.
//!
//! People who stop from a run brake over four to six quick, short steps, each foot well ahead of the hips. In a step as long as those of the run before
//! they would lose half of their speed over one foot, on a deeply bent knee.

use super::kinds::Gait;
use super::request::StepRequest;

/// Increase of the tempo. O3DE's actor takes steps of 0.18 to 0.28 s as he stops from 3.4 m/s, and of 0.32 s in an even run.
const QUICKER: f64 = 1.65;

/// Shortening of the strides, walked and run. Walked steps that are so much quicker reach less far anyway.
const SHORTER: [f64; 2] = [1.15, 1.45];

/// Share of the usual change of speed from step to step: what is lost in a second remains about the same.
pub(super) const LESS_LOST: f32 = 0.6;

impl StepRequest {
    /// Returns the request for a step of this gait that slows down: quicker and shorter.
    pub(super) fn slowing(mut self, gait: Gait) -> Self {
        let pace = &mut self.manner.pace;
        pace.tempo *= QUICKER;
        pace.stride /= SHORTER[gait as usize];
        self
    }
}
