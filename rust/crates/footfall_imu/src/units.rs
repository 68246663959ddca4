//! Units of sensors, with the labels that headers of columns give them.

use crate::sample::GRAVITY_MPS2;

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

    pub(crate) fn of_label(label: &str) -> Option<Self> {
        match label.trim_matches(['_', '(', ')', '[', ']', ' ']) {
            "s" | "sec" | "seconds" => Some(Self::Second),
            "ms" | "millis" => Some(Self::Millisecond),
            "us" | "µs" | "micros" => Some(Self::Microsecond),
            _ => None,
        }
    }

    pub(crate) const fn seconds(self) -> f64 {
        match self {
            Self::Second => 1.0,
            Self::Millisecond => 1e-3,
            Self::Microsecond => 1e-6,
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

    pub(crate) fn of_label(label: &str) -> Option<Self> {
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

    pub(crate) fn mps2(self) -> f64 {
        let gravity = f64::from(GRAVITY_MPS2);
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::G => gravity,
            Self::MilliG => gravity * 1e-3,
            Self::Counts => gravity / COUNTS_PER_G,
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

    pub(crate) fn of_label(label: &str) -> Option<Self> {
        match label.trim_matches(['_', '(', ')', '[', ']', ' ']) {
            "rad" | "rads" | "radps" | "rad/s" | "rad_s" => Some(Self::RadianPerSecond),
            "deg" | "degs" | "dps" | "deg/s" | "deg_s" | "°/s" => Some(Self::DegreePerSecond),
            "raw" | "counts" | "lsb" => Some(Self::Counts),
            _ => None,
        }
    }

    pub(crate) fn radps(self) -> f64 {
        match self {
            Self::RadianPerSecond => 1.0,
            Self::DegreePerSecond => 1_f64.to_radians(),
            Self::Counts => 1_f64.to_radians() / COUNTS_PER_DPS,
        }
    }
}
