//! Bounce: the height of a runner's hips over a stance, and the push of a leg.
//!
//! The leg is a spring under a mass: the force on it rises and falls as half a sine wave over the stance, and is nothing as the foot lands and as it takes
//! off (Alexander and Jayes, Vertical movements in walking and running, 1978). So the hips are lowest in the middle of the stance, and nothing jolts where
//! flight and stance meet.

use crate::gait::GRAVITY_MPS2;
use core::f32::consts::PI;

/// The hips' height over one stance.
pub(super) struct Bounce {
    begin: f32,
    fall_mps: f32,
    /// Speed that the leg's force gives, m/s.
    push_mps: f32,
    secs: f32,
}

impl Bounce {
    /// Makes a stance of this duration from a height, with the upward speeds at its beginning and its end.
    pub(super) fn new(begin: f32, [fall_mps, rise_mps]: [f32; 2], secs: f32) -> Self {
        Self {
            begin,
            fall_mps,
            push_mps: rise_mps - fall_mps + GRAVITY_MPS2 * secs,
            secs,
        }
    }

    /// Returns the height at a time after the landing, metres.
    pub(super) fn height(&self, t: f32) -> f32 {
        let pushed = self.push_mps * pushed(t, self.secs);
        self.begin + self.fall_mps * t - 0.5 * GRAVITY_MPS2 * t * t + pushed
    }
}

/// Returns the displacement by the leg's force at the time `t` of a stance, per unit of the speed gained by its end. Both times have
/// the same unit.
pub(super) fn pushed(t: f32, stance: f32) -> f32 {
    0.5 * (t - stance * (PI * t / stance).sin() / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECS: f32 = 0.2;

    #[test]
    fn a_stance_goes_from_fall_to_rise_and_bears_nothing_at_its_ends() {
        let bounce = Bounce::new(0.9, [-0.6, 0.4], SECS);
        let h = 0.01;
        let speed = |t: f32| (bounce.height(t + h) - bounce.height(t - h)) / (2.0 * h);
        let acceleration = |t: f32| {
            (bounce.height(t + h) - 2.0 * bounce.height(t) + bounce.height(t - h)) / (h * h)
        };
        assert!((bounce.height(0.0) - 0.9).abs() < 1e-6);
        assert!((bounce.height(SECS) - (0.9 - 0.1 * SECS)).abs() < 1e-5);
        for (t, mps) in [(0.0, -0.6), (SECS, 0.4)] {
            assert!((speed(t) - mps).abs() < 0.02, "{} m/s", speed(t));
            assert!((acceleration(t) + GRAVITY_MPS2).abs() < 0.2);
        }
    }

    #[test]
    fn an_even_run_is_lowest_in_the_middle_of_its_stance() {
        let bounce = Bounce::new(0.9, [-0.5, 0.5], SECS);
        let heights = (0..=20).map(|index| bounce.height(index as f32 * 0.05 * SECS));
        let lowest = heights.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(lowest.map(|(index, _)| index), Some(10));
    }
}
