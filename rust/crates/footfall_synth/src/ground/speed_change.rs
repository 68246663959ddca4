//! Changes of speed: hips that are to be faster or slower by the end of a step gain or lose speed all through it.
//!
//! An even step settles to its mean speed soon after it has begun, so that somebody who sets out would be as fast as the mean of the step and no faster.
//! On a request for another speed, the way of the hips is instead the cubic that begins with the speed they have and ends with the one that is asked for.

use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Changes of the asked velocity up to the first are none, and from the second on shape the step wholly, m/s.
const CHANGED_MPS: [f32; 2] = [0.2, 1.0];

/// Travel in a step from which on a change of speed shapes it, as a share of the leg's length.
const LEAST_TRAVEL: f32 = 0.12;

/// The speed that a step ends with, and how much it differs from the one before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SpeedChange {
    /// At the end of the step, m/s.
    pub(super) speed_mps: f32,
    /// From 0, for a step like the one before, to 1.
    pub(super) weight: f32,
}

impl SpeedChange {
    /// From one asked velocity to another; none from one direction to another, in which hips go a way of their own.
    pub(crate) fn between(before_mps: Vec2, after_mps: Vec2) -> Self {
        let change = before_mps.distance(after_mps);
        let changed = smooth_step((change - CHANGED_MPS[0]) / (CHANGED_MPS[1] - CHANGED_MPS[0]));
        let product = before_mps.length() * after_mps.length();
        let straight = if product > 0.0 {
            before_mps.dot(after_mps) / product
        } else {
            1.0
        };
        Self {
            speed_mps: after_mps.length(),
            weight: changed * straight.max(0.0),
        }
    }

    /// The same, which shapes a step wholly.
    pub(crate) fn whole(self) -> Self {
        Self {
            weight: 1.0,
            ..self
        }
    }

    /// Weight in a step of this travel, as a share of the leg: a step on the spot goes nowhere.
    pub(super) fn weight_over(self, travel: f32) -> f32 {
        self.weight * smooth_step(travel / LEAST_TRAVEL)
    }
}

/// Lead of the hips over an even way at part `s` of a step that they begin and end faster by so much, in steps.
pub(super) fn urge(begins: f32, ends: f32, s: f32) -> f32 {
    let left = 1.0 - s;
    s * left * (begins * left - ends * s)
}

/// By how much the end of a step is faster than an even way, nearest to `ends`, so that hips that begin it faster by `begins` slow down all the way through
/// it, or gain speed all the way: feet that landed elsewhere than the new speed would have them leave more way than it takes, or less.
pub(super) fn steady(begins: f32, ends: f32) -> f32 {
    let bounds = [-0.5 * begins, -2.0 * begins];
    ends.clamp(bounds[0].min(bounds[1]), bounds[0].max(bounds[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hips_begin_and_end_with_the_speeds_they_should() {
        const SMALL: f32 = 1e-3;
        for (begins, ends) in [(0.0, 0.0), (-1.0, 0.7), (2.0, -1.5)] {
            assert!(urge(begins, ends, 0.0).abs() < 1e-6 && urge(begins, ends, 1.0).abs() < 1e-6);
            let first = urge(begins, ends, SMALL) / SMALL;
            let last = -urge(begins, ends, 1.0 - SMALL) / SMALL;
            assert!((first - begins).abs() < 0.01 && (last - ends).abs() < 0.01);
        }
    }

    #[test]
    fn who_brakes_never_gains_speed() {
        for (begins, ends) in [(1.0, 3.0), (1.0, -5.0), (-1.0, -3.0), (-1.0, 0.1)] {
            let ends = steady(begins, ends);
            let speeds: Vec<f32> = (0..50)
                .map(|at| {
                    urge(begins, ends, (at + 1) as f32 / 50.0)
                        - urge(begins, ends, at as f32 / 50.0)
                })
                .collect();
            let gains = speeds
                .windows(2)
                .map(|pair| (pair[1] - pair[0]) * begins.signum());
            assert!(
                gains.fold(f32::MIN, f32::max) < 1e-6,
                "from {begins} to {ends}"
            );
        }
    }
}
