//! Units of lines of numbers: given, or guessed from the numbers.

use super::TextFormat;
use super::columns::Row;
use crate::columns::Units;
use crate::live::reading::{Quantity, Reading};
use crate::units::{ForceUnit, RateUnit, TimeUnit};
use glam::Vec3;

impl TimeUnit {
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
