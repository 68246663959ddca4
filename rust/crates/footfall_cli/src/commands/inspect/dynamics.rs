//! Facts of a switching model.

use super::{FileFacts, fact};
use anyhow::Result;
use footfall_core::Side;
use footfall_model::DynamicsModel;
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::Path;

/// Facts of a switching model.
#[derive(Serialize)]
pub(super) struct DynamicsFacts {
    #[serde(flatten)]
    file: FileFacts,
    fps: f64,
    components: usize,
    /// Values of the left foot, then of the right.
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
    let model = read_model_file(path, DynamicsModel::from_bytes)?;
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
        file: FileFacts::of(path)?,
        fps: model.frame_rate_hz,
        components: model.components.len(),
        systems,
    })
}

impl DynamicsFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = self.file.lines("dynamics model", Vec::new());
        lines.push(fact(
            "pose",
            format!("{} components at {} fps", self.components, self.fps),
        ));
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
