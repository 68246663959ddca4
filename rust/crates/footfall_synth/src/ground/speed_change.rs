//! Changes of speed: the hips gain or lose speed throughout the step.
//!
//! An even step soon settles to its mean speed, so that a walker that sets out would never exceed the mean of its first step.
//! When the requested speed changes, the hips instead follow a cubic from their current speed to the requested one.

use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Change of the requested velocity from which the step is affected, and from which it is affected fully, m/s.
const CHANGED_MPS: [f32; 2] = [0.2, 1.0];

/// Travel in a step from which a change of speed takes full effect, as a share of the leg's length.
const LEAST_TRAVEL: f32 = 0.12;

/// Speed at the end of a step, and weight of its change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SpeedChange {
    /// At the end of the step, m/s.
    pub(super) speed_mps: f32,
    /// From 0, for an unchanged speed, to 1.
    pub(super) weight: f32,
}

impl SpeedChange {
    /// Returns the change between two requested velocities; none between opposite directions.
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

    /// Returns the change with full weight.
    pub(crate) fn whole(self) -> Self {
        Self {
            weight: 1.0,
            ..self
        }
    }

    /// Returns the weight in a step of this travel, as a share of the leg: a step on the spot has none.
    pub(super) fn weight_over(self, travel: f32) -> f32 {
        self.weight * smooth_step(travel / LEAST_TRAVEL)
    }
}

/// Returns the lead of the hips over even travel at part `s` of a step, given the excess speeds at its beginning and end, in steps.
pub(super) fn urge(begins: f32, ends: f32, s: f32) -> f32 {
    let left = 1.0 - s;
    s * left * (begins * left - ends * s)
}

/// Returns the excess speed at the end of a step, nearest to `ends`, for which hips with the initial excess `begins` slow down throughout
/// the step, or accelerate throughout it: feet planted for another speed leave more travel than the new speed needs, or less.
pub(super) fn steady(begins: f32, ends: f32) -> f32 {
    let bounds = [-0.5 * begins, -2.0 * begins];
    // A damaged state may begin with any speed, and `clamp` panics at one that is not a number.
    ends.max(bounds[0].min(bounds[1]))
        .min(bounds[0].max(bounds[1]))
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
