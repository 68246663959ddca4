//! Measurements of a sensor, from the poses of an object that is tracked in space.
//!
//! A headset's or a tracker's pose holds what an inertial sensor on it would measure: its second derivative and gravity are the specific force, its turning is the
//! angular rate. Positions are differentiated by the parabola that fits a window of them best (Savitzky and Golay 1964, here for times of any spacing), as wide as the
//! one of simulated sensors, so that both are band-limited alike. A sample is of the middle of the window, half of it ago.

use crate::sample::{GRAVITY_MPS2, ImuSample};
use footfall_core::rotation::log_map;
use glam::{Mat3, Quat, Vec3};
use std::collections::VecDeque;

/// Length of the window over which a position is differentiated twice, seconds.
const WINDOW_SECS: f64 = 0.068;

/// Half of the time over which an orientation is differentiated, seconds.
const RATE_HALF_SECS: f64 = 0.017;

/// Poses that follow each other sooner than this are thinned out, seconds.
const LEAST_STEP_SECS: f64 = 0.003;

/// Gap after which the window restarts, seconds.
const GAP_SECS: f64 = 0.2;

/// Fastest motion of a body, m/s and rad/s. Faster changes are teleports, which restart the window.
const FASTEST_MPS: f32 = 20.0;
const FASTEST_RADPS: f32 = 35.0;

/// A parabola has three coefficients.
const LEAST_POSES: usize = 3;

/// Position and orientation of an object at one time.
#[derive(Clone, Copy, Debug)]
struct TimedPose {
    secs: f64,
    position: Vec3,
    turn: Quat,
}

/// Samples of the sensor that a tracked object would carry.
#[derive(Clone, Debug)]
pub struct PoseMeter {
    window: VecDeque<TimedPose>,
}

impl Default for PoseMeter {
    fn default() -> Self {
        Self {
            window: VecDeque::with_capacity((WINDOW_SECS / LEAST_STEP_SECS) as usize + 2),
        }
    }
}

impl PoseMeter {
    /// Adds the next pose: `time_secs` rises, `position` is in metres with y up, `world_from_sensor` is the orientation of the sensor's axes.
    ///
    /// Returns the sample of the middle of the window, up to 34 ms ago, or `None` while it has fewer than three poses. A pose that is not finite, or
    /// within 3 ms of the last or before it, returns none either; a teleport or a gap in time restarts the window.
    pub fn push(
        &mut self,
        time_secs: f64,
        position: Vec3,
        world_from_sensor: Quat,
    ) -> Option<ImuSample> {
        let pose = TimedPose {
            secs: time_secs,
            position,
            turn: world_from_sensor,
        };
        if !(time_secs.is_finite() && position.is_finite() && world_from_sensor.is_finite()) {
            return None;
        }
        if let Some(last) = self.window.back() {
            let step_secs = time_secs - last.secs;
            if step_secs < 0.0 || pose.is_apart_from(last, step_secs) {
                self.window.clear();
            } else if step_secs < LEAST_STEP_SECS {
                return None;
            }
        }
        self.window.push_back(pose);
        while self.window.len() > LEAST_POSES && time_secs - self.window[1].secs >= WINDOW_SECS {
            self.window.pop_front();
        }
        (self.window.len() >= LEAST_POSES).then(|| self.sample())
    }

    fn sample(&self) -> ImuSample {
        let (first, last) = (self.window[0].secs, self.window[self.window.len() - 1].secs);
        let middle = 0.5 * (first + last);
        let half = RATE_HALF_SECS.min(0.5 * (last - first));
        let [before, now, after] = [-half, 0.0, half].map(|offset| self.turn_at(middle + offset));
        ImuSample {
            time_secs: middle,
            force: now.inverse() * (self.acceleration(middle) + Vec3::Y * GRAVITY_MPS2),
            rate: log_map(before.inverse() * after) / (2.0 * half) as f32,
        }
    }

    /// Second derivative of the parabola that fits the positions best.
    fn acceleration(&self, middle: f64) -> Vec3 {
        let unit_secs = 0.5 * WINDOW_SECS;
        let (mut normal, mut moments) = (Mat3::ZERO, Mat3::ZERO);
        let origin = self.window[0].position;
        for pose in &self.window {
            let t = ((pose.secs - middle) / unit_secs) as f32;
            let powers = Vec3::new(1.0, t, t * t);
            // Relative to the first: positions are large, their differences small.
            let offset = pose.position - origin;
            normal += Mat3::from_cols(powers * powers.x, powers * powers.y, powers * powers.z);
            moments += Mat3::from_cols(powers * offset.x, powers * offset.y, powers * offset.z);
        }
        let coefficients = normal.inverse() * moments;
        coefficients.row(2) * (2.0 / (unit_secs * unit_secs)) as f32
    }

    /// Orientation between two poses of the window.
    fn turn_at(&self, secs: f64) -> Quat {
        let next = self.window.partition_point(|pose| pose.secs < secs);
        let next = next.clamp(1, self.window.len() - 1);
        let [before, after] = [self.window[next - 1], self.window[next]];
        let share = (secs - before.secs) / (after.secs - before.secs);
        before.turn.slerp(after.turn, share.clamp(0.0, 1.0) as f32)
    }
}

impl TimedPose {
    /// Returns true when no body goes from one pose to the other in this time.
    fn is_apart_from(&self, last: &Self, step_secs: f64) -> bool {
        let secs = step_secs.max(LEAST_STEP_SECS) as f32;
        step_secs > GAP_SECS
            || self.position.distance(last.position) > FASTEST_MPS * secs
            || self.turn.angle_between(last.turn) > FASTEST_RADPS * secs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    /// Position and orientation of an object on a circle of 30 cm, which looks along its way.
    fn circling(secs: f64) -> (Vec3, Quat) {
        let angle = 3.0 * secs as f32;
        let place = Vec3::new(0.3 * angle.cos(), 1.7, -0.3 * angle.sin());
        (place, Quat::from_rotation_y(angle))
    }

    #[test]
    fn a_circle_is_measured_at_frames_of_any_rate() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        for rate_hz in [45.0, 60.0, 90.0, 144.0, 1000.0] {
            let mut meter = PoseMeter::default();
            let mut secs = 100.0;
            let mut samples = Vec::new();
            while secs < 102.0 {
                let (place, turn) = circling(secs);
                samples.extend(meter.push(secs, place, turn));
                // Frames are never of one length.
                secs += random.random_range(0.7..1.3) / rate_hz;
            }
            assert!(samples.len() > 60, "{rate_hz} Hz: {}", samples.len());
            for sample in &samples {
                // In its own axes the centre lies to the object's -x: 9 rad²/s² of 30 cm.
                let expected = Vec3::new(-2.7, GRAVITY_MPS2, 0.0);
                let off = sample.force.distance(expected);
                assert!(off < 0.25, "{rate_hz} Hz: {}", sample.force);
                assert!(
                    sample.rate.distance(Vec3::Y * 3.0) < 0.01,
                    "{}",
                    sample.rate
                );
            }
            assert!(samples.is_sorted_by(|a, b| a.time_secs < b.time_secs));
        }
    }

    #[test]
    fn jumps_gaps_and_nonsense_leave_no_sample_behind() {
        let mut meter = PoseMeter::default();
        let still = |meter: &mut PoseMeter, from: f64, place: Vec3, turn: Quat| {
            let frames = (0..20).map(|n| from + f64::from(n) / 60.0);
            frames
                .filter_map(|secs| meter.push(secs, place, turn))
                .collect::<Vec<_>>()
        };
        let turned = Quat::from_rotation_y(1.5);
        let mut samples = still(&mut meter, 0.0, Vec3::ZERO, Quat::IDENTITY);
        assert_eq!(meter.push(0.32, Vec3::NAN, Quat::IDENTITY), None);
        assert_eq!(meter.push(f64::NAN, Vec3::ZERO, Quat::IDENTITY), None);
        samples.extend(still(&mut meter, 0.34, Vec3::X * 5.0, Quat::IDENTITY));
        samples.extend(still(&mut meter, 0.68, Vec3::X * 5.0, turned));
        samples.extend(still(&mut meter, 60.0, Vec3::X * 7.0, turned));
        // A clock that is set back.
        samples.extend(still(&mut meter, 0.0, Vec3::X * 7.0, turned));
        assert_eq!(samples.len(), 5 * 18);
        for sample in samples {
            let off = sample.force.distance(Vec3::Y * GRAVITY_MPS2);
            assert!(off < 1e-3 && sample.rate.length() < 1e-3, "{sample:?}");
        }
    }
}
