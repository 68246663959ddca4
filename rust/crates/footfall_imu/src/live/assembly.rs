//! Samples out of readings that come apart.
//!
//! A sample has the time of a specific force, and the angular rate on the line between the two measured around it: it waits for the next rate, and
//! no longer. Force is gravity and acceleration where it is not measured as such, gravity is up in an orientation, and rate is an orientation's
//! change where none is measured.

use super::reading::Quantity;
use crate::sample::{GRAVITY_MPS2, ImuSample};
use footfall_core::rotation::log_map;
use glam::{Quat, Vec3};
use std::collections::VecDeque;

/// Forces that wait for a rate: of sensors that send forces more often, the newest.
const MOST_WAITING: usize = 8;

/// Time for which a measured quantity takes precedence over the same one derived, seconds.
const MEASURED_SECS: f64 = 1.0;

/// A rate that is older says nothing, seconds.
const STALE_SECS: f64 = 0.5;

/// Makes samples of one sensor's readings.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    gravity: Option<Vec3>,
    orientation: Option<(f64, Quat)>,
    rates: [Option<(f64, Vec3)>; 2],
    waiting: VecDeque<(f64, Vec3)>,
    force_secs: Option<f64>,
    gravity_secs: Option<f64>,
    rate_secs: Option<f64>,
}

impl Assembly {
    /// Takes what was measured at a time and gives every sample that it completes.
    pub fn push(&mut self, time_secs: f64, quantity: Quantity, mut give: impl FnMut(ImuSample)) {
        let recently =
            |at: Option<f64>| at.is_some_and(|at| (time_secs - at).abs() < MEASURED_SECS);
        match quantity {
            Quantity::Both { force, rate } => give(ImuSample {
                time_secs,
                force,
                rate,
            }),
            Quantity::Force(force) => {
                self.force_secs = Some(time_secs);
                self.force(time_secs, force, give);
            }
            Quantity::Rate(rate) => {
                self.rate_secs = Some(time_secs);
                self.rate(time_secs, rate, give);
            }
            Quantity::Gravity(gravity) => {
                self.gravity_secs = Some(time_secs);
                self.gravity = Some(gravity);
            }
            Quantity::Acceleration(acceleration) => {
                if !recently(self.force_secs)
                    && let Some(gravity) = self.gravity
                {
                    self.force(time_secs, acceleration + gravity, give);
                }
            }
            Quantity::Orientation(world_from_sensor) => {
                let turn = world_from_sensor.normalize();
                if !recently(self.gravity_secs) {
                    self.gravity = Some(turn.inverse() * (Vec3::Z * GRAVITY_MPS2));
                }
                let before = self.orientation.replace((time_secs, turn));
                if !recently(self.rate_secs)
                    && let Some((since, before)) = before
                    && (1e-4..STALE_SECS).contains(&(time_secs - since))
                {
                    let rate = log_map(before.inverse() * turn) / (time_secs - since) as f32;
                    self.rate(0.5 * (since + time_secs), rate, give);
                }
            }
        }
    }

    fn force(&mut self, time_secs: f64, force: Vec3, give: impl FnMut(ImuSample)) {
        if self.waiting.len() == MOST_WAITING {
            self.waiting.pop_front();
        }
        self.waiting.push_back((time_secs, force));
        self.give_waiting(give);
    }

    fn rate(&mut self, time_secs: f64, rate: Vec3, give: impl FnMut(ImuSample)) {
        self.rates = [self.rates[1], Some((time_secs, rate))];
        self.give_waiting(give);
    }

    /// Gives every force up to the last rate.
    fn give_waiting(&mut self, mut give: impl FnMut(ImuSample)) {
        let Some((until, rate)) = self.rates[1] else {
            return;
        };
        while let Some((time_secs, force)) = self.waiting.front().copied()
            && time_secs <= until
        {
            self.waiting.pop_front();
            let rate = match self.rates[0] {
                Some((since, before)) if since < until && until - since < STALE_SECS => {
                    let share = (time_secs - since) / (until - since);
                    before.lerp(rate, share.max(0.0) as f32)
                }
                _ => rate,
            };
            give(ImuSample {
                time_secs,
                force,
                rate,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sensor that turns about its own x, which is level, at 2 rad/s; the world's z is up.
    fn turn(time: f64) -> Quat {
        Quat::from_rotation_x(2.0 * time as f32)
    }

    fn force(time: f64) -> Vec3 {
        turn(time).inverse() * Vec3::new(0.0, 1.0, GRAVITY_MPS2)
    }

    fn samples(readings: &[(f64, Quantity)]) -> Vec<ImuSample> {
        let mut assembly = Assembly::default();
        let mut samples = Vec::new();
        for (time, quantity) in readings {
            assembly.push(*time, *quantity, |sample| samples.push(sample));
        }
        samples
    }

    #[test]
    fn rates_are_taken_on_the_line_between_their_times() {
        let mut readings = Vec::new();
        for n in 0..100 {
            let time = f64::from(n) * 0.01;
            readings.push((time, Quantity::Force(force(time))));
            let later = time + 0.004;
            readings.push((later, Quantity::Rate(Vec3::X * later as f32)));
        }
        let samples = samples(&readings);
        assert_eq!(samples.len(), 100);
        for sample in &samples[1..] {
            assert!((f64::from(sample.rate.x) - sample.time_secs).abs() < 1e-5);
            assert_eq!(sample.force, force(sample.time_secs));
        }
    }

    #[test]
    fn an_orientation_and_an_acceleration_are_enough() {
        let mut readings = Vec::new();
        for n in 0..100 {
            let time = f64::from(n) * 0.01;
            readings.push((time, Quantity::Orientation(turn(time))));
            readings.push((time, Quantity::Acceleration(turn(time).inverse() * Vec3::Y)));
        }
        let samples = samples(&readings);
        assert!(samples.len() >= 97, "{}", samples.len());
        for sample in &samples[1..] {
            assert!((sample.rate - Vec3::X * 2.0).length() < 1e-2, "{sample:?}");
            assert!((sample.force - force(sample.time_secs)).length() < 1e-3);
        }
    }

    #[test]
    fn what_is_measured_counts_before_what_is_derived() {
        let mut readings = Vec::new();
        for n in 0..100 {
            let time = f64::from(n) * 0.01;
            readings.push((time, Quantity::Force(Vec3::Y)));
            readings.push((time, Quantity::Gravity(Vec3::Z)));
            readings.push((time, Quantity::Acceleration(Vec3::X)));
            readings.push((time, Quantity::Rate(Vec3::ONE)));
            readings.push((time, Quantity::Orientation(turn(time))));
        }
        let samples = samples(&readings);
        assert_eq!(samples.len(), 100);
        assert!(
            samples
                .iter()
                .all(|s| s.force == Vec3::Y && s.rate == Vec3::ONE)
        );
    }

    #[test]
    fn forces_without_rates_give_nothing() {
        let readings: Vec<_> = (0..50)
            .map(|n| (f64::from(n) * 0.01, Quantity::Force(Vec3::Y)))
            .collect();
        assert!(samples(&readings).is_empty());
    }
}
