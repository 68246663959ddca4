//! Standing motion of one walker, which fades in at rest and out as a step begins.

use super::carry::Carrier;
use super::fade::{Rates, faded};
use super::righting::Righting;
use super::sway::{Stander, StandingTables, Sway};
use crate::config::GeneratorConfig;
use crate::ground::PlanterState;
use footfall_core::{Pose, Skeleton};
use footfall_model::FEATURE_COUNT;
use glam::Quat;
use std::sync::Arc;

/// Rates at which it fades in and out.
const RATES: Rates = Rates {
    rise: 2.4,
    fall: 9.0,
};

/// Share that counts as none: a tenth of a millimetre.
const LEAST_SHARE: f32 = 2e-3;

/// Largest amount that still looks like standing.
const MOST_AMOUNT: f32 = 2.0;

/// Progress of a walker's standing motion, part of its state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// Total time of standing motion, seconds.
    pub(crate) secs: f64,
    /// Current share, 0 to 1, and its rate, 1/s.
    pub(crate) share: f32,
    pub(crate) speed: f32,
    pub(crate) righting: Righting,
}

/// One walker's standing motion.
#[derive(Clone, Debug)]
pub(crate) struct Life {
    tables: Arc<StandingTables>,
    stander: Stander,
    carrier: Carrier,
    amount: f32,
    pub(crate) moment: Moment,
}

impl Moment {
    /// Returns the progress after this time, of a walker that stands or walks throughout.
    pub(crate) fn after(self, secs: f32, stands: bool) -> Self {
        let righting = self.righting.after(secs, stands);
        let nothing = Self {
            secs: self.secs,
            righting,
            ..Self::default()
        };
        if !stands && self.share == 0.0 && self.speed == 0.0 {
            return nothing;
        }
        let [share, speed] = faded([self.share, self.speed], RATES, stands, secs);
        let later = Self {
            secs: self.secs + f64::from(secs),
            share,
            speed,
            righting,
        };
        if !stands && later.share < LEAST_SHARE {
            // Time stops while walking.
            return nothing;
        }
        later
    }
}

impl Life {
    /// Creates the standing motion of a walker; `None` if the model stands still.
    pub(crate) fn new(
        tables: Option<&Arc<StandingTables>>,
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Option<Self> {
        let tables = tables?;
        Some(Self {
            stander: tables.stander(config.seed, config.variation.clamp(0.0, 2.0)),
            tables: Arc::clone(tables),
            carrier: Carrier::new(skeleton, tables.knee),
            amount: 1.0,
            moment: Moment::default(),
        })
    }

    /// Becomes the standing motion of another seed, at the same moment.
    pub(crate) fn become_walker(&mut self, config: &GeneratorConfig) {
        let variation = config.variation.clamp(0.0, 2.0);
        self.stander = self.tables.stander(config.seed, variation);
    }

    /// Sets the amount: 0 none, 1 as in people.
    pub(crate) fn set_amount(&mut self, amount: f32) {
        self.amount = if amount.is_finite() {
            amount.clamp(0.0, MOST_AMOUNT)
        } else {
            0.0
        };
    }

    /// Restarts, fully faded in.
    pub(crate) fn stand(&mut self) {
        self.moment = Moment {
            share: 1.0,
            ..Moment::default()
        };
    }

    /// Advances by a time.
    pub(crate) fn step(&mut self, secs: f32, stands: bool) {
        self.moment = self.moment.after(secs, stands);
    }

    /// Returns true when nothing of it is visible.
    pub(crate) fn is_still(&self) -> bool {
        (self.amount <= 0.0 || self.moment.share <= 0.0) && self.moment.righting.is_none()
    }

    /// Begins to right a body that has just come to rest.
    pub(crate) fn come_to_rest(&mut self, ended: &PlanterState) {
        self.moment.righting = Righting::of(ended.lean.angle.y);
    }

    /// Returns the distance of the hips from the middle of the feet, as a share of the leg's length, positive to the left.
    pub(crate) fn aside(&self) -> f32 {
        let sway = self.tables.at(&self.stander, self.moment.secs);
        self.amount * self.moment.share * sway[FEATURE_COUNT]
    }

    /// Adds the standing motion of a moment to a still pose. `level` is the rotation under which the walker faces +Z.
    pub(crate) fn move_pose(&self, moment: &Moment, level: Quat, pose: &mut Pose) {
        let share = self.amount * moment.share;
        if share.abs() <= 0.0 && moment.righting.is_none() {
            return;
        }
        let sway = self.tables.at(&self.stander, moment.secs);
        let mut sway: Sway = sway.map(|value| share * value);
        moment.righting.add(&mut sway);
        // A body without standing motion stays as low as it came to rest.
        let upright = if self.amount > 0.0 { moment.share } else { 0.0 };
        self.carrier.carry(&sway, upright, level, pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn life_comes_and_goes_smoothly_however_time_is_cut() {
        let mut moment = Moment::default();
        let dt = 1.0 / 60.0;
        let (mut before, mut fastest) = (moment.speed, 0.0_f32);
        for frame in 0..600 {
            // Interrupted as it comes up, and again as it dies away.
            let stands = !(70..90).contains(&frame) && frame < 400;
            moment = moment.after(dt, stands);
            fastest = fastest.max((moment.speed - before).abs() / dt);
            before = moment.speed;
            assert!((0.0..=1.0).contains(&moment.share));
            if frame == 399 {
                assert!(moment.share > 0.99);
            }
        }
        assert_eq!((moment.share, moment.speed), (0.0, 0.0));
        // Of 2 cm this is at most 1.7 m/s².
        assert!(fastest < RATES.fall * RATES.fall + 5.0, "{fastest}");
        let halves = Moment::default().after(0.3, true).after(0.3, true);
        let whole = Moment::default().after(0.6, true);
        assert!((halves.share - whole.share).abs() < 1e-5);
    }
}
