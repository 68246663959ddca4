//! Columns of lines of numbers, and JSON objects whose members are such columns.

use super::TextFormat;
use crate::columns::{Columns, Units};
use crate::live::json::Number;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;

/// Values of a line, in its own units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) time: Option<f64>,
    /// Specific force x, y, z, then angular rate x, y, z.
    pub(super) values: [f64; 6],
}

impl Units {
    /// Returns true when header and setting give everything, so that nothing has to be guessed.
    pub(super) const fn are_told(self, setting: &TextFormat, row: &Row) -> bool {
        let force = self.force.is_some() || setting.force.is_some();
        let rate = self.rate.is_some() || setting.rate.is_some();
        let time = self.time.is_some() || setting.time.is_some() || row.time.is_none();
        force && rate && time
    }
}

/// Columns of the quantities in a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LineColumns {
    /// The names of a stream whose every line has them.
    labels: Vec<String>,
    columns: Columns,
}

impl LineColumns {
    /// Columns of a header of names; `None` when it does not name all six axes.
    pub(super) fn of_header(line: &str) -> Option<Self> {
        // Numbers begin otherwise, and labelled lines are no header.
        let named = line.starts_with(|c: char| c.is_ascii_alphabetic() || c == '"');
        if !named || line.contains(':') {
            return None;
        }
        Columns::of_names(fields(line)).map(Self::unlabelled)
    }

    /// The usual order.
    fn of_count(count: usize) -> Option<Self> {
        let first = match count {
            0..=5 => return None,
            6 => 0,
            _ => 1,
        };
        Some(Self::unlabelled(Columns {
            time: (first == 1).then_some(0),
            values: core::array::from_fn(|n| first + n),
            units: Units::default(),
        }))
    }

    const fn unlabelled(columns: Columns) -> Self {
        Self {
            labels: Vec::new(),
            columns,
        }
    }

    /// Returns true when every line has the names of its columns.
    pub(super) const fn has_labels(&self) -> bool {
        !self.labels.is_empty()
    }

    pub(super) const fn units(&self) -> Units {
        self.columns.units
    }
}

/// Most columns that are looked at.
const MOST: usize = 32;

/// The numbers of a line; its columns become those of the stream when that has none yet, or when the line has labels of its own.
pub(super) fn row(text: &str, columns: &mut Option<LineColumns>) -> Option<Row> {
    let mut numbers = [0.0; MOST];
    let mut count = 0;
    if text.starts_with('{') {
        let members: Members<'_> = serde_json::from_str(text).ok()?;
        label(columns, members.0.iter().map(|(name, _)| &**name))?;
        for (place, (_, value)) in numbers.iter_mut().zip(&members.0) {
            *place = *value;
            count += 1;
        }
    } else {
        for (place, field) in numbers.iter_mut().zip(fields(text)) {
            let number = field.rsplit_once(':').map_or(field, |(_, number)| number);
            *place = number.trim().parse().ok()?;
            count += 1;
        }
        if text.contains(':') {
            let name = |field| str::split_once(field, ':').map_or(field, |(name, _)| name);
            label(columns, fields(text).map(name))?;
        } else if columns.is_none() {
            *columns = Some(LineColumns::of_count(count)?);
        }
    }
    let columns = &columns.as_ref()?.columns;
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

/// Makes the columns those of a line that has labels; mostly they are the ones before.
fn label<'a>(
    columns: &mut Option<LineColumns>,
    names: impl Iterator<Item = &'a str> + Clone,
) -> Option<()> {
    let known = columns
        .as_ref()
        .is_some_and(|columns| columns.labels.iter().map(String::as_str).eq(names.clone()));
    if !known {
        let labels = names.clone().map(str::to_owned).collect();
        *columns = Some(LineColumns {
            labels,
            columns: Columns::of_names(names)?,
        });
    }
    Some(())
}

/// The members of a flat object, in their order; what is no number is none.
struct Members<'a>(Vec<(Cow<'a, str>, f64)>);

impl<'de> Deserialize<'de> for Members<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(MembersVisitor)
    }
}

struct MembersVisitor;

impl<'de> Visitor<'de> for MembersVisitor {
    type Value = Members<'de>;

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members = Vec::with_capacity(8);
        while let Some(name) = map.next_key::<Name<'de>>()? {
            let value: Number = map.next_value()?;
            if members.len() < MOST {
                members.push((name.0, value.or_nan()));
            }
        }
        Ok(Members(members))
    }
}

/// A name that is taken from the text where it can be.
#[derive(Deserialize)]
#[serde(transparent)]
struct Name<'a>(#[serde(borrow)] Cow<'a, str>);

fn fields(line: &str) -> impl Iterator<Item = &str> + Clone {
    let separator = [',', ';', '\t'].into_iter().find(|c| line.contains(*c));
    let mut comma = separator.map(|c| line.split(c));
    let mut blank = line.split_whitespace();
    core::iter::from_fn(move || match &mut comma {
        Some(fields) => fields.next(),
        None => blank.next(),
    })
}
