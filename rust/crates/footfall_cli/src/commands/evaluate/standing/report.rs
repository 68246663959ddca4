//! The comparison as JSON and as a table.

use super::Person;
use footfall_train::evaluate::standing::{BANDS_HZ, PARTS, StandingMeasures};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Generated standing beside captured.
#[derive(Serialize)]
pub(crate) struct Report {
    people: usize,
    seeds: usize,
    captured: Measures,
    /// Least and greatest of the people.
    captured_range: [Measures; 2],
    generated: Measures,
    still: Measures,
    bands_hz: [[f64; 2]; BANDS_HZ.len()],
    /// Geometric means of the root mean squares by part and band.
    captured_spectrum: BTreeMap<&'static str, Vec<f64>>,
    generated_spectrum: BTreeMap<&'static str, Vec<f64>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    leave_one_out: Vec<HeldOut>,
}

/// Measures of sway, means over people.
#[derive(Clone, Copy, Serialize)]
struct Measures {
    hips_sway_cm: f64,
    head_sway_cm: f64,
    hips_speed_cm_s: f64,
    head_speed_cm_s: f64,
    knee_tenth_deg: f64,
    knee_ninetieth_deg: f64,
    /// Greatest autocorrelation of the head's path at lags of 20 seconds or more; `None` if nobody stands that long.
    return_correlation: Option<f64>,
}

/// One person beside a model of the others.
#[derive(Serialize)]
pub(crate) struct HeldOut {
    person: String,
    /// Root mean square over parts and bands of the logarithm of generated over captured.
    model_log_error: f64,
    /// The same with the other people's mean in the model's place.
    people_log_error: f64,
}

/// A line of the table and its measure.
type MeasureRow = (&'static str, fn(&Measures) -> f64);

const ROWS: [MeasureRow; 7] = [
    ("hips' sway, cm", |m| m.hips_sway_cm),
    ("head's sway, cm", |m| m.head_sway_cm),
    ("hips' speed, cm/s", |m| m.hips_speed_cm_s),
    ("head's speed, cm/s", |m| m.head_speed_cm_s),
    ("knees, 10th percentile, degrees", |m| m.knee_tenth_deg),
    ("knees, 90th percentile, degrees", |m| m.knee_ninetieth_deg),
    ("likeness to 20 s ago and more", |m| {
        m.return_correlation.unwrap_or(f64::NAN)
    }),
];

impl Measures {
    fn of(m: &StandingMeasures) -> Self {
        Self {
            hips_sway_cm: m.sway_cm[0],
            head_sway_cm: m.sway_cm[1],
            hips_speed_cm_s: m.speed_cm_s[0],
            head_speed_cm_s: m.speed_cm_s[1],
            knee_tenth_deg: m.knees_deg[0],
            knee_ninetieth_deg: m.knees_deg[1],
            return_correlation: m.return_correlation,
        }
    }

    /// Each measure, combined from all people.
    fn made(people: &[Person], of: fn(&[f64]) -> f64) -> Self {
        let all: Vec<Self> = people
            .iter()
            .map(|person| Self::of(&person.measures))
            .collect();
        let each = |read: fn(&Self) -> f64| {
            let values: Vec<f64> = all.iter().map(read).collect();
            of(&values)
        };
        let known: Vec<f64> = all.iter().filter_map(|m| m.return_correlation).collect();
        Self {
            hips_sway_cm: each(|m| m.hips_sway_cm),
            head_sway_cm: each(|m| m.head_sway_cm),
            hips_speed_cm_s: each(|m| m.hips_speed_cm_s),
            head_speed_cm_s: each(|m| m.head_speed_cm_s),
            knee_tenth_deg: each(|m| m.knee_tenth_deg),
            knee_ninetieth_deg: each(|m| m.knee_ninetieth_deg),
            return_correlation: (!known.is_empty()).then(|| of(&known)),
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Mean logarithms of the root mean squares, part by part, band by band.
fn logs<'a>(people: impl Iterator<Item = &'a Person>) -> Vec<f64> {
    let mut sums = vec![0.0; PARTS.len() * BANDS_HZ.len()];
    let mut count = 0.0;
    for person in people {
        count += 1.0;
        for (sum, value) in sums
            .iter_mut()
            .zip(person.measures.spectrum.iter().flatten())
        {
            *sum += value.max(1e-6).ln();
        }
    }
    sums.iter().map(|sum| sum / count).collect()
}

fn spectrum(people: &[Person]) -> BTreeMap<&'static str, Vec<f64>> {
    let logs = logs(people.iter());
    let rows = logs.chunks(BANDS_HZ.len());
    let rows = rows.map(|row| row.iter().map(|log| log.exp()).collect());
    PARTS.into_iter().zip(rows).collect()
}

impl HeldOut {
    pub(super) fn new(person: &Person, generated: &[&Person], others: &[&Person]) -> Self {
        let own = logs(core::iter::once(person));
        let error = |people: &[&Person]| {
            let logs = logs(people.iter().copied());
            let squares: Vec<f64> = logs
                .iter()
                .zip(&own)
                .map(|(a, b)| (a - b).powi(2))
                .collect();
            mean(&squares).sqrt()
        };
        Self {
            person: person.name.clone(),
            model_log_error: error(generated),
            people_log_error: error(others),
        }
    }
}

impl Report {
    pub(super) fn new(
        captured: &[Person],
        generated: &[Person],
        still: &[Person],
        leave_one_out: Vec<HeldOut>,
    ) -> Self {
        Self {
            people: captured.len(),
            seeds: generated.len(),
            captured: Measures::made(captured, mean),
            captured_range: [
                Measures::made(captured, least),
                Measures::made(captured, greatest),
            ],
            generated: Measures::made(generated, mean),
            still: Measures::made(still, mean),
            bands_hz: BANDS_HZ,
            captured_spectrum: spectrum(captured),
            generated_spectrum: spectrum(generated),
            leave_one_out,
        }
    }

    pub(super) fn table(&self) -> String {
        let mut table = format!("{} people, {} seeds\n\n", self.people, self.seeds);
        let [low, high] = &self.captured_range;
        line(
            &mut table,
            &format!(
                "{:34}{:>10}{:>16}{:>11}{:>8}",
                "", "captured", "from, to", "generated", "still"
            ),
        );
        for (name, of) in ROWS {
            let range = format!("{:.2}, {:.2}", of(low), of(high));
            line(
                &mut table,
                &format!(
                    "{name:34}{:>10.2}{range:>16}{:>11.2}{:>8.2}",
                    of(&self.captured),
                    of(&self.generated),
                    of(&self.still)
                ),
            );
        }
        let bands: Vec<String> = self
            .bands_hz
            .iter()
            .map(|[low, high]| format!("{low} to {high} Hz"))
            .collect();
        line(&mut table, "");
        let mut heading = format!("{:20}", "captured, generated");
        for band in bands {
            let _written = write!(heading, "{band:>18}");
        }
        line(&mut table, &heading);
        for part in PARTS {
            let (captured, generated) = (
                &self.captured_spectrum[part],
                &self.generated_spectrum[part],
            );
            let mut row = format!("{part:20}");
            for (a, b) in captured.iter().zip(generated) {
                let _written = write!(row, "{:>18}", format!("{a:.2}, {b:.2}"));
            }
            line(&mut table, &row);
        }
        if !self.leave_one_out.is_empty() {
            line(&mut table, "");
            line(
                &mut table,
                "held out, error of ln rms: model of the others, the others' mean",
            );
            for held_out in &self.leave_one_out {
                line(
                    &mut table,
                    &format!(
                        "{:20}{:>10.2}{:>10.2}",
                        held_out.person, held_out.model_log_error, held_out.people_log_error
                    ),
                );
            }
        }
        table
    }
}

fn line(table: &mut String, text: &str) {
    // Writing to a string does not fail.
    let _written = writeln!(table, "{}", text.trim_end());
}
