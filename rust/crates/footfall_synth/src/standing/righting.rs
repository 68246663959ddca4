//! Righting of a body that came to rest leaning against the loss of its speed.
//!
//! People's feet come to rest before their trunks, which are upright half a second later.

use super::sway::Sway;
use crate::ground::HEAD_KEPT;
use footfall_core::Joint;
use footfall_core::ease::settled;
use footfall_model::layout::feature_offset;
use serde::{Deserialize, Serialize};

/// Rates at which a standing body rights itself, and at which that fades as it walks, those of a critically damped spring, 1/s.
const RIGHTING_RATE: f32 = 6.0;
const FALL_RATE: f32 = 9.0;

/// Share that counts as none.
const LEAST_SHARE: f32 = 2e-3;

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
        let (target, rate) = if stands {
            (1.0, RIGHTING_RATE)
        } else {
            (0.0, FALL_RATE)
        };
        let (away, speed) = settled(self.share - target, self.speed, rate, secs);
        let share = target + away;
        if !stands && share < LEAST_SHARE {
            return Self::default();
        }
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
