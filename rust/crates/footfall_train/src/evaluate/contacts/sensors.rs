//! Switches and swings of foot sensors against the events of a reference.

use super::bodies::Bodies;
use super::{Agreement, ContactsError};
use footfall_core::{EventKind, Side};
use footfall_imu::csv;
use footfall_imu::events::{detect_swings, events_of};
use footfall_motion::corpus::{IndexRow, read_index};
use footfall_motion::sensor_switches::detect_sensor_switches;
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Time outside of the known events beyond which events are not judged, seconds: the reference may not cover it.
const MARGIN_SECS: f64 = 0.2;

/// The column that names a recording's events.
const EVENTS_COLUMN: &str = "events";

/// The column that names the foot that wears the sensor.
const FOOT_COLUMN: &str = "foot";

/// Events in time, seconds.
type Times = Vec<(f64, EventKind)>;

#[derive(Deserialize)]
struct Events {
    events: Vec<Event>,
}

#[derive(Deserialize)]
struct Event {
    time_s: f64,
    /// The foot that wears the sensor if absent.
    foot: Option<String>,
    kind: String,
}

/// A recording's known events, and those that each detector has found.
struct Judged {
    category: String,
    worn: Side,
    known: Vec<Event>,
    /// Name of the detector, the foot whose events it has found, and these.
    found: Vec<(&'static str, Side, Times)>,
}

/// Agreement of every recording of an index, by category, kind of contact and detector; with a model, that of the bodies that the
/// recordings drive as well.
pub(super) fn compare(
    index: &Path,
    bodies: Option<&Bodies>,
    tolerance_ms: f64,
) -> Result<BTreeMap<String, Agreement>, ContactsError> {
    let rows = read_index(index)?;
    let judged = rows.par_iter().map(|row| judge(row, index, bodies));
    let judged: Vec<Judged> = judged.collect::<Result<_, _>>()?;
    let mut agreements: BTreeMap<String, Agreement> = BTreeMap::new();
    for recording in &judged {
        recording.add_to(&mut agreements, tolerance_ms);
    }
    agreements.values_mut().for_each(Agreement::summarise);
    Ok(agreements)
}

/// Finds the events of one recording by every detector.
fn judge(row: &IndexRow, index: &Path, bodies: Option<&Bodies>) -> Result<Judged, ContactsError> {
    let events = row.column(EVENTS_COLUMN).unwrap_or_default();
    if events.is_empty() {
        let reason = format!(
            "column \"{EVENTS_COLUMN}\" is missing or empty; name the file with the known events there"
        );
        return Err(lack(index, row, reason));
    }
    let known = read_events(&index.parent().unwrap_or(Path::new("")).join(events))?;
    let recording = csv::read(&row.path)?;
    let switches =
        detect_sensor_switches(&recording.evenly_spaced().channels(), recording.rate_hz())
            .map_err(|error| ContactsError::file(&row.path, error))?;
    let switches = switches
        .iter()
        .map(|switch| (recording.start_secs() + switch.time_secs, switch.kind));
    let swings = events_of(&detect_swings(&recording)).into_iter();
    let swings = swings.map(|event| (event.time_secs, event.kind));
    let worn = worn_foot(row, index, &known)?;
    let mut found: Vec<(&str, Side, Times)> = vec![
        ("switches", worn, switches.collect()),
        ("swings", worn, swings.collect()),
    ];
    if let Some(bodies) = bodies {
        let driven = bodies.events(&row.path, &recording, worn)?;
        let swings = events_of(&driven.swings).into_iter();
        let swings = swings.map(|event| (event.time_secs, event.kind));
        found.push(("swings as they come", worn, swings.collect()));
        for (name, side, events) in [
            ("body live", worn, &driven.live),
            ("body whole", worn, &driven.whole),
            ("other foot live", worn.other(), &driven.live),
            ("other foot whole", worn.other(), &driven.whole),
        ] {
            let own = events.iter().filter(|event| event.side == side);
            let own = own.map(|event| (event.time_secs, event.kind));
            found.push((name, side, own.collect()));
        }
    }
    Ok(Judged {
        category: row.category().to_owned(),
        worn,
        known,
        found,
    })
}

impl Judged {
    fn add_to(&self, agreements: &mut BTreeMap<String, Agreement>, tolerance_ms: f64) {
        for (detector, side, found) in &self.found {
            let known = self.known.iter();
            let known: Vec<&Event> = known.filter(|e| e.is_of(*side, self.worn)).collect();
            let times = || known.iter().map(|event| event.time_s);
            let judged = times().fold(f64::INFINITY, f64::min) - MARGIN_SECS
                ..=times().fold(f64::NEG_INFINITY, f64::max) + MARGIN_SECS;
            for kind in [EventKind::InitialContact, EventKind::TerminalContact] {
                let known = known.iter().filter(|event| event.kind == kind.name());
                let found = found.iter().filter(|(_, other)| *other == kind);
                let found = found.map(|(time_secs, _)| *time_secs);
                let kind = kind.name().replace('_', " ");
                let name = format!("{}, {kind}, {detector}", self.category);
                let agreement = agreements.entry(name).or_default();
                agreement.recordings += 1;
                agreement.add(
                    known.map(|event| event.time_s).collect(),
                    found.filter(|time| judged.contains(time)).collect(),
                    tolerance_ms,
                );
            }
        }
    }
}

/// An error about a row of the index.
fn lack(index: &Path, row: &IndexRow, reason: String) -> ContactsError {
    ContactsError::Row {
        index: index.to_owned(),
        line: row.line,
        reason,
    }
}

impl Event {
    /// Returns whether it is an event of a foot, when the sensor is worn on one.
    fn is_of(&self, side: Side, worn: Side) -> bool {
        let named = self.foot.as_deref();
        named.map_or(side == worn, |name| name == side.name())
    }
}

/// The foot that wears the sensor: the index says it, or all events are of one.
fn worn_foot(row: &IndexRow, index: &Path, events: &[Event]) -> Result<Side, ContactsError> {
    let named = row.column(FOOT_COLUMN).unwrap_or_default();
    let side = Side::BOTH.into_iter().find(|side| {
        let all_own = events.iter().all(|event| event.is_of(*side, *side));
        named == side.name() || (named.is_empty() && all_own)
    });
    side.ok_or_else(|| {
        let reason = format!(
            "the foot of the sensor is unknown; write left or right into a column \"{FOOT_COLUMN}\""
        );
        lack(index, row, reason)
    })
}

fn read_events(path: &Path) -> Result<Vec<Event>, ContactsError> {
    let fault = |reason: String| ContactsError::file(path, reason);
    let text = fs::read_to_string(path)
        .map_err(|error| fault(format!("cannot read the events: {error}")))?;
    let events: Events = serde_json::from_str(&text).map_err(|error| {
        fault(format!(
            "not what `footfall imu events --json` writes: {error}"
        ))
    })?;
    if events.events.is_empty() || !events.events.iter().all(|event| event.time_s.is_finite()) {
        return Err(fault(
            "there are no events; add the reference events".to_owned(),
        ));
    }
    Ok(events.events)
}
