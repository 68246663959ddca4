//! Readings of devices in our units: m/s², rad/s, axes of the sensor.

use crate::sample::GRAVITY_MPS2;
use glam::{Quat, Vec3};

/// Degrees to radians, for rates in °/s.
pub(crate) const RADIANS: f32 = core::f32::consts::PI / 180.0;

/// One quantity at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The device's clock, seconds; `None` when it sends none, and the time of arrival has to do.
    pub time_secs: Option<f64>,
    /// Measured quantity and its value.
    pub quantity: Quantity,
}

/// Quantities that a device measures. Vectors are in the sensor's axes, which are right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Specific force, m/s²: gravity included, +9.81 along up at rest.
    Force(Vec3),
    /// Angular rate, rad/s.
    Rate(Vec3),
    /// Both at once.
    Both {
        /// Specific force, m/s².
        force: Vec3,
        /// Angular rate, rad/s.
        rate: Vec3,
    },
    /// Acceleration without gravity, m/s².
    Acceleration(Vec3),
    /// The specific force that the sensor would have at rest, m/s².
    Gravity(Vec3),
    /// `world_from_sensor` rotation, where the world's z points up.
    Orientation(Quat),
}

impl Quantity {
    /// Specific force in g and angular rate in °/s, as most serial devices have it.
    pub(crate) fn of_g_and_degrees(force: Vec3, rate: Vec3) -> Self {
        Self::Both {
            force: force * GRAVITY_MPS2,
            rate: rate * RADIANS,
        }
    }

    /// Returns true when every number is finite, and an orientation is one.
    pub(crate) fn is_sound(&self) -> bool {
        match self {
            Self::Force(v) | Self::Rate(v) | Self::Acceleration(v) | Self::Gravity(v) => {
                v.is_finite()
            }
            Self::Both { force, rate } => force.is_finite() && rate.is_finite(),
            Self::Orientation(q) => q.is_finite() && (q.length_squared() - 1.0).abs() < 0.1,
        }
    }
}
