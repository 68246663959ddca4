//! Facts of a style.

use super::{FileFacts, fact};
use anyhow::Result;
use footfall_model::{GaitStyle, StepModel};
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::Path;

/// Facts of a style.
#[derive(Serialize)]
pub(super) struct StyleFacts {
    #[serde(flatten)]
    file: FileFacts,
    name: String,
    /// Fingerprint of the base model that it fits.
    base_fingerprint: String,
    speed_mps: f64,
    cadence_per_minute: f64,
    /// When the other foot leaves the ground, as a share of the left and of the right step.
    other_terminal: [f64; 2],
    warnings: Vec<String>,
}

/// Reads a style.
pub(super) fn inspect(path: &Path) -> Result<StyleFacts> {
    let style: GaitStyle = read_model_file(path, GaitStyle::from_bytes)?;
    Ok(StyleFacts {
        warnings: style.thin_warning().into_iter().collect(),
        file: FileFacts::of(path)?,
        name: style.name,
        base_fingerprint: format!("{:08x}", style.base_fingerprint),
        speed_mps: style.speed_mps,
        cadence_per_minute: 60.0 * style.cadence_hz,
        other_terminal: style
            .steps
            .map(|StepModel { other_terminal, .. }| other_terminal),
    })
}

impl StyleFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let [left, right] = self.other_terminal.map(|share| 100.0 * share);
        let between = vec![
            fact("name", &self.name),
            fact(
                "base model",
                format!("fingerprint {}", self.base_fingerprint),
            ),
        ];
        let mut lines = self.file.lines("gait style", between);
        lines.push(fact(
            "walk",
            format!(
                "{:.2} m/s, {:.0} steps a minute, the other foot leaves at {left:.0} % and {right:.0} %",
                self.speed_mps, self.cadence_per_minute
            ),
        ));
        let warnings = self.warnings.iter();
        lines.extend(warnings.map(|warning| fact("warning", warning)));
        lines
    }
}
