//! Samples and recordings of one sensor.

use glam::{Quat, Vec3};

/// Standard gravity, m/s².
pub const GRAVITY_MPS2: f32 = 9.806_65;

/// Measurement of a sensor at one time, in its own axes.
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
    /// Measurement of a sensor on a standing person, in axes whose +Y is up.
    pub const fn standing(time_secs: f64) -> Self {
        Self {
            time_secs,
            force: Vec3::new(0.0, GRAVITY_MPS2, 0.0),
            rate: Vec3::ZERO,
        }
    }

    /// Returns true for a sample that was put in the place of an unusable one: no sensor measures [`standing`](Self::standing) to the bit.
    pub fn is_stand_in(&self) -> bool {
        let stand_in = Self::standing(self.time_secs);
        self.force == stand_in.force && self.rate == stand_in.rate
    }

    /// Returns true when every number is finite.
    pub fn is_finite(&self) -> bool {
        self.time_secs.is_finite() && self.force.is_finite() && self.rate.is_finite()
    }

    /// Linear interpolation to a later sample, at a time between both.
    pub(crate) fn towards(&self, later: &Self, time_secs: f64) -> Self {
        let share = (time_secs - self.time_secs) / (later.time_secs - self.time_secs);
        let share = share.clamp(0.0, 1.0) as f32;
        Self {
            time_secs,
            force: self.force.lerp(later.force, share),
            rate: self.rate.lerp(later.rate, share),
        }
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

/// A recording of one sensor: samples at rising times. Files hold at least two.
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

    /// Measurement at a time, interpolated linearly; the nearest sample beyond the ends, and zeros where there is none.
    #[must_use]
    pub fn at(&self, time_secs: f64) -> ImuSample {
        let after = self
            .samples
            .partition_point(|sample| sample.time_secs <= time_secs);
        let before = after.checked_sub(1).and_then(|n| self.samples.get(n));
        match (before, self.samples.get(after)) {
            (Some(before), Some(after)) => before.towards(after, time_secs),
            (Some(nearest), None) | (None, Some(nearest)) => ImuSample {
                time_secs,
                ..*nearest
            },
            (None, None) => ImuSample {
                time_secs,
                force: Vec3::ZERO,
                rate: Vec3::ZERO,
            },
        }
    }

    /// Returns as many samples at even intervals by linear interpolation: lost samples leave no gap.
    #[must_use]
    pub fn evenly_spaced(&self) -> Self {
        let (rate_hz, start) = (self.rate_hz(), self.start_secs());
        if self.samples.len() < 2 {
            return self.clone();
        }
        let even = (0..self.samples.len()).map(|n| self.at(start + n as f64 / rate_hz));
        Self {
            samples: even.collect(),
        }
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
