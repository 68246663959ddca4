//! Bodies from sensors as tables.

use super::filled;
use crate::table::{Cell, Column, Table};
use footfall_core::Behaviour;
use footfall_train::evaluate::imu::{ImuFigures, ImuReport, TransitionFigures};

/// Categories of every sensor, and what behaviours are taken for.
pub(crate) fn imu(report: &ImuReport) -> Vec<Table> {
    let mut tables = Vec::new();
    for sensor in &report.sensors {
        let sites = sensor.sites.join(" and ").replace('_', " ");
        for (seen, figures) in [
            ("given model", &sensor.given_model),
            ("other recordings", &sensor.other_recordings),
            ("other subjects", &sensor.other_subjects),
        ] {
            let title = format!("{sites}, {seen}");
            tables.push(Table::of(&title, figures, &BODIES));
            let overall = figures.get("total").or_else(|| figures.values().next());
            tables.extend(overall.map(|overall| taken_for(&title, overall)));
        }
        let changes = sensor.transitions.iter();
        let changes = changes.map(|change| (format!("{} to {}", change.from, change.to), change));
        let title = format!("{sites}, changes");
        tables.push(Table::of(&title, changes, &CHANGES));
    }
    filled(tables)
}

const BODIES: [Column<ImuFigures>; 17] = [
    ("recordings", |own| own.recordings.into()),
    ("moving frames", |own| own.moving_frames.into()),
    ("live, cm", |own| own.live_cm.into()),
    ("whole, cm", |own| own.whole_cm.into()),
    ("constant pose, cm", |own| own.constant_cm.into()),
    ("average course, cm", |own| own.average_cm.into()),
    ("nearest pose, cm", |own| own.nearest_cm.into()),
    ("spread of live, cm", |own| own.live_spread_cm.into()),
    ("live with standing, cm", |own| own.live_all_cm.into()),
    ("whole with standing, cm", |own| own.whole_all_cm.into()),
    ("correlation", |own| own.correlation.into()),
    ("recognised", |own| own.recognised.into()),
    ("delay, s", |own| own.median_delay_s.into()),
    ("sudden recorded, m/s²", |own| own.sudden_m_s2[0].into()),
    ("sudden live, m/s²", |own| own.sudden_m_s2[1].into()),
    ("standing knee recorded, °", |own| knee(own, 0)),
    ("standing knee live, °", |own| knee(own, 1)),
];

fn knee(figures: &ImuFigures, which: usize) -> Cell {
    let knees = figures.standing_knee_deg;
    knees.map(|knees| f64::from(knees[which])).into()
}

const CHANGES: [Column<TransitionFigures>; 5] = [
    ("changes", |own| own.changes.into()),
    ("shown, m/s²", |own| own.shown_m_s2.into()),
    ("unblended, m/s²", |own| own.unblended_m_s2.into()),
    ("recorded, m/s²", |own| own.recorded_m_s2.into()),
    ("cut, m/s²", |own| own.cut_m_s2.into()),
];

/// Shares of the frames of each behaviour, by what they are recognised as.
fn taken_for(title: &str, figures: &ImuFigures) -> Table {
    let shares = &figures.confusion;
    let occurs = |name: &str| {
        let taken = shares.values().any(|row| row.contains_key(name));
        taken || shares.contains_key(name)
    };
    let names = Behaviour::ALL.map(Behaviour::name).into_iter();
    let names: Vec<&str> = names.filter(|name| occurs(name)).collect();
    let rows = names.iter().map(|truth| {
        let row = shares.get(truth);
        let share = |name: &&str| row.and_then(|row| row.get(name)).copied();
        let cells = names.iter().map(|name| share(name).unwrap_or(0.0).into());
        cells.collect()
    });
    Table::confusion(&format!("{title}, taken for"), &names, rows)
}
