//! Lengths of the strides of a foot that wears a sensor: integration from the middle of a stance to the middle of the next.
//!
//! On the gaitmap example, against markers on the foot (61 strides, turns and half steps included): heel -1.4 cm in the mean with a spread of 4.4 cm,
//! 3.0 % mean absolute error; the outer forefoot of the right foot 2.4 %. gaitmap's own integration is 2.5 % on 52 of them, with a spread of 4.3 cm.

use crate::events::Swing;
use crate::filter::means_around;
use crate::sample::{GRAVITY_MPS2, ImuRecording};
use crate::zero_velocity::{REST_SECS, displacement};
use glam::Vec3;

/// Time from the swing within which the quietest moment of a stance is searched for, seconds.
const REST_REACH_SECS: f64 = 0.8;

/// A stride is no longer than this, seconds.
const LONGEST_SECS: f64 = 3.0;

/// One stride of the foot that wears the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorStride {
    /// When the foot rests before it, on the recording's clock, seconds.
    pub start_secs: f64,
    /// When it rests again.
    pub end_secs: f64,
    /// Distance covered along the ground, metres.
    pub length_m: f64,
}

/// Measures the stride of each swing. One without rest before and after it is left out.
pub fn measure_strides(recording: &ImuRecording, swings: &[Swing]) -> Vec<SensorStride> {
    let rate_hz = recording.rate_hz();
    let even = recording.evenly_spaced();
    let forces: Vec<Vec3> = even.samples.iter().map(|sample| sample.force).collect();
    let rates: Vec<Vec3> = even.samples.iter().map(|sample| sample.rate).collect();
    let quiet = Quiet::of(&forces, &rates, rate_hz);
    let bias = quiet.bias(&rates);
    let rates: Vec<Vec3> = rates.iter().map(|rate| *rate - bias).collect();
    let start = recording.start_secs();
    let frame = |secs: f64| ((secs - start) * rate_hz).round().max(0.0) as usize;
    let reach = (REST_REACH_SECS * rate_hz) as usize;
    let mut strides = Vec::new();
    for (n, swing) in swings.iter().enumerate() {
        let before = n
            .checked_sub(1)
            .map_or(0, |n| frame(swings[n].initial_secs));
        let after = swings
            .get(n + 1)
            .map_or(forces.len(), |next| frame(next.terminal_secs));
        let (terminal, initial) = (frame(swing.terminal_secs), frame(swing.initial_secs));
        let first = quiet.moment(before.max(terminal.saturating_sub(reach)), terminal);
        let last = quiet.moment(initial, after.min(initial + reach));
        let (Some(first), Some(last)) = (first, last) else {
            continue;
        };
        if (last - first) as f64 > LONGEST_SECS * rate_hz {
            continue;
        }
        let moved = displacement(&forces[first..=last], &rates[first..=last], rate_hz as f32);
        strides.push(SensorStride {
            start_secs: start + first as f64 / rate_hz,
            end_secs: start + last as f64 / rate_hz,
            length_m: f64::from(moved.way.with_y(0.0).length()),
        });
    }
    strides
}

/// Motion of the foot around each sample, within the time of a rest to either side.
struct Quiet {
    motion: Vec<f32>,
}

impl Quiet {
    fn of(forces: &[Vec3], rates: &[Vec3], rate_hz: f64) -> Self {
        let own = |(force, rate): (&Vec3, &Vec3)| {
            let off = force.length() / GRAVITY_MPS2 - 1.0;
            rate.length_squared() + 4.0 * off * off
        };
        let own: Vec<f32> = forces.iter().zip(rates).map(own).collect();
        let reach = (REST_SECS * rate_hz).round() as usize;
        Self {
            motion: means_around(&own, reach),
        }
    }

    /// The rate that is measured in the quietest twentieth of the recording, axis by axis the median.
    fn bias(&self, rates: &[Vec3]) -> Vec3 {
        let mut order: Vec<usize> = (0..rates.len()).collect();
        order.sort_by(|a, b| self.motion[*a].total_cmp(&self.motion[*b]));
        order.truncate((rates.len() / 20).max(1));
        let median = |axis: fn(&Vec3) -> f32| {
            let mut values: Vec<f32> = order.iter().map(|n| axis(&rates[*n])).collect();
            values.sort_by(f32::total_cmp);
            values[values.len() / 2]
        };
        Vec3::new(median(|v| v.x), median(|v| v.y), median(|v| v.z))
    }

    /// The quietest sample of a stance.
    fn moment(&self, first: usize, end: usize) -> Option<usize> {
        let end = end.min(self.motion.len());
        (first..end).min_by(|a, b| self.motion[*a].total_cmp(&self.motion[*b]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::ImuSample;
    use core::f32::consts::TAU;
    use glam::Quat;

    /// A foot that goes 1.3 m in the middle of four seconds, pitching and rising as it goes, with a biased gyroscope.
    fn stride(turn: Quat) -> (ImuRecording, Vec<Swing>) {
        let samples = (0..800).map(|n| {
            let time = n as f32 * 0.005;
            let phase = ((time - 1.6) / 0.8).clamp(0.0, 1.0);
            // The way is 1.3 (phase - sin(2π phase) / 2π) m, the height 0.1 (1 - cos(2π phase)) / 2 … both at rest at both ends.
            let forward = 1.3 * TAU * (TAU * phase).sin() / 0.64;
            let up = 0.05 * TAU * TAU * (TAU * phase).cos() / 0.64;
            let moving = f32::from(u8::from((0.001..0.999).contains(&phase)));
            let pitch = 0.4 * (1.0 - (TAU * phase).cos());
            let pitch_rate = 0.4 * TAU * (TAU * phase).sin() / 0.8;
            let foot_from_world = Quat::from_rotation_x(-pitch);
            let force = Vec3::new(0.0, GRAVITY_MPS2 + up * moving, forward * moving);
            ImuSample {
                time_secs: f64::from(time),
                force: turn * (foot_from_world * force),
                rate: turn * (Vec3::X * pitch_rate + Vec3::splat(0.005)),
            }
        });
        let recording = ImuRecording {
            samples: samples.collect(),
        };
        let swing = Swing {
            terminal_secs: 1.7,
            initial_secs: 2.35,
        };
        (recording, vec![swing])
    }

    #[test]
    fn a_stride_of_known_length_is_measured_in_any_mounting() {
        for turn in [Vec3::ZERO, Vec3::new(1.0, -2.0, 0.5)] {
            let (recording, swings) = stride(Quat::from_scaled_axis(turn));
            let strides = measure_strides(&recording, &swings);
            assert_eq!(strides.len(), 1);
            let length = strides[0].length_m;
            assert!((length - 1.3).abs() < 0.02, "{length} m");
            assert!(strides[0].start_secs < 1.6 && strides[0].end_secs > 2.4);
        }
    }
}
