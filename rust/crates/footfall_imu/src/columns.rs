//! Columns of measurements, found by the names and units in a header.

use crate::units::{ForceUnit, RateUnit, TimeUnit};

/// Units that a header names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Units {
    pub(crate) time: Option<TimeUnit>,
    pub(crate) force: Option<ForceUnit>,
    pub(crate) rate: Option<RateUnit>,
}

/// Places of the quantities among the columns that a header names, as `time_ms,accX_g,gyro_x_dps` or `Time (s),Gyroscope X (deg/s)` do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Columns {
    pub(crate) time: Option<usize>,
    /// Specific force x, y, z, then angular rate x, y, z.
    pub(crate) values: [usize; 6],
    pub(crate) units: Units,
}

/// Meaning of a column.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Channel {
    Time,
    Value(usize),
    Other,
}

impl Columns {
    /// Returns the columns of these names; `None` if they do not name all six axes. The first of two columns of a quantity counts.
    pub(crate) fn of_names<'a>(names: impl Iterator<Item = &'a str>) -> Option<Self> {
        let mut units = Units::default();
        let mut time = None;
        let mut values = [None; 6];
        for (place, name) in names.enumerate() {
            match channel(name, &mut units) {
                Channel::Time => time = time.or(Some(place)),
                Channel::Value(n) => values[n] = values[n].or(Some(place)),
                Channel::Other => {}
            }
        }
        let mut found = [0; 6];
        for (found, place) in found.iter_mut().zip(values) {
            *found = place?;
        }
        Some(Self {
            time,
            values: found,
            units,
        })
    }
}

/// Names of a quantity, longest first: what follows is an axis.
const FORCE_NAMES: [&str; 6] = [
    "acceleration",
    "accelerometer",
    "accel",
    "acc",
    "force",
    "a",
];
const RATE_NAMES: [&str; 7] = ["gyroscope", "gyro", "gyr", "omega", "rate", "g", "w"];
const TIME_NAMES: [&str; 8] = [
    "timestamp",
    "time",
    "millis",
    "micros",
    "seconds",
    "ms",
    "us",
    "t",
];

fn channel(name: &str, units: &mut Units) -> Channel {
    let name = name.trim().trim_matches('"').to_ascii_lowercase();
    let axis_after = |names: &[&str]| {
        names.iter().find_map(|prefix| {
            let rest = name
                .strip_prefix(prefix)?
                .trim_start_matches(['_', ' ', '.']);
            let axis = rest.chars().next().and_then(|axis| "xyz".find(axis))?;
            let unit = &rest[1..];
            // "accelerate" is no axis.
            (!unit.starts_with(|c: char| c.is_ascii_alphanumeric()))
                .then(|| (axis, unit.to_owned()))
        })
    };
    if let Some((axis, unit)) = axis_after(&FORCE_NAMES) {
        units.force = units.force.or_else(|| ForceUnit::of_label(&unit));
        return Channel::Value(axis);
    }
    if let Some((axis, unit)) = axis_after(&RATE_NAMES) {
        units.rate = units.rate.or_else(|| RateUnit::of_label(&unit));
        return Channel::Value(3 + axis);
    }
    let time = TIME_NAMES.iter().find_map(|prefix| {
        let rest = name.strip_prefix(prefix)?;
        (!rest.starts_with(|c: char| c.is_ascii_alphanumeric())).then_some((*prefix, rest))
    });
    if let Some((prefix, rest)) = time {
        units.time = units
            .time
            .or_else(|| TimeUnit::of_label(prefix))
            .or_else(|| TimeUnit::of_label(rest));
        return Channel::Time;
    }
    Channel::Other
}
