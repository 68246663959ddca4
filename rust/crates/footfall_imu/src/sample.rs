//! Samples and recordings of one sensor.

use glam::{Quat, Vec3};

/// Standard gravity, m/s².
pub const GRAVITY_MPS2: f32 = 9.806_65;

/// What a sensor measures at one time, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuSample {
    /// The sensor's clock, seconds.
    pub time_secs: f64,
    /// Specific force, m/s²: acceleration less the acceleration of free fall.
    pub force: Vec3,
    /// Angular rate, rad/s.
    pub rate: Vec3,
}

impl ImuSample {
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.time_secs.is_finite() && self.force.is_finite() && self.rate.is_finite()
    }

    /// The same sample in other axes.
    #[must_use]
    pub fn turned(&self, axes_from_sensor: Quat) -> Self {
        Self {
            time_secs: self.time_secs,
            force: axes_from_sensor * self.force,
            rate: axes_from_sensor * self.rate,
        }
    }
}

/// A recording of one sensor: at least two samples whose times rise.
#[derive(Clone, Debug, PartialEq)]
pub struct ImuRecording {
    /// In the order of their times.
    pub samples: Vec<ImuSample>,
}

impl ImuRecording {
    /// Samples per second: the number of steps in time over the whole time.
    pub fn rate_hz(&self) -> f64 {
        (self.samples.len().saturating_sub(1)) as f64 / self.duration_secs()
    }

    /// Time of the first sample, seconds.
    pub fn start_secs(&self) -> f64 {
        self.samples.first().map_or(0.0, |sample| sample.time_secs)
    }

    /// From the first sample to the last, seconds.
    pub fn duration_secs(&self) -> f64 {
        let last = self.samples.last().map_or(0.0, |sample| sample.time_secs);
        last - self.start_secs()
    }

    /// Specific force x, y, z, then angular rate x, y, z of every sample.
    pub fn channels(&self) -> Vec<[f64; 6]> {
        let row = |sample: &ImuSample| {
            let (force, rate) = (sample.force.as_dvec3(), sample.rate.as_dvec3());
            [force.x, force.y, force.z, rate.x, rate.y, rate.z]
        };
        self.samples.iter().map(row).collect()
    }

    /// The recording in other axes.
    #[must_use]
    pub fn turned(&self, axes_from_sensor: Quat) -> Self {
        let turned = self.samples.iter().map(|s| s.turned(axes_from_sensor));
        Self {
            samples: turned.collect(),
        }
    }
}
