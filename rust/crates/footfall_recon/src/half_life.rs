//! Values that follow others by half-lives.

use core::f32::consts::LN_2;

/// The share of a way that is gone in a time, when half of it is gone in a half-life.
pub(crate) fn follow_share(half_life_secs: f32, dt_secs: f32) -> f32 {
    1.0 - (-LN_2 * dt_secs / half_life_secs).exp()
}
