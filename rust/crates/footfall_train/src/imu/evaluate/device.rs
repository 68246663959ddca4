//! Simulated sensors that bodies are reconstructed from.

use super::ImuClip;
use footfall_core::Site;
use footfall_imu::{ImuRecording, ImuSample};
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, simulate};
use glam::Vec3;

/// Steps in which browsers round a phone's measurements, m/s² and rad/s (0.1 °/s).
const PHONE_STEPS: [f32; 2] = [0.1, 0.1 * core::f32::consts::PI / 180.0];

/// Simulated sensor that bodies are reconstructed from. All have a phone's noise and biases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Device {
    /// 100 samples a second, as measured.
    #[default]
    Board,
    /// A phone's browser: 60 samples a second, rounded to 0.1 m/s² and 0.1 °/s.
    Phone,
    /// Uncalibrated board, on a loose strap ([`VirtualImuConfig::strapped`]).
    Strapped,
}

impl Device {
    /// Measurements of a sensor of this kind at a site of a moving body.
    pub(super) fn measure(self, clip: &ImuClip<'_>, site: Site, seed: u64) -> ImuRecording {
        let consumer = |rate_hz| VirtualImuConfig {
            noise: Some(SensorNoise::consumer(1.0)),
            seed,
            ..VirtualImuConfig::ideal(rate_hz)
        };
        let config = match self {
            Self::Board => consumer(100.0),
            Self::Phone => consumer(60.0),
            Self::Strapped => VirtualImuConfig::strapped(100.0, seed),
        };
        let measured = simulate(clip.clip, clip.first_frame, site, &config);
        let samples = measured.samples.into_iter();
        ImuRecording {
            samples: samples.map(|sample| self.round(sample)).collect(),
        }
    }

    /// A sample as the device reports it.
    fn round(self, sample: ImuSample) -> ImuSample {
        let to_steps = |value: Vec3, step: f32| (value / step).round() * step;
        match self {
            Self::Board | Self::Strapped => sample,
            Self::Phone => ImuSample {
                force: to_steps(sample.force, PHONE_STEPS[0]),
                rate: to_steps(sample.rate, PHONE_STEPS[1]),
                ..sample
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phone_rounds_what_it_measures() {
        let sample = ImuSample {
            time_secs: 0.5,
            force: Vec3::new(9.84, -0.06, 0.0),
            rate: Vec3::new(0.0, 1.26_f32.to_radians(), -0.04_f32.to_radians()),
        };
        let reported = Device::Phone.round(sample);
        assert!(reported.force.abs_diff_eq(Vec3::new(9.8, -0.1, 0.0), 1e-5));
        let expected = Vec3::new(0.0, 1.3_f32.to_radians(), 0.0);
        assert!(
            reported.rate.abs_diff_eq(expected, 1e-5),
            "{}",
            reported.rate
        );
        assert_eq!(Device::Board.round(sample), sample);
    }
}
