//! Facts of a switching model.

use super::fact;
use crate::model_file::read_dynamics;
use anyhow::{Context as _, Result};
use footfall_core::Side;
use footfall_model::{Provenance, file::read_header};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Facts of a switching model.
#[derive(Serialize)]
pub(super) struct DynamicsFacts {
    file: PathBuf,
    bytes: u64,
    format_version: u32,
    written_by: String,
    provenance: Provenance,
    fps: f64,
    components: usize,
    /// Of the left foot, then of the right.
    systems: [SystemFacts; 2],
}

#[derive(Serialize)]
struct SystemFacts {
    order: usize,
    starts: usize,
    segment_seconds: f64,
    segment_seconds_spread: f64,
    /// Largest absolute value of the transition's eigenvalues: above 1 the system is unstable, which a segment ends in time.
    spectral_radius: f64,
}

/// Reads a switching model.
pub(super) fn inspect(path: &Path) -> Result<DynamicsFacts> {
    let model = read_dynamics(path)?;
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    let (format_version, header) =
        read_header(&bytes).with_context(|| path.display().to_string())?;
    let systems = Side::BOTH.map(|side| {
        let regime = model.regime(side);
        let poles = regime.system.transition.complex_eigenvalues();
        SystemFacts {
            order: regime.system.order(),
            starts: regime.starts.len(),
            segment_seconds: regime.mean_frames() / model.frame_rate_hz,
            segment_seconds_spread: regime.frames_spread() / model.frame_rate_hz,
            spectral_radius: poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max),
        }
    });
    Ok(DynamicsFacts {
        file: path.to_owned(),
        bytes: bytes.len() as u64,
        format_version,
        written_by: header.written_by,
        provenance: header.provenance,
        fps: model.frame_rate_hz,
        components: model.components.len(),
        systems,
    })
}

impl DynamicsFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let provenance = &self.provenance;
        let mut lines = vec![
            fact(
                "dynamics model",
                format!("{} ({} bytes)", self.file.display(), self.bytes),
            ),
            fact(
                "format",
                format!(
                    "{}, written by Footfall {}",
                    self.format_version, self.written_by
                ),
            ),
            fact("fitted to", &provenance.corpus),
            fact(
                "corpus",
                format!(
                    "{} clips of {} people, {} segments",
                    provenance.clips, provenance.subjects, provenance.steps
                ),
            ),
            fact("terms", &provenance.terms),
            fact("made by", &provenance.command),
            fact(
                "pose",
                format!("{} components at {} fps", self.components, self.fps),
            ),
        ];
        lines.extend(Side::BOTH.iter().zip(&self.systems).map(|(side, system)| {
            fact(
                &format!("{} foot", side.name()),
                format!(
                    "order {}, spectral radius {:.3}, segments of {:.2} ± {:.2} s from {} starts",
                    system.order,
                    system.spectral_radius,
                    system.segment_seconds,
                    system.segment_seconds_spread,
                    system.starts
                ),
            )
        }));
        lines
    }
}
