//! Recognition, naturalness and resemblance of styles as tables.

use super::filled;
use crate::table::{Cell, Column, Table};
use footfall_train::evaluate::style_report::{Recognition, StyleFigures, StyleReport};
use footfall_train::evaluate::{Naturalness, Resemblance, Split};

/// Figures of each style, recognition of all, confusions.
pub(crate) fn style(report: &StyleReport) -> Vec<Table> {
    let judged = || {
        let made = report.synthesised.as_ref();
        let made = made.map(|made| ("synthesised", made));
        [("real", &report.real)].into_iter().chain(made)
    };
    let mut tables = vec![
        Table::of("Styles", &report.measures, &FIGURES),
        Table::of("Recognition", judged(), &RECOGNITION),
    ];
    tables.extend(judged().map(|(kind, recognition)| {
        let counts = recognition.confusion.iter();
        let counts = counts.map(|row| row.iter().map(|count| (*count).into()).collect());
        Table::confusion(&format!("Confusion, {kind}"), &report.styles, counts)
    }));
    tables.push(Table::values(
        "Summary",
        [
            (
                "unseen in turn",
                Cell::Text(unseen(report.split).to_owned()),
            ),
            ("synthesised over real rate", report.ratio.into()),
            (
                "correlation of the styles' rates",
                report.rate_correlation.into(),
            ),
            ("variability ratio", report.step_variability_ratio.into()),
            ("shrinkage", report.shrinkage.into()),
            ("recordings left out", report.skipped.len().into()),
        ],
    ));
    filled(tables)
}

const fn unseen(split: Split) -> &'static str {
    match split {
        Split::Take => "each take",
        Split::Half => "each half of every recording",
    }
}

/// Synthesised recordings beside real ones; real ones are compared with others of their style.
const FIGURES: [Column<StyleFigures>; 16] = [
    ("distance", |own| own.real_against_real.distance.into()),
    ("distance, synthesised", |own| {
        compared(own, |it| it.distance.into())
    }),
    ("variance ratio", |own| {
        own.real_against_real.variance.median().into()
    }),
    ("variance ratio, synthesised", |own| {
        compared(own, |it| it.variance.median().into())
    }),
    ("variability ratio", |own| {
        own.real_against_real.variability.median().into()
    }),
    ("variability ratio, synthesised", |own| {
        compared(own, |it| it.variability.median().into())
    }),
    ("slip, cm/s", |own| slip_cmps(&own.real)),
    ("slip, synthesised, cm/s", |own| made(own, slip_cmps)),
    ("skating", |own| own.real.skating_ratio.into()),
    ("skating, synthesised", |own| {
        made(own, |it| it.skating_ratio.into())
    }),
    ("jerk, m/s³", |own| own.real.jerk.into()),
    ("jerk, synthesised, m/s³", |own| {
        made(own, |it| it.jerk.into())
    }),
    ("recordings", |own| own.real.clips.into()),
    ("recordings, synthesised", |own| {
        made(own, |it| it.clips.into())
    }),
    ("strides", |own| own.real.strides.into()),
    ("strides, synthesised", |own| {
        made(own, |it| it.strides.into())
    }),
];

fn slip_cmps(figures: &Naturalness) -> Cell {
    figures.slip_mps.map(|slip| 100.0 * slip).into()
}

fn made(style: &StyleFigures, value: fn(&Naturalness) -> Cell) -> Cell {
    style.synthesised.as_ref().map_or(Cell::Nothing, value)
}

fn compared(style: &StyleFigures, value: fn(&Resemblance) -> Cell) -> Cell {
    let against = style.synthesised_against_real.as_ref();
    against.map_or(Cell::Nothing, value)
}

const RECOGNITION: [Column<Recognition>; 3] = [
    ("strides", |own| own.strides.into()),
    ("rate", |own| own.rate.into()),
    ("rate over chance", |own| own.efficiency.into()),
];
