//! Units of lines of numbers: given, or guessed from the numbers.

use super::TextFormat;
use super::columns::{Row, Units};
use crate::live::reading::{Quantity, RADIANS, Reading};
use crate::sample::GRAVITY_MPS2;
use glam::Vec3;

/// Counts of an MPU-6050 as it starts: ±2 g and ±250 °/s in 16 bits.
const COUNTS_PER_G: f64 = 16384.0;
const COUNTS_PER_DPS: f64 = 131.0;

/// Units of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// Seconds.
    Second,
    /// Milliseconds.
    Millisecond,
    /// Microseconds.
    Microsecond,
}

/// Units of specific force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceUnit {
    /// m/s².
    MetrePerSecondSquared,
    /// Standard gravity.
    G,
    /// Thousandths of it.
    MilliG,
    /// Counts of an MPU-6050 in its range of ±2 g.
    Counts,
}

/// Units of angular rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateUnit {
    /// rad/s.
    RadianPerSecond,
    /// °/s.
    DegreePerSecond,
    /// Counts of an MPU-6050 in its range of ±250 °/s.
    Counts,
}

impl TimeUnit {
    /// Its names on the command line.
    pub const NAMES: [(&str, Self); 3] = [
        ("s", Self::Second),
        ("ms", Self::Millisecond),
        ("us", Self::Microsecond),
    ];

    pub(super) fn of_label(label: &str) -> Option<Self> {
        match label.trim_matches(['_', '(', ')', '[', ']', ' ']) {
            "s" | "sec" | "seconds" => Some(Self::Second),
            "ms" | "millis" => Some(Self::Millisecond),
            "us" | "µs" | "micros" => Some(Self::Microsecond),
            _ => None,
        }
    }

    const fn seconds(self) -> f64 {
        match self {
            Self::Second => 1.0,
            Self::Millisecond => 1e-3,
            Self::Microsecond => 1e-6,
        }
    }

    /// From the step between two samples of 4 to 2000 a second.
    fn guess(step: f64) -> Self {
        match step {
            ..0.25 => Self::Second,
            0.25..250.0 => Self::Millisecond,
            _ => Self::Microsecond,
        }
    }
}

impl ForceUnit {
    /// Its names on the command line.
    pub const NAMES: [(&str, Self); 4] = [
        ("mps2", Self::MetrePerSecondSquared),
        ("g", Self::G),
        ("mg", Self::MilliG),
        ("counts", Self::Counts),
    ];

    pub(super) fn of_label(label: &str) -> Option<Self> {
        match label.trim_matches(['_', '(', ')', '[', ']', ' ']) {
            "g" => Some(Self::G),
            "mg" => Some(Self::MilliG),
            "raw" | "counts" | "lsb" => Some(Self::Counts),
            "mps2" | "m/s2" | "m/s^2" | "m/s²" | "ms2" | "m_s2" => {
                Some(Self::MetrePerSecondSquared)
            }
            _ => None,
        }
    }

    fn mps2(self) -> f64 {
        let gravity = f64::from(GRAVITY_MPS2);
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::G => gravity,
            Self::MilliG => gravity * 1e-3,
            Self::Counts => gravity / COUNTS_PER_G,
        }
    }

    /// From the median magnitude, which is near gravity.
    fn guess(magnitude: f64) -> Self {
        match magnitude {
            ..3.0 => Self::G,
            300.0..3000.0 => Self::MilliG,
            10_000.0..25_000.0 => Self::Counts,
            // Anything else is reported as a fault.
            _ => Self::MetrePerSecondSquared,
        }
    }
}

impl RateUnit {
    /// Its names on the command line.
    pub const NAMES: [(&str, Self); 3] = [
        ("radps", Self::RadianPerSecond),
        ("dps", Self::DegreePerSecond),
        ("counts", Self::Counts),
    ];

    pub(super) fn of_label(label: &str) -> Option<Self> {
        match label.trim_matches(['_', '(', ')', '[', ']', ' ']) {
            "rad" | "rads" | "radps" | "rad/s" | "rad_s" => Some(Self::RadianPerSecond),
            "deg" | "degs" | "dps" | "deg/s" | "deg_s" | "°/s" => Some(Self::DegreePerSecond),
            "raw" | "counts" | "lsb" => Some(Self::Counts),
            _ => None,
        }
    }

    fn radps(self) -> f64 {
        match self {
            Self::RadianPerSecond => 1.0,
            Self::DegreePerSecond => f64::from(RADIANS),
            Self::Counts => f64::from(RADIANS) / COUNTS_PER_DPS,
        }
    }

    /// Libraries that give forces in m/s² give rates in rad/s; the others give degrees.
    const fn beside(force: ForceUnit) -> Self {
        match force {
            ForceUnit::MetrePerSecondSquared => Self::RadianPerSecond,
            ForceUnit::G | ForceUnit::MilliG => Self::DegreePerSecond,
            ForceUnit::Counts => Self::Counts,
        }
    }
}

/// Factors from a line's units to ours.
pub(super) struct Scale {
    time: f64,
    force: f64,
    rate: f64,
}

impl Scale {
    /// Units from the setting, else from the header, else from the numbers.
    pub(super) fn new(setting: &TextFormat, header: Units, rows: &[Row]) -> Self {
        let magnitude = |row: &Row| {
            let [x, y, z, ..] = row.values;
            x.hypot(y).hypot(z)
        };
        let step = |pair: &[Row]| Some((pair[1].time? - pair[0].time?).abs());
        let force = setting.force.or(header.force);
        let force = force.unwrap_or_else(|| ForceUnit::guess(median(rows.iter().map(magnitude))));
        let time = setting.time.or(header.time);
        let time =
            time.unwrap_or_else(|| TimeUnit::guess(median(rows.windows(2).filter_map(step))));
        let rate = setting.rate.or(header.rate);
        let rate = rate.unwrap_or_else(|| RateUnit::beside(force));
        Self {
            time: time.seconds(),
            force: force.mps2(),
            rate: rate.radps(),
        }
    }

    pub(super) fn reading(&self, row: &Row) -> Reading {
        let [ax, ay, az, gx, gy, gz] = row.values;
        let vector = |values: [f64; 3], scale: f64| {
            Vec3::from_array(values.map(|value| (value * scale) as f32))
        };
        Reading {
            time_secs: row.time.map(|time| time * self.time),
            quantity: Quantity::Both {
                force: vector([ax, ay, az], self.force),
                rate: vector([gx, gy, gz], self.rate),
            },
        }
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
