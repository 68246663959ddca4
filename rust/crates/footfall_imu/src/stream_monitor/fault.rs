//! Faults of a stream of samples.

use crate::checks::LEAST_RATE_HZ;

/// Fault of a sensor's samples.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StreamFault {
    /// Specific force is given in units of gravity.
    #[error(
        "the sensor at rest measures {rest:.2}, gravity is 9.81 m/s²: its unit is g; multiply its acceleration by 9.80665"
    )]
    ForceInG {
        /// Magnitude of specific force at rest.
        rest: f32,
    },
    /// Specific force at rest is no gravity.
    #[error(
        "the sensor at rest measures {rest:.2} m/s², gravity is 9.81; send acceleration in m/s² including gravity, or calibrate the accelerometer"
    )]
    Gravity {
        /// Magnitude of specific force at rest, m/s².
        rest: f32,
    },
    /// Angular rate is given in degrees.
    #[error(
        "the sensor reports {high:.0} rad/s, faster than any limb: its unit is degrees; multiply its angular rate by 0.0174533"
    )]
    RateInDegrees {
        /// The magnitude that was reached.
        high: f32,
    },
    /// An axis does not change while the others do.
    #[error(
        "{axis} stays at {value:.2} while the sensor moves: the axis is stuck; restart the sensor, or replace it if that does not help"
    )]
    StuckAxis {
        /// Name of the axis: `ax` to `gz`.
        axis: &'static str,
        /// The value that it keeps.
        value: f32,
    },
    /// An axis reaches the end of the sensor's range again and again.
    #[error(
        "{axis} repeatedly stops at {value:.1}: its range is too small; set the sensor to ±8 g and ±1000 °/s or more"
    )]
    Saturated {
        /// Name of the axis.
        axis: &'static str,
        /// The end that it reaches, m/s² or rad/s.
        value: f32,
    },
    /// The sample rate is too low for a gait.
    #[error(
        "the sensor sends only {rate_hz:.0} samples a second, a gait needs {LEAST_RATE_HZ}; move sensor and receiver closer together, or set the sensor to 100"
    )]
    Slow {
        /// Samples a second.
        rate_hz: f32,
    },
    /// The sample rate is far from the promised one.
    #[error(
        "the sensor sends {rate_hz:.0} samples a second instead of {promised_hz:.0}; check its rate, its battery and the connection"
    )]
    Pace {
        /// Samples a second.
        rate_hz: f32,
        /// Promised rate, or that of the beginning.
        promised_hz: f32,
    },
}

impl StreamFault {
    /// The name for scripts and reports, for example `stuck_axis`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::ForceInG { .. } => "force_in_g",
            Self::Gravity { .. } => "gravity",
            Self::RateInDegrees { .. } => "rate_in_degrees",
            Self::StuckAxis { .. } => "stuck_axis",
            Self::Saturated { .. } => "saturated",
            Self::Slow { .. } => "slow",
            Self::Pace { .. } => "pace",
        }
    }

    /// Returns true when the samples are unusable, so that the body should stand.
    pub const fn is_blinding(&self) -> bool {
        !matches!(self, Self::Saturated { .. } | Self::Pace { .. })
    }

    /// Returns true when both are the same fault, of the same axis, whatever their figures.
    pub fn is_alike(&self, other: &Self) -> bool {
        let axis = |fault: &Self| match fault {
            Self::StuckAxis { axis, .. } | Self::Saturated { axis, .. } => Some(*axis),
            _ => None,
        };
        self.name() == other.name() && axis(self) == axis(other)
    }
}

/// Names of the channels, in order.
pub(super) const NAMES: [&str; super::CHANNELS] = ["ax", "ay", "az", "gx", "gy", "gz"];
