//! Units: gravity as a sensor at rest measures it, and how fast a limb can turn.

use super::fault::StreamFault;
use crate::sample::{GRAVITY_MPS2, ImuSample};
use glam::Vec3;

/// A sensor rests when for so long, seconds, its specific force stays within this share of its mean and its angular rate within this of its mean, whatever the units.
const REST_SECS: f32 = 0.35;
const REST_SHARE: f32 = 0.04;
const REST_RATE: f32 = 0.3;

/// A specific force this close to nothing may be one without gravity, of noise alone.
const NOTHING_MPS2: f32 = 0.3;

/// Rests that measure the same before a unit is doubted: one alone may be a lift that starts, or a foot in flight.
const RESTS: u32 = 3;

/// Gravity at rest, m/s²: no lift and no scale of a phone's accelerometer is further off.
const GRAVITY: core::ops::Range<f32> = 0.8 * GRAVITY_MPS2..1.2 * GRAVITY_MPS2;

/// The same in units of gravity.
const ONE_G: core::ops::Range<f32> = 0.8..1.2;

/// Angular rate and duration beyond those of any limb, rad/s and seconds. The evidence decays slowly: a wearer who stops walking does not change the units.
const FASTEST_RADPS: f32 = 45.0;
const FAST_SECS: f32 = 0.06;
const FORGOTTEN_SECS: f32 = 60.0;

/// Time for which a sensor has been still, and what it measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    secs: f32,
    force: Vec3,
    rate: Vec3,
    /// Rests in a row whose force was no gravity, and that of the last.
    odd_rests: u32,
    odd_force: f32,
    fast_secs: f32,
    fastest: f32,
}

impl Units {
    pub(super) const NONE: Self = Self {
        secs: 0.0,
        force: Vec3::ZERO,
        rate: Vec3::ZERO,
        odd_rests: 0,
        odd_force: 0.0,
        fast_secs: 0.0,
        fastest: 0.0,
    };

    pub(super) fn step(&mut self, sample: &ImuSample, dt_secs: f32) {
        let secs = self.secs.max(f32::MIN_POSITIVE);
        let (force, rate) = (self.force / secs, self.rate / secs);
        let still = sample.force.distance(force) < (REST_SHARE * force.length()).max(NOTHING_MPS2)
            && sample.rate.distance(rate) < REST_RATE;
        if self.secs > 0.0 && !still {
            (self.secs, self.force, self.rate) = (0.0, Vec3::ZERO, Vec3::ZERO);
        }
        self.secs += dt_secs;
        self.force += sample.force * dt_secs;
        self.rate += sample.rate * dt_secs;
        if self.secs > REST_SECS {
            self.rest(self.force.length() / self.secs);
            (self.secs, self.force, self.rate) = (0.0, Vec3::ZERO, Vec3::ZERO);
        }
        self.turn(sample.rate.length(), dt_secs);
    }

    /// Takes what a rest measured.
    fn rest(&mut self, force: f32) {
        if GRAVITY.contains(&force) {
            self.odd_rests = 0;
            return;
        }
        let alike = (force - self.odd_force).abs() < 0.1 * force.max(1.0);
        self.odd_rests = if alike { self.odd_rests + 1 } else { 1 };
        self.odd_force = force;
    }

    fn turn(&mut self, rate: f32, dt_secs: f32) {
        if rate > FASTEST_RADPS {
            self.fast_secs = (self.fast_secs + dt_secs).min(2.0 * FAST_SECS);
            self.fastest = self.fastest.max(rate);
        } else {
            self.fast_secs -= dt_secs * FAST_SECS / FORGOTTEN_SECS;
            if self.fast_secs <= 0.0 {
                (self.fast_secs, self.fastest) = (0.0, 0.0);
            }
        }
    }

    pub(super) fn fault(&self) -> Option<StreamFault> {
        let rest = self.odd_force;
        if self.fast_secs > FAST_SECS {
            return Some(StreamFault::RateInDegrees { high: self.fastest });
        }
        if self.odd_rests < RESTS {
            return None;
        }
        Some(if ONE_G.contains(&rest) {
            StreamFault::ForceInG { rest }
        } else {
            StreamFault::Gravity { rest }
        })
    }
}
