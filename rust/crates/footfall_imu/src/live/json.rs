//! JSON messages of phone apps and hobby boards.
//!
//! - Android sensors as SensorServer and SensaGram name them: `{"type": "android.sensor.gyroscope", "timestamp": ns, "values": [x, y, z]}`.
//! - Sensor Logger: `{"payload": [{"name": "gyroscope", "time": ns, "values": {"x": …}}, …]}`, with "Standardise Units & Frames" on.
//! - ZIG SIM: `{"sensordata": {"accel": {"x": …}, "gravity": …, "gyro": …}}`, accelerations in g with iOS's sign.

use super::reading::{Quantity, Reading};
use crate::sample::GRAVITY_MPS2;
use glam::{Quat, Vec3};
use serde::Deserialize;
use std::borrow::Cow;

const NANOSECOND: f64 = 1e-9;

#[derive(Deserialize)]
struct Message<'a> {
    #[serde(borrow, rename = "type")]
    kind: Option<Cow<'a, str>>,
    timestamp: Option<Number>,
    values: Option<Vec<f64>>,
    #[serde(borrow)]
    payload: Option<Vec<Entry<'a>>>,
    sensordata: Option<SensorData>,
}

/// A number, or something else: ZIG SIM's times are dates, which are too coarse to be of use.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum Number {
    Number(f64),
    Other(serde::de::IgnoredAny),
}

impl Number {
    pub(super) const fn or_nan(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Other(_) => f64::NAN,
        }
    }
}

#[derive(Deserialize)]
struct Entry<'a> {
    #[serde(borrow)]
    name: Cow<'a, str>,
    time: f64,
    values: Axes,
}

#[derive(Deserialize)]
struct SensorData {
    accel: Option<Axes>,
    gravity: Option<Axes>,
    gyro: Option<Axes>,
}

#[derive(Clone, Copy, Deserialize)]
struct Axes {
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
    qx: Option<f64>,
    qy: Option<f64>,
    qz: Option<f64>,
    qw: Option<f64>,
}

impl Axes {
    fn vector(self) -> Option<Vec3> {
        Some(Vec3::new(self.x? as f32, self.y? as f32, self.z? as f32))
    }

    fn turn(self) -> Option<Quat> {
        let (x, y, z, w) = (self.qx?, self.qy?, self.qz?, self.qw?);
        Some(Quat::from_xyzw(x as f32, y as f32, z as f32, w as f32))
    }
}

/// Parses one message and gives its readings; false when it is none of these forms.
pub fn parse(text: &[u8], mut give: impl FnMut(Reading)) -> bool {
    let Ok(message) = serde_json::from_slice::<Message<'_>>(text) else {
        return false;
    };
    if let Some(values) = &message.values
        && let Some(kind) = message.kind.as_deref()
    {
        let time_secs = match message.timestamp {
            Some(Number::Number(nanos)) => Some(nanos * NANOSECOND),
            _ => None,
        };
        if let Some(quantity) = android(kind, values) {
            give(Reading {
                time_secs,
                quantity,
            });
        }
        return true;
    }
    if let Some(payload) = &message.payload {
        for entry in payload {
            if let Some(quantity) = sensor_logger(&entry.name, entry.values) {
                give(Reading {
                    time_secs: Some(entry.time * NANOSECOND),
                    quantity,
                });
            }
        }
        return true;
    }
    let Some(data) = &message.sensordata else {
        return false;
    };
    // iOS reports the force in the opposite direction.
    let vector = |axes: Option<Axes>| axes?.vector();
    let quantities = [
        vector(data.gravity).map(|g| Quantity::Gravity(-g * GRAVITY_MPS2)),
        vector(data.gyro).map(Quantity::Rate),
        vector(data.accel).map(|a| Quantity::Acceleration(-a * GRAVITY_MPS2)),
    ];
    for quantity in quantities.into_iter().flatten() {
        give(Reading {
            time_secs: None,
            quantity,
        });
    }
    true
}

fn android(kind: &str, values: &[f64]) -> Option<Quantity> {
    let at = |n: usize| values.get(n).map(|value| *value as f32);
    let vector = || Some(Vec3::new(at(0)?, at(1)?, at(2)?));
    let kind = kind.strip_prefix("android.sensor.").unwrap_or(kind);
    match kind {
        "accelerometer" => vector().map(Quantity::Force),
        "gyroscope" | "gyroscope_uncalibrated" => vector().map(Quantity::Rate),
        "linear_acceleration" => vector().map(Quantity::Acceleration),
        "gravity" => vector().map(Quantity::Gravity),
        "rotation_vector" | "game_rotation_vector" => {
            let v = vector()?;
            let w = at(3).unwrap_or_else(|| (1.0 - v.length_squared()).max(0.0).sqrt());
            Some(Quantity::Orientation(Quat::from_xyzw(v.x, v.y, v.z, w)))
        }
        _ => None,
    }
}

fn sensor_logger(name: &str, values: Axes) -> Option<Quantity> {
    match name {
        "totalacceleration" => values.vector().map(Quantity::Force),
        "accelerometer" => values.vector().map(Quantity::Acceleration),
        "gravity" => values.vector().map(Quantity::Gravity),
        "gyroscope" => values.vector().map(Quantity::Rate),
        "orientation" => values.turn().map(Quantity::Orientation),
        _ => None,
    }
}
