//! Facts of a style.

use super::fact;
use crate::model_file::read_style;
use anyhow::{Context as _, Result};
use footfall_model::{GaitStyle, Provenance, StepModel, file::read_header};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Facts of a style.
#[derive(Serialize)]
pub(super) struct StyleFacts {
    file: PathBuf,
    bytes: u64,
    format_version: u32,
    written_by: String,
    name: String,
    /// Which base model it fits.
    base_fingerprint: String,
    provenance: Provenance,
    speed_mps: f64,
    cadence_per_minute: f64,
    /// When the other foot leaves the ground, as a share of the left and of the right step.
    other_terminal: [f64; 2],
}

/// Reads a style.
pub(super) fn inspect(path: &Path) -> Result<StyleFacts> {
    let style: GaitStyle = read_style(path)?;
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    let (format_version, header) =
        read_header(&bytes).with_context(|| path.display().to_string())?;
    Ok(StyleFacts {
        file: path.to_owned(),
        bytes: bytes.len() as u64,
        format_version,
        written_by: header.written_by,
        name: style.name,
        base_fingerprint: format!("{:08x}", style.base_fingerprint),
        provenance: header.provenance,
        speed_mps: style.speed_mps,
        cadence_per_minute: 60.0 * style.cadence_hz,
        other_terminal: style
            .steps
            .map(|StepModel { other_terminal, .. }| other_terminal),
    })
}

impl StyleFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let provenance = &self.provenance;
        let [left, right] = self.other_terminal.map(|share| 100.0 * share);
        vec![
            fact(
                "gait style",
                format!("{} ({} bytes)", self.file.display(), self.bytes),
            ),
            fact("name", &self.name),
            fact(
                "format",
                format!(
                    "{}, written by Footfall {}",
                    self.format_version, self.written_by
                ),
            ),
            fact(
                "base model",
                format!("fingerprint {}", self.base_fingerprint),
            ),
            fact("made from", &provenance.corpus),
            fact(
                "corpus",
                format!("{} clips, {} steps", provenance.clips, provenance.steps),
            ),
            fact("terms", &provenance.terms),
            fact("made by", &provenance.command),
            fact(
                "walk",
                format!(
                    "{:.2} m/s, {:.0} steps a minute, the other foot leaves at {left:.0} % and {right:.0} %",
                    self.speed_mps, self.cadence_per_minute
                ),
            ),
        ]
    }
}
