//! Orientation of a sensor, from its angular rate and from where gravity pulls when nothing else does.
//!
//! The angular rate is integrated, and specific force pulls the vertical to where it points: a Kalman filter with one variance for both tilts.
//! Specific force is the less trusted the more it differs from gravity and the faster the sensor turns, so that a first swing of a limb, in which
//! nothing points down, is forgotten at the first stance. The heading has no such reference: it drifts with what is left of the gyroscope's bias,
//! which is learned whenever the sensor rests.

use crate::sample::GRAVITY_MPS2;
use footfall_core::rotation::{exp_map, shortest_arc};
use glam::{Quat, Vec3};

/// Deviation of the vertical before anything is known, radians.
const INITIAL_TILT: f32 = 1.0;

/// Growth of the vertical's uncertainty, radians per root second: bias and scale errors of a consumer gyroscope.
const TILT_DRIFT: f32 = 0.02;

/// Deviation of what specific force says of the vertical, radians: always, for each unit of gravity that its magnitude is off, and
/// for each rad/s.
const FORCE_DEVIATION: [f32; 3] = [0.04, 2.5, 0.2];

/// Time over which errors of specific force are alike, seconds.
const FORCE_MEMORY_SECS: f32 = 0.1;

/// Below this rate, and this far from gravity at most, a sensor may rest: rad/s and share of gravity.
const REST: (f32, f32) = (0.12, 0.04);

/// For this long, before its rate counts as bias, seconds. Longer than a foot stands in a quick walk.
const REST_SECS: f32 = 0.8;

/// Time in which the bias is learned at rest, seconds.
const BIAS_SECS: f32 = 1.0;

/// Orientation of one sensor. Copies are cheap; [`step`](Self::step) allocates nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationFilter {
    world_from_sensor: Quat,
    bias: Vec3,
    tilt_variance: f32,
    rest_secs: f32,
}

impl OrientationFilter {
    /// A filter that starts with the vertical that the first specific force gives.
    pub fn new(force: Vec3) -> Self {
        Self {
            world_from_sensor: shortest_arc(force, Vec3::Y),
            bias: Vec3::ZERO,
            tilt_variance: INITIAL_TILT * INITIAL_TILT,
            rest_secs: 0.0,
        }
    }

    /// `world_from_sensor` rotation; Y is up, and the heading is relative to the first one.
    pub const fn world_from_sensor(&self) -> Quat {
        self.world_from_sensor
    }

    /// Up in the sensor's axes, a unit vector.
    pub fn up(&self) -> Vec3 {
        self.world_from_sensor.conjugate() * Vec3::Y
    }

    /// Standard deviation of the vertical, radians.
    pub fn tilt_deviation(&self) -> f32 {
        self.tilt_variance.sqrt()
    }

    /// Bias that is subtracted from the angular rate, rad/s.
    pub const fn bias(&self) -> Vec3 {
        self.bias
    }

    /// Goes on by `dt_secs`, in which specific force and angular rate had these means.
    pub fn step(&mut self, dt_secs: f32, force: Vec3, rate: Vec3) {
        let magnitude = force.length();
        let off_gravity = (magnitude / GRAVITY_MPS2 - 1.0).abs();
        let resting = (rate - self.bias).length() < REST.0 && off_gravity < REST.1;
        self.rest_secs = if resting {
            self.rest_secs + dt_secs
        } else {
            0.0
        };
        if self.rest_secs > REST_SECS {
            self.bias += (rate - self.bias) * (dt_secs / BIAS_SECS).min(1.0);
        }
        let unbiased = rate - self.bias;
        let turned = self.world_from_sensor * exp_map(unbiased * dt_secs);
        let [always, off, turning] = FORCE_DEVIATION;
        let doubt =
            always * always + (off * off_gravity).powi(2) + (turning * unbiased.length()).powi(2);
        self.tilt_variance += TILT_DRIFT * TILT_DRIFT * dt_secs;
        let share = self.tilt_variance * dt_secs
            / (self.tilt_variance * dt_secs + doubt * FORCE_MEMORY_SECS);
        self.tilt_variance *= 1.0 - share;
        let tilt = shortest_arc(turned * force, Vec3::Y);
        self.world_from_sensor = (Quat::IDENTITY.slerp(tilt, share) * turned).normalize();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_sensor_is_followed_and_a_bias_is_learned() {
        let bias = Vec3::new(0.02, -0.03, 0.01);
        let mut truth = exp_map(Vec3::new(0.4, 0.0, -0.2));
        let up = |turn: Quat| turn.conjugate() * Vec3::Y;
        let mut filter = OrientationFilter::new(up(truth) * GRAVITY_MPS2);
        for n in 0..3000 {
            let phase = n as f32 * 0.01;
            let rate = if n < 1000 {
                Vec3::ZERO
            } else {
                Vec3::new(2.0 * phase.sin(), 0.5, phase.cos())
            };
            truth *= exp_map(rate * 0.01);
            filter.step(0.01, up(truth) * GRAVITY_MPS2, rate + bias);
        }
        assert!(filter.up().distance(up(truth)) < 0.01);
        assert!(filter.bias().distance(bias) < 0.003, "{}", filter.bias());
    }

    #[test]
    fn a_wrong_start_is_forgotten() {
        let mut filter = OrientationFilter::new(Vec3::new(0.0, 9.0, 6.0));
        for _ in 0..100 {
            filter.step(0.01, Vec3::Y * GRAVITY_MPS2, Vec3::ZERO);
        }
        assert!(filter.up().distance(Vec3::Y) < 0.02, "{}", filter.up());
    }
}
