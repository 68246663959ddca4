//! Bounce: the height of a runner's hips over a stance, and the push of a leg.
//!
//! The leg is a spring under a mass: the force on it rises and falls as half a sine wave over the stance, and is nothing as the foot lands and as it takes
//! off (Alexander and Jayes, Vertical movements in walking and running, 1978). So the hips are lowest in the middle of the stance, and nothing jolts where
//! flight and stance meet. A leg on which a leap lands pushes early, by a second harmonic, for otherwise its knee would fold. Where a step is replanned in
//! its stance, the rest of the wave follows.

use crate::gait::GRAVITY_MPS2;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;

/// Speeds of a fall above which the leg pushes early, and above which as early as it can, m/s.
const EASY_FALL_MPS: f32 = 1.0;
const HARD_FALL_MPS: f32 = 2.2;

/// The hips' height over one stance.
pub(super) struct Bounce {
    begin: f32,
    fall_mps: f32,
    /// Speed that the leg's force gives, m/s.
    push_mps: f32,
    push: Push,
}

impl Bounce {
    /// Makes a stance from a height, with the upward speeds at its beginning and its end. `push` is in seconds.
    pub(super) fn new(begin: f32, [fall_mps, rise_mps]: [f32; 2], push: Push) -> Self {
        Self {
            begin,
            fall_mps,
            push_mps: rise_mps - fall_mps + GRAVITY_MPS2 * push.left,
            push,
        }
    }

    /// Returns the height at a time after the beginning, metres.
    pub(super) fn height(&self, t: f32) -> f32 {
        let pushed = self.push_mps * self.push.displacement(t);
        self.begin + self.fall_mps * t - 0.5 * GRAVITY_MPS2 * t * t + pushed
    }
}

/// Push of a leg in what is left of a stance: sin φ + `early` · sin 2φ, where φ is half a turn in the whole stance.
#[derive(Clone, Copy)]
pub(super) struct Push {
    /// Time of the stance that has passed, and that is left, in one unit.
    pub(super) borne: f32,
    pub(super) left: f32,
    /// Strength of the second harmonic: at [`MOST_EARLY`](Self::MOST_EARLY) the force still is nowhere below zero.
    pub(super) early: f32,
}

impl Push {
    /// Greatest strength of the second harmonic.
    const MOST_EARLY: f32 = 0.5;

    /// Returns the strength of the second harmonic with which a leg catches a fall, upward speed in m/s: none in runs, whose hips fall by 0.5 to 0.9 m/s.
    pub(super) fn early_for(fall_mps: f32) -> f32 {
        Self::MOST_EARLY
            * smooth_step((-fall_mps - EASY_FALL_MPS) / (HARD_FALL_MPS - EASY_FALL_MPS))
    }

    /// Returns the displacement by the leg's force a time from now, per unit of the speed that the force gives until the take-off.
    pub(super) fn displacement(self, t: f32) -> f32 {
        let radians = PI / (self.borne + self.left);
        let begun = radians * self.borne;
        let (sin_begun, cos_begun) = begun.sin_cos();
        let (sin, cos) = (begun + radians * t).sin_cos();
        // Both harmonics' displacements and speeds until the take-off, times π over the stance.
        let first = t * cos_begun - (sin - sin_begun) / radians;
        let square = sin_begun * sin_begun;
        let second = t * (0.5 - square) - 0.5 * (sin * cos - sin_begun * cos_begun) / radians;
        (first + self.early * second) / (1.0 + cos_begun - self.early * square)
    }

    /// Returns the displacement at the take-off.
    pub(super) fn whole(self) -> f32 {
        self.displacement(self.left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECS: f32 = 0.2;
    const WHOLE: Push = Push {
        borne: 0.0,
        left: SECS,
        early: 0.0,
    };

    #[test]
    fn a_stance_goes_from_fall_to_rise_and_bears_nothing_at_its_ends() {
        let bounce = Bounce::new(0.9, [-0.6, 0.4], WHOLE);
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
    fn the_rest_of_a_stance_goes_on_as_the_whole_one() {
        for early in [0.0, Push::MOST_EARLY] {
            let whole = Bounce::new(0.9, [-0.6, 0.4], Push { early, ..WHOLE });
            let h = 1e-3;
            for cut in [0.03, 0.1, 0.16] {
                let fall = (whole.height(cut + h) - whole.height(cut - h)) / (2.0 * h);
                let push = Push {
                    borne: cut,
                    left: SECS - cut,
                    early,
                };
                let rest = Bounce::new(whole.height(cut), [fall, 0.4], push);
                for part in [0.2, 0.5, 1.0] {
                    let t = part * push.left;
                    let off = rest.height(t) - whole.height(cut + t);
                    assert!(off.abs() < 2e-4, "{off} m after {t} s from {cut} s");
                }
                assert!((push.whole() - push.displacement(push.left)).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_leg_on_which_a_leap_lands_is_not_folded() {
        let depth = |early: f32| {
            let bounce = Bounce::new(0.0, [-2.6, 0.8], Push { early, ..WHOLE });
            let heights = (0..=200).map(|index| bounce.height(index as f32 * 0.005 * SECS));
            heights.fold(0.0, f32::min)
        };
        let early = Push::early_for(-2.6);
        assert!((early - Push::MOST_EARLY).abs() < 1e-6);
        assert!(depth(early) > 0.7 * depth(0.0), "{} m", depth(early));
        assert!(Push::early_for(-0.9).abs() < 1e-6);
        // The leg only pushes, and leaves at the speed that is asked for.
        let push = Push { early, ..WHOLE };
        let bounce = Bounce::new(0.0, [-2.6, 0.8], push);
        let h = 1e-3;
        for index in 1..20 {
            let t = index as f32 * 0.05 * SECS;
            let force = bounce.height(t + h) - 2.0 * bounce.height(t) + bounce.height(t - h);
            assert!(force / (h * h) > -GRAVITY_MPS2 - 1.0, "at {t} s");
        }
        let speed = (bounce.height(SECS) - bounce.height(SECS - h)) / h;
        assert!((speed - 0.8).abs() < 0.02, "{speed} m/s");
    }

    #[test]
    fn an_even_run_is_lowest_in_the_middle_of_its_stance() {
        let bounce = Bounce::new(0.9, [-0.5, 0.5], WHOLE);
        let heights = (0..=20).map(|index| bounce.height(index as f32 * 0.05 * SECS));
        let lowest = heights.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(lowest.map(|(index, _)| index), Some(10));
    }
}
