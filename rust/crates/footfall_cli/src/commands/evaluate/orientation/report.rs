//! The comparison as JSON and as a table.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Errors of one filter, degrees.
#[derive(Default, Serialize)]
pub(super) struct Errors {
    count: usize,
    rms_deg: f64,
    median_deg: f64,
    ninety_fifth_deg: f64,
    #[serde(skip)]
    all_deg: Vec<f64>,
}

/// By filter.
pub(super) type ByFilter = BTreeMap<&'static str, Errors>;

/// The comparison, by category of the recordings.
#[derive(Default, Serialize)]
pub(crate) struct Report {
    pub(super) simulated: BTreeMap<String, ByFilter>,
    pub(super) real: BTreeMap<String, ByFilter>,
}

impl Extend<f32> for Errors {
    /// Takes errors in radians.
    fn extend<I: IntoIterator<Item = f32>>(&mut self, errors: I) {
        let errors = errors.into_iter();
        self.all_deg
            .extend(errors.map(|error| f64::from(error.to_degrees())));
    }
}

impl Errors {
    fn summarise(&mut self) {
        self.all_deg.sort_by(f64::total_cmp);
        let errors = &self.all_deg;
        self.count = errors.len();
        if let Some(last) = errors.len().checked_sub(1) {
            let at = |share: f64| errors[(share * last as f64).round() as usize];
            let squares: f64 = errors.iter().map(|error| error * error).sum();
            self.rms_deg = (squares / errors.len() as f64).sqrt();
            self.median_deg = at(0.5);
            self.ninety_fifth_deg = at(0.95);
        }
    }
}

impl Report {
    /// Works out the figures of all errors.
    pub(super) fn summarise(&mut self) {
        for categories in [&mut self.simulated, &mut self.real] {
            for errors in categories.values_mut().flat_map(BTreeMap::values_mut) {
                errors.summarise();
            }
        }
    }

    pub(super) fn table(&self) -> String {
        let mut text = String::new();
        for (title, categories) in [
            ("Simulated sensors, every frame", &self.simulated),
            ("Real sensors, at the beginning of a rest", &self.real),
        ] {
            if categories.is_empty() {
                continue;
            }
            let _written = writeln!(
                text,
                "{title}: error of the vertical, degrees\n{:<44}{:>8}{:>8}{:>8}{:>8}",
                "category, filter", "count", "rms", "median", "95 %"
            );
            for (category, filters) in categories {
                for (filter, errors) in filters {
                    let _written = writeln!(
                        text,
                        "{:<44}{:>8}{:>8.2}{:>8.2}{:>8.2}",
                        format!("{category}, {filter}"),
                        errors.count,
                        errors.rms_deg,
                        errors.median_deg,
                        errors.ninety_fifth_deg
                    );
                }
            }
        }
        text
    }
}
