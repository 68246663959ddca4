//! Rest and rides: a sensor that lies, and one that moves without steps.
//!
//! Neither is a gait. Gravity shows the orientation of a still sensor: on a standing person, that of the model's people. A lift
//! changes the strength of gravity while nothing turns.

use crate::half_life::follow_share;
use footfall_imu::{GRAVITY_MPS2, ImuSample};
use glam::Vec3;

/// Greatest angular rate of a still sensor, rad/s, and greatest deviation from gravity, m/s².
const STILL_RADPS: f32 = 0.25;
const STILL_MPS2: f32 = 1.0;

/// Time of stillness after which it lies, seconds: a foot in a slow walk stands for a second.
const LIES_SECS: f32 = 1.5;

/// Angle from up on a standing person to up on a sensor that lies; cosine. Trousers' pockets tilt by 30°, feet in high heels by 45.
const LIES_COSINE: f32 = 0.6;

/// Half-lives with which the vertical and the strength of specific force are followed, seconds.
const UP_HALF_LIFE_SECS: f32 = 0.1;
const STRENGTH_HALF_LIFE_SECS: f32 = 0.15;

/// Half-life with which the strength of gravity by this sensor's scale is learned where it is still, seconds.
const GRAVITY_HALF_LIFE_SECS: f32 = 1.5;

/// Least change of the magnitude of specific force in a ride, m/s², its least duration, seconds, and the greatest angular rate meanwhile, rad/s.
const RIDE_MPS2: f32 = 0.5;
const RIDE_SECS: f32 = 0.6;
const RIDE_RADPS: f32 = 0.35;

/// Duration beyond which an acceleration is no lift's, seconds: the sensor's scale differs from the assumed one.
const LONGEST_RIDE_SECS: f32 = 4.0;

/// Time for which a ride is reported after it was detected, seconds: between its start and its end a lift moves evenly.
const RIDE_HELD_SECS: f32 = 3.0;

/// Posture of a sensor that is worn, in the site's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WearMonitor {
    /// Up on a standing person.
    standing_up: Vec3,
    last_secs: Option<f64>,
    still_secs: f32,
    up: Vec3,
    strength: f32,
    /// Gravity by this sensor's scale; 0 before it was still.
    gravity: f32,
    ride_secs: f32,
    held_secs: f32,
}

/// Posture of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Posture {
    /// The sensor is worn, as far as is known.
    Worn,
    /// The sensor lies still.
    Lies,
    /// The sensor moves without steps, as in a vehicle or a lift.
    Rides,
}

impl WearMonitor {
    /// For a sensor whose up is this on a standing person.
    pub(crate) const fn new(standing_up: Vec3) -> Self {
        Self {
            standing_up,
            last_secs: None,
            still_secs: 0.0,
            up: Vec3::ZERO,
            strength: GRAVITY_MPS2,
            gravity: 0.0,
            ride_secs: 0.0,
            held_secs: 0.0,
        }
    }

    /// Begins anew.
    pub(crate) const fn reset(&mut self) {
        *self = Self::new(self.standing_up);
    }

    /// Measures gravity of this strength at rest.
    pub(crate) const fn set_gravity(&mut self, gravity_mps2: f32) {
        self.gravity = gravity_mps2;
    }

    /// Strength of gravity by the sensor's scale, where it was still.
    pub(crate) fn gravity_mps2(&self) -> Option<f32> {
        (self.gravity > 0.0).then_some(self.gravity)
    }

    /// Takes a sample in the site's axes.
    pub(crate) fn push(&mut self, sample: &ImuSample) {
        let last = self.last_secs.replace(sample.time_secs);
        let step_secs = last.map_or(0.0, |last| sample.time_secs - last) as f32;
        if !(0.0..0.5).contains(&step_secs) {
            self.reset();
            return;
        }
        let strength = sample.force.length();
        self.up += (sample.force - self.up) * follow_share(UP_HALF_LIFE_SECS, step_secs);
        let turns = sample.rate.length();
        // What a step jolted is no part of a ride.
        let follows = if turns > RIDE_RADPS {
            1.0
        } else {
            follow_share(STRENGTH_HALF_LIFE_SECS, step_secs)
        };
        self.strength += (strength - self.strength) * follows;
        let still = turns < STILL_RADPS && (strength - GRAVITY_MPS2).abs() < STILL_MPS2;
        self.still_secs = if still {
            self.still_secs + step_secs
        } else {
            0.0
        };
        if still && (self.gravity <= 0.0 || self.ride_secs > LONGEST_RIDE_SECS) {
            (self.gravity, self.strength) = (strength, strength);
        }
        let off = (self.strength - self.gravity).abs();
        if still && off < RIDE_MPS2 {
            let share = follow_share(GRAVITY_HALF_LIFE_SECS, step_secs);
            self.gravity += (strength - self.gravity) * share;
        }
        let rides = self.gravity > 0.0 && off > RIDE_MPS2 && turns < RIDE_RADPS;
        self.ride_secs = if rides {
            self.ride_secs + step_secs
        } else {
            0.0
        };
        self.held_secs = if self.ride_secs > RIDE_SECS {
            RIDE_HELD_SECS
        } else if turns > RIDE_RADPS {
            0.0
        } else {
            (self.held_secs - step_secs).max(0.0)
        };
    }

    /// Posture of the sensor now.
    pub(crate) fn posture(&self) -> Posture {
        let upright = self.up.normalize_or(self.standing_up).dot(self.standing_up);
        if self.still_secs > LIES_SECS && upright < LIES_COSINE {
            Posture::Lies
        } else if self.held_secs > 0.0 {
            Posture::Rides
        } else {
            Posture::Worn
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::TAU;
    use glam::Quat;

    /// Posture after a sensor has measured this for some seconds, a hundred times a second.
    fn after(secs: f32, measured: impl Fn(f32) -> (Vec3, Vec3)) -> Posture {
        let mut monitor = WearMonitor::new(Vec3::Y);
        for n in 0..(secs * 100.0) as u32 {
            let time = n as f32 * 0.01;
            let (force, rate) = measured(time);
            monitor.push(&ImuSample {
                time_secs: f64::from(time),
                force,
                rate,
            });
        }
        monitor.posture()
    }

    #[test]
    fn a_sensor_on_the_table_lies_and_one_on_somebody_who_stands_does_not() {
        let turned = |degrees: f32| {
            let up = Quat::from_rotation_z(degrees.to_radians()) * Vec3::Y;
            after(3.0, |_| (up * 9.9, Vec3::splat(0.02)))
        };
        assert_eq!([0.0, 30.0, 45.0].map(turned), [Posture::Worn; 3]);
        assert_eq!([70.0, 90.0, 180.0].map(turned), [Posture::Lies; 3]);
    }

    #[test]
    fn a_thigh_that_swings_through_the_level_does_not_lie() {
        // It ends where it is turned most.
        let swings = after(5.28, |time| {
            let angle = 1.4 * (TAU * time).sin();
            let rate = Vec3::X * (1.4 * TAU * (TAU * time).cos());
            (Quat::from_rotation_x(-angle) * Vec3::Y * 9.8, rate)
        });
        assert_eq!(swings, Posture::Worn);
    }

    #[test]
    fn a_scale_that_is_off_is_no_ride() {
        let still = |force: f32| after(6.0, |_| (Vec3::Y * force, Vec3::splat(0.01)));
        assert_eq!([9.0, 9.4, 10.3].map(still), [Posture::Worn; 3]);
    }

    #[test]
    fn a_lift_that_starts_rides_and_steps_do_not() {
        let lift = |secs: f32| {
            after(secs, |time| {
                let push = if (2.0..3.5).contains(&time) { 0.8 } else { 0.0 };
                (Vec3::Y * (9.7 + push), Vec3::ZERO)
            })
        };
        assert_eq!(lift(1.9), Posture::Worn);
        assert_eq!(lift(3.4), Posture::Rides);
        assert_eq!(lift(9.0), Posture::Worn, "it goes evenly");
        let steps = after(5.0, |time| {
            let phase = TAU * 1.8 * time;
            (Vec3::Y * (9.8 + 3.0 * phase.sin()), Vec3::X * phase.cos())
        });
        assert_eq!(steps, Posture::Worn);
    }
}
