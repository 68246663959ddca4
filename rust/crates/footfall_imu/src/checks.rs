//! Checks of a recording as a whole: units, dead axes, rate.

use crate::sample::{ImuRecording, ImuSample};
use footfall_core::rotation::exp_map;
use glam::{Quat, Vec3};

/// Lowest rate from which a gait can be reconstructed, samples a second.
pub const LEAST_RATE_HZ: f64 = 20.0;

/// Angular rate that no limb exceeds in 1 % of the time, rad/s; degrees in place of radians do.
const FASTEST_RADPS: f32 = 45.0;

/// Limit of the mean specific force's difference from gravity, m/s²: the change of velocity over a recording contributes to it.
const LEAST_FORCE: f32 = 3.5;
const MOST_FORCE: f32 = 20.0;

/// Time over which the angular rate is integrated, seconds: drift is small within it.
const MEAN_SECS: f64 = 8.0;

/// Names of the channels, in order.
const CHANNELS: [&str; 6] = ["ax", "ay", "az", "gx", "gy", "gz"];

/// Faults of a sensor's recording.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RecordingFault {
    /// Specific force is given in units of gravity.
    #[error(
        "the specific force has a mean of {mean:.2} in one direction: its unit is g; multiply ax, ay and az by 9.80665 to get m/s²"
    )]
    ForceInG {
        /// Magnitude of the mean.
        mean: f32,
    },
    /// Gravity is not in it, or the scale is another.
    #[error(
        "the specific force has a mean of {mean:.2} m/s² in one direction, gravity is 9.8; give ax, ay and az in m/s² including gravity"
    )]
    Force {
        /// Magnitude of the mean.
        mean: f32,
    },
    /// Angular rate is given in degrees.
    #[error(
        "the angular rate exceeds {high:.0} rad/s in 1 % of the time: its unit is degrees per second; multiply gx, gy and gz by 0.0174533"
    )]
    RateInDegrees {
        /// The magnitude that is exceeded.
        high: f32,
    },
    /// A channel never changes.
    #[error("{channel} has the same value in all {samples} samples; check the sensor's axis")]
    DeadAxis {
        /// Name of the column.
        channel: &'static str,
        /// Number of samples.
        samples: usize,
    },
    /// There are too few samples a second.
    #[error("there are {rate_hz:.1} samples a second; a gait needs {LEAST_RATE_HZ} or more")]
    Rate {
        /// Samples a second in the recording.
        rate_hz: f64,
    },
}

/// Checks units, axes and rate of a recording.
///
/// # Errors
/// [`RecordingFault`] says what is wrong and what to do.
pub fn check_recording(recording: &ImuRecording) -> Result<(), RecordingFault> {
    let samples = &recording.samples;
    let rate_hz = recording.rate_hz();
    // A recording without duration has no rate.
    if rate_hz.is_nan() || rate_hz < LEAST_RATE_HZ {
        return Err(RecordingFault::Rate { rate_hz });
    }
    let high = quantile(samples, 0.99, |sample| sample.rate.length());
    if high > FASTEST_RADPS {
        return Err(RecordingFault::RateInDegrees { high });
    }
    let mean = mean_force(samples);
    if !(LEAST_FORCE..MOST_FORCE).contains(&mean) {
        let median = quantile(samples, 0.5, |sample| sample.force.length());
        // Without gravity hardly anything is left in the mean; in units of gravity one is.
        return Err(if (0.4..2.0).contains(&mean) && mean > 0.3 * median {
            RecordingFault::ForceInG { mean }
        } else {
            RecordingFault::Force { mean }
        });
    }
    let rows = recording.channels();
    let varies = |channel: usize| {
        rows.iter()
            .any(|row| row[channel].to_bits() != rows[0][channel].to_bits())
    };
    let moving = (0..CHANNELS.len())
        .filter(|channel| varies(*channel))
        .count();
    // A sensor that lies still and is free of noise has no dead axis; one that moves has all of them.
    if moving >= 3
        && let Some(dead) = (0..CHANNELS.len()).find(|channel| !varies(*channel))
    {
        return Err(RecordingFault::DeadAxis {
            channel: CHANNELS[dead],
            samples: rows.len(),
        });
    }
    Ok(())
}

/// Magnitude of the mean of specific force in axes that do not turn.
fn mean_force(samples: &[ImuSample]) -> f32 {
    let mut turn = Quat::IDENTITY;
    let (mut sum, mut secs) = (Vec3::ZERO, 0.0_f32);
    for pair in samples.windows(2) {
        if f64::from(secs) > MEAN_SECS {
            break;
        }
        let dt = (pair[1].time_secs - pair[0].time_secs) as f32;
        sum += turn * (0.5 * (pair[0].force + pair[1].force)) * dt;
        turn = (turn * exp_map(0.5 * (pair[0].rate + pair[1].rate) * dt)).normalize();
        secs += dt;
    }
    sum.length() / secs.max(f32::MIN_POSITIVE)
}

/// The value below which the given share of a magnitude lies.
fn quantile(samples: &[ImuSample], share: f64, magnitude: impl Fn(&ImuSample) -> f32) -> f32 {
    let mut values: Vec<f32> = samples.iter().map(magnitude).collect();
    let place = ((values.len().saturating_sub(1)) as f64 * share).round() as usize;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(place, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::GRAVITY_MPS2;

    /// A limb that swings once a second, and is moved about.
    fn swinging(samples_a_sec: f64) -> ImuRecording {
        let samples = (0..(4.0 * samples_a_sec) as usize).map(|n| {
            let time_secs = n as f64 / samples_a_sec;
            let phase = (time_secs * core::f64::consts::TAU) as f32;
            let world_from_sensor = Quat::from_rotation_x(0.7 * phase.sin());
            let acceleration = Vec3::new(0.3 * phase.sin(), 6.0 * phase.cos(), 5.0 * phase.sin());
            let rate = Vec3::X * (0.7 * core::f32::consts::TAU * phase.cos());
            ImuSample {
                time_secs,
                force: world_from_sensor.inverse() * (acceleration + Vec3::Y * GRAVITY_MPS2),
                rate: rate + Vec3::new(0.0, 0.01 * phase.sin(), 0.01 * phase.cos()),
            }
        });
        ImuRecording {
            samples: samples.collect(),
        }
    }

    fn changed(change: impl Fn(&mut ImuSample)) -> Result<(), RecordingFault> {
        let mut recording = swinging(100.0);
        recording.samples.iter_mut().for_each(change);
        check_recording(&recording)
    }

    #[test]
    fn wrong_units_axes_and_rates_are_named() {
        assert_eq!(check_recording(&swinging(100.0)), Ok(()));
        let is = |result: Result<(), RecordingFault>, part: &str| {
            let text = result.unwrap_err().to_string();
            assert!(text.contains(part), "{text}");
        };
        is(changed(|s| s.force /= GRAVITY_MPS2), "unit is g");
        is(changed(|s| s.force *= 1000.0), "gravity is 9.8; give");
        let phase = |s: &ImuSample| (s.time_secs * core::f64::consts::TAU).sin() as f32;
        let gravity =
            |s: &ImuSample| Quat::from_rotation_x(-0.7 * phase(s)) * Vec3::Y * GRAVITY_MPS2;
        is(changed(|s| s.force -= gravity(s)), "including gravity");
        is(changed(|s| s.rate *= 57.3), "degrees");
        is(changed(|s| s.rate.z = 0.0), "gz");
        is(check_recording(&swinging(10.0)), "10.0 samples a second");
    }

    #[test]
    fn a_sensor_that_lies_still_without_noise_passes() {
        let still = changed(|s| {
            s.force = Vec3::Y * GRAVITY_MPS2;
            s.rate = Vec3::ZERO;
        });
        assert_eq!(still, Ok(()));
    }
}
