//! Righting of a body that came to rest leaning against the loss of its speed.
//!
//! People's feet come to rest before their trunks, which are upright half a second later.

use super::fade::{Rates, faded};
use super::sway::Sway;
use crate::ground::HEAD_KEPT;
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use serde::{Deserialize, Serialize};

/// Rates at which a standing body rights itself, and at which that fades as it walks.
const RATES: Rates = Rates {
    rise: 6.0,
    fall: 9.0,
};

/// Share that counts as none: a fifth of a millimetre at the head of a body that leant by 4°.
const LEAST_SHARE: f32 = 5e-3;

/// Progress of the righting, part of a walker's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Righting {
    /// Lean forwards of pelvis and trunk as the body came to rest, radians.
    lean: f32,
    /// Share of the lean that is gone, and its rate, 1/s.
    share: f32,
    speed: f32,
}

impl Righting {
    /// Begins in a body that has just come to rest with this lean.
    pub(super) fn of(lean: f32) -> Self {
        Self {
            lean,
            ..Self::default()
        }
    }

    /// Returns the progress after this time, of a walker that stands or walks throughout.
    pub(super) fn after(self, secs: f32, stands: bool) -> Self {
        if self == Self::default() {
            return self;
        }
        let [share, speed] = faded([self.share, self.speed], RATES, stands, secs);
        let [share, speed] = match (stands, share) {
            (true, share) if share > 1.0 - LEAST_SHARE => [1.0, 0.0],
            (false, share) if share < LEAST_SHARE => return Self::default(),
            _ => [share, speed],
        };
        Self {
            share,
            speed,
            ..self
        }
    }

    /// Returns true when nothing of it is visible.
    pub(super) fn is_none(&self) -> bool {
        self.share == 0.0
    }

    /// Adds it to a sway.
    pub(super) fn add(&self, sway: &mut Sway) {
        let turn = self.share * self.lean;
        sway[feature_offset(Joint::Hips)] -= turn;
        sway[feature_offset(Joint::Neck)] += HEAD_KEPT * turn;
    }

    /// Returns all numbers.
    pub(crate) const fn numbers(&self) -> [f32; 3] {
        [self.lean, self.share, self.speed]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::SWAY_COUNT;

    #[test]
    fn a_body_ends_upright_and_forgets_it_as_it_walks() {
        let turned = |righting: &Righting| {
            let mut sway = [0.0; SWAY_COUNT];
            righting.add(&mut sway);
            sway[feature_offset(Joint::Hips)]
        };
        let frame = 1.0 / 60.0;
        let mut righting = Righting::of(-0.07);
        let (mut before, mut fastest) = (0.0, 0.0_f32);
        for number in 0..180 {
            righting = righting.after(frame, number < 120);
            let now = turned(&righting);
            fastest = fastest.max((now - before).abs() / frame);
            before = now;
            assert!((0.0..=0.07).contains(&now), "{now} in frame {number}");
            if number == 119 {
                assert!((now - 0.07).abs() < 1e-6);
                assert_eq!(righting.after(1.0, true), righting);
            }
        }
        assert!(righting == Righting::default() && righting.is_none());
        assert!((0.1..0.3).contains(&fastest), "{fastest} rad/s");
        let halves = Righting::of(0.1).after(0.2, true).after(0.2, true);
        let whole = Righting::of(0.1).after(0.4, true);
        assert!((turned(&halves) - turned(&whole)).abs() < 1e-6);
    }
}
