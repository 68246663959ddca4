//! Reports of evaluations as tables. Columns name their units.

mod imu;
mod style;

pub(crate) use imu::imu;
pub(crate) use style::style;

use super::{Column, Table};
use footfall_train::HeldOutWalker;
use footfall_train::evaluate::contacts::{Agreement, ContactsReport, Person};
use footfall_train::evaluate::dynamics::{DynamicsErrors, DynamicsReport};
use footfall_train::evaluate::training::TrainingReport;

/// Prediction errors by category.
pub(crate) fn dynamics(report: &DynamicsReport) -> Vec<Table> {
    filled(vec![
        Table::of("Categories", &report.categories, &ERRORS),
        Table::values(
            "Summary",
            [(
                "recordings with too few steps",
                report.too_short.len().into(),
            )],
        ),
    ])
}

const ERRORS: [Column<DynamicsErrors>; 7] = [
    ("one frame ahead, switching", |own| {
        own.switching_one_step.into()
    }),
    ("one frame ahead, single", |own| own.single_one_step.into()),
    ("one frame ahead, ratio", |own| own.one_step_ratio.into()),
    ("left alone, switching", |own| {
        own.switching_simulated.into()
    }),
    ("left alone, single", |own| own.single_simulated.into()),
    ("left alone, ratio", |own| own.simulated_ratio.into()),
    ("recordings", |own| own.recordings.into()),
];

/// Agreement by person, and of switches by category.
pub(crate) fn contacts(report: &ContactsReport) -> Vec<Table> {
    filled(vec![
        Table::of("People", &report.people, &PEOPLE),
        Table::of("Categories", &report.categories, &AGREEMENT),
        Table::values(
            "Summary",
            [("tolerance of switches, ms", report.tolerance_ms.into())],
        ),
    ])
}

const PEOPLE: [Column<Person>; 9] = [
    ("initial contacts, F1", |own| own.initial_contact.f1.into()),
    ("terminal contacts, F1", |own| {
        own.terminal_contact.f1.into()
    }),
    ("switches, F1", |own| own.switches.f1.into()),
    ("initial contacts, median ms", |own| {
        own.initial_contact.median_ms.into()
    }),
    ("terminal contacts, median ms", |own| {
        own.terminal_contact.median_ms.into()
    }),
    ("switches, median ms", |own| own.switches.median_ms.into()),
    ("initial contacts, known", |own| {
        own.initial_contact.known.into()
    }),
    ("terminal contacts, known", |own| {
        own.terminal_contact.known.into()
    }),
    ("switches, known", |own| own.switches.known.into()),
];

const AGREEMENT: [Column<Agreement>; 8] = [
    ("F1", |own| own.f1.into()),
    ("bias, ms", |own| own.bias_ms.into()),
    ("median, ms", |own| own.median_ms.into()),
    ("spread, ms", |own| own.spread_ms.into()),
    ("recordings", |own| own.recordings.into()),
    ("known", |own| own.known.into()),
    ("found", |own| own.found.into()),
    ("matched", |own| own.matched.into()),
];

/// Log densities of unseen walkers, and what training gains over all of them.
pub(crate) fn training(report: &TrainingReport) -> Vec<Table> {
    let walkers = report.walkers.iter().map(|own| (&own.subject, own));
    filled(vec![
        Table::of("Walkers, log density a frame", walkers, &WALKERS),
        Table::values(
            "Summary",
            [
                ("log density a frame, plain", report.plain.into()),
                (
                    "log density a frame, plain, adapted",
                    report.plain_adapted.into(),
                ),
                (
                    "log density a frame, walker-adaptive",
                    report.adaptive.into(),
                ),
                ("mean ln variance, plain", report.plain_log_variance.into()),
                (
                    "mean ln variance, walker-adaptive",
                    report.adaptive_log_variance.into(),
                ),
                ("recordings left out", report.skipped.len().into()),
            ],
        ),
    ])
}

const WALKERS: [Column<HeldOutWalker>; 4] = [
    ("plain", |own| own.plain.into()),
    ("plain, adapted", |own| own.plain_adapted.into()),
    ("walker-adaptive", |own| own.adaptive.into()),
    ("frames", |own| own.frames.into()),
];

/// Entries with a row.
fn filled(mut tables: Vec<Table>) -> Vec<Table> {
    tables.retain(|table| !table.rows.is_empty());
    tables
}
