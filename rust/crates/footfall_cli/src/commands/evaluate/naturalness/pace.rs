//! Speed, cadence, flight and slip as JSON and as tables.

use footfall_train::evaluate::told_apart::bouts::{Bout, WithinRange};
use footfall_train::evaluate::told_apart::gait::GaitMeasures;
use serde::Serialize;
use std::fmt::Write as _;

/// Width of a band of speeds, m/s.
const BAND_MPS: f64 = 0.5;

/// Captured and generated bouts side by side.
#[derive(Serialize)]
pub(super) struct Pace {
    /// Mean error of the speed over the speed that was asked, percent.
    speed_error_percent: Option<f64>,
    /// Greatest error of a seed, percent.
    speed_error_most_percent: Option<f64>,
    /// Generated bouts with captured ones of about the same speed.
    comparable_bouts: usize,
    /// Share of these with a cadence that was captured at that speed.
    cadence_within: f64,
    /// Share of these with a share of flight that was captured at that speed.
    flight_within: f64,
    /// Median slip of standing feet, captured and generated, cm/s.
    slip_cmps: [Option<f64>; 2],
    /// Median slip of landing feet, captured and generated, cm/s.
    landing_slip_cmps: [Option<f64>; 2],
    bands: Vec<Band>,
    people: Vec<PersonRow>,
}

/// Bouts of one captured person, means over time.
#[derive(Serialize)]
struct PersonRow {
    person: String,
    steps: usize,
    speed_mps: f64,
    cadence_hz: f64,
    flight_share: f64,
}

/// Bouts of about the same speed.
#[derive(Serialize)]
struct Band {
    from_mps: f64,
    to_mps: f64,
    captured: Option<Spread>,
    generated: Option<Spread>,
}

/// Least, mean and greatest over bouts.
#[derive(Serialize)]
struct Spread {
    bouts: usize,
    cadence_hz: [f64; 3],
    flight_share: [f64; 3],
}

impl Pace {
    pub(super) fn new([captured, generated]: &[GaitMeasures; 2]) -> Self {
        let both = [captured, generated];
        let within = WithinRange::of(&captured.bouts, &generated.bouts);
        let errors = &generated.speed_errors;
        let percent = |value: f64| (!errors.is_empty()).then_some(100.0 * value);
        let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        let cm = |value: Option<f64>| value.map(|value| 100.0 * value);
        Self {
            speed_error_percent: percent(mean),
            speed_error_most_percent: percent(errors.iter().copied().fold(0.0, f64::max)),
            comparable_bouts: within.bouts,
            cadence_within: within.cadence,
            flight_within: within.flight,
            slip_cmps: both.map(|side| cm(side.slip_mps)),
            landing_slip_cmps: both.map(|side| cm(side.landing_slip_mps)),
            bands: bands([&captured.bouts, &generated.bouts]),
            people: captured.walkers.iter().map(PersonRow::new).collect(),
        }
    }

    pub(super) fn table(&self) -> String {
        let mut text =
            "\nCadence (steps a second) and share of flight by speed: least, mean, greatest of the bouts\n"
                .to_owned();
        // Writing to a string does not fail.
        for band in &self.bands {
            for (who, spread) in [("captured", &band.captured), ("generated", &band.generated)] {
                let Some(spread) = spread else { continue };
                let [least, mean, greatest] = spread.cadence_hz;
                let [grounded, flight, flying] = spread.flight_share;
                let _written = writeln!(
                    text,
                    "{:.1} to {:.1} m/s  {who:<9} {:>4} bouts   {least:.2} {mean:.2} {greatest:.2}   {grounded:.2} {flight:.2} {flying:.2}",
                    band.from_mps, band.to_mps, spread.bouts
                );
            }
        }
        for row in &self.people {
            let _written = writeln!(
                text,
                "{:<30} {:>4} steps   {:.2} m/s   {:.2} steps a second   flight {:.2}",
                row.person, row.steps, row.speed_mps, row.cadence_hz, row.flight_share
            );
        }
        let number = |value: Option<f64>| {
            value.map_or_else(|| "none".to_owned(), |value| format!("{value:.1}"))
        };
        let [captured, generated] = self.slip_cmps.map(number);
        let [captured_landing, generated_landing] = self.landing_slip_cmps.map(number);
        let _written = writeln!(
            text,
            "{} generated bouts have captured ones within 0.25 m/s: cadence within their range {:.2}, share of flight {:.2}\n\
             Speed off by {} % on average, {} % at most\n\
             Slip in cm/s, median: standing feet {captured} captured, {generated} generated; landing feet {captured_landing}, {generated_landing}",
            self.comparable_bouts,
            self.cadence_within,
            self.flight_within,
            number(self.speed_error_percent),
            number(self.speed_error_most_percent),
        );
        text
    }
}

/// Bands that show a bout, slow ones first.
fn bands(both: [&Vec<Bout>; 2]) -> Vec<Band> {
    let band_of = |bout: &Bout| (bout.speed_mps / BAND_MPS).floor() as usize;
    let all = || both.into_iter().flatten();
    let Some(last) = all().map(band_of).max() else {
        return Vec::new();
    };
    (0..=last)
        .map(|band| {
            let within = |bouts: &Vec<Bout>| -> Vec<Bout> {
                let own = bouts.iter().filter(|bout| band_of(bout) == band);
                own.copied().collect()
            };
            let [captured, generated] = both.map(|bouts| Spread::of(&within(bouts)));
            Band {
                from_mps: BAND_MPS * band as f64,
                to_mps: BAND_MPS * (band + 1) as f64,
                captured,
                generated,
            }
        })
        .filter(|band| band.captured.is_some() || band.generated.is_some())
        .collect()
}

impl PersonRow {
    fn new((person, bout): &(String, Bout)) -> Self {
        Self {
            person: person.clone(),
            steps: bout.steps,
            speed_mps: bout.speed_mps,
            cadence_hz: bout.cadence_hz,
            flight_share: bout.flight_share,
        }
    }
}

impl Spread {
    fn of(bouts: &[Bout]) -> Option<Self> {
        let over = |of: fn(&Bout) -> f64| {
            let values = || bouts.iter().map(of);
            let mean = values().sum::<f64>() / bouts.len().max(1) as f64;
            [
                values().fold(f64::MAX, f64::min),
                mean,
                values().fold(f64::MIN, f64::max),
            ]
        };
        (!bouts.is_empty()).then(|| Self {
            bouts: bouts.len(),
            cadence_hz: over(|bout| bout.cadence_hz),
            flight_share: over(|bout| bout.flight_share),
        })
    }
}
