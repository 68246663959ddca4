//! Columns of lines of numbers, and JSON objects whose members are such columns.

use super::TextFormat;
use super::units::{ForceUnit, RateUnit, TimeUnit};

/// What a line holds, in its own units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) time: Option<f64>,
    /// Specific force x, y, z, then angular rate x, y, z.
    pub(super) values: [f64; 6],
}

/// Units that a header tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Units {
    pub(super) time: Option<TimeUnit>,
    pub(super) force: Option<ForceUnit>,
    pub(super) rate: Option<RateUnit>,
}

impl Units {
    /// Whether header and setting tell everything, so that nothing has to be guessed.
    pub(super) fn are_told(&self, setting: &TextFormat, row: &Row) -> bool {
        let force = self.force.is_some() || setting.force.is_some();
        let rate = self.rate.is_some() || setting.rate.is_some();
        let time = self.time.is_some() || setting.time.is_some() || row.time.is_none();
        force && rate && time
    }
}

/// Where each quantity stands in a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Columns {
    time: Option<usize>,
    values: [usize; 6],
    units: Units,
}

/// What a column is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Channel {
    Time,
    Value(usize),
    Other,
}

impl Columns {
    /// What a header of names tells; `None` when it does not name all six axes.
    pub(super) fn of_header(line: &str) -> Option<Self> {
        let named = line.contains(|c: char| c.is_ascii_alphabetic());
        if !named || line.starts_with('{') || line.contains(':') {
            return None;
        }
        Self::of_names(fields(line))
    }

    fn of_names<'a>(names: impl Iterator<Item = &'a str>) -> Option<Self> {
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

    /// The usual order.
    fn of_count(count: usize) -> Option<Self> {
        let first = match count {
            0..=5 => return None,
            6 => 0,
            _ => 1,
        };
        Some(Self {
            time: (first == 1).then_some(0),
            values: core::array::from_fn(|n| first + n),
            units: Units::default(),
        })
    }

    pub(super) const fn units(&self) -> Units {
        self.units
    }
}

/// Most columns that are looked at.
const MOST: usize = 32;

/// The numbers of a line; its columns become those of the stream when that has none yet.
pub(super) fn row(text: &str, columns: &mut Option<Columns>) -> Option<Row> {
    let mut numbers = [0.0; MOST];
    let mut count = 0;
    if text.starts_with('{') {
        // A flat object: its members are labelled columns.
        let object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(text).ok()?;
        for (place, value) in numbers.iter_mut().zip(object.values()) {
            *place = value.as_f64().unwrap_or(f64::NAN);
            count += 1;
        }
        // Members may come and go.
        *columns = Some(Columns::of_names(object.keys().map(String::as_str))?);
    } else {
        let labelled = text.contains(':');
        for (place, field) in numbers.iter_mut().zip(fields(text)) {
            let number = field.rsplit_once(':').map_or(field, |(_, number)| number);
            *place = number.trim().parse().ok()?;
            count += 1;
        }
        if labelled {
            let name = |field| str::split_once(field, ':').map_or(field, |(name, _)| name);
            *columns = Some(Columns::of_names(fields(text).map(name))?);
        } else if columns.is_none() {
            *columns = Some(Columns::of_count(count)?);
        }
    }
    let columns = columns.as_ref()?;
    let at = |place: usize| {
        (place < count)
            .then(|| numbers[place])
            .filter(|n| n.is_finite())
    };
    let mut values = [0.0; 6];
    for (value, place) in values.iter_mut().zip(columns.values) {
        *value = at(place)?;
    }
    let time = match columns.time {
        Some(place) => Some(at(place)?),
        None => None,
    };
    Some(Row { time, values })
}

fn fields(line: &str) -> impl Iterator<Item = &str> {
    let separator = [',', ';', '\t'].into_iter().find(|c| line.contains(*c));
    let mut comma = separator.map(|c| line.split(c));
    let mut blank = line.split_whitespace();
    core::iter::from_fn(move || match &mut comma {
        Some(fields) => fields.next(),
        None => blank.next(),
    })
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
