//! Facts of a sensor model, and of a sensor's recording.

use super::{FileFacts, fact};
use anyhow::Result;
use footfall_core::Behaviour;
use footfall_imu::{check_recording, csv};
use footfall_model::ImuModel;
use footfall_train::read_model_file;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Facts of a sensor model.
#[derive(Serialize)]
pub(super) struct ImuModelFacts {
    #[serde(flatten)]
    file: FileFacts,
    fps: f64,
    sites: Vec<&'static str>,
    frames: usize,
    segments: usize,
    phases: usize,
    /// Seconds of each behaviour.
    behaviours: BTreeMap<&'static str, f64>,
}

/// Reads a sensor model.
pub(super) fn inspect_model(path: &Path) -> Result<ImuModelFacts> {
    let model = read_model_file(path, ImuModel::from_bytes)?;
    let seconds_of = |behaviour: Behaviour| {
        let of = |segment: &&footfall_model::imu_model::Segment| {
            model.behaviour_of(**segment) == behaviour
        };
        let frames = model.segments.iter().filter(of);
        let frames: u64 = frames.map(|segment| u64::from(segment.frames)).sum();
        frames as f64 / model.frame_rate_hz
    };
    Ok(ImuModelFacts {
        file: FileFacts::of(path)?,
        fps: model.frame_rate_hz,
        sites: model.sites.iter().map(|site| site.name()).collect(),
        frames: model.frame_count(),
        segments: model.segments.len(),
        phases: model.phases.len(),
        behaviours: Behaviour::ALL
            .into_iter()
            .map(|behaviour| (behaviour.name(), seconds_of(behaviour)))
            .filter(|(_, seconds)| *seconds > 0.0)
            .collect(),
    })
}

impl ImuModelFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let between = vec![
            fact("sites", self.sites.join(", ")),
            fact(
                "frames",
                format!(
                    "{} at {} fps in {} segments of {} phases",
                    self.frames, self.fps, self.segments, self.phases
                ),
            ),
            fact(
                "behaviours",
                self.behaviours
                    .iter()
                    .map(|(name, seconds)| format!("{name} {seconds:.1} s"))
                    .collect::<Vec<_>>()
                    .join(", "),
            ),
        ];
        self.file.lines("sensor model", between)
    }
}

/// Facts of a sensor's recording.
#[derive(Serialize)]
pub(super) struct ImuRecordingFacts {
    file: PathBuf,
    samples: usize,
    rate_hz: f64,
    start_s: f64,
    seconds: f64,
    /// Fault of the recording; absent when there is none.
    fault: Option<String>,
}

/// Reads a recording.
pub(super) fn inspect_recording(path: &Path) -> Result<ImuRecordingFacts> {
    let recording = csv::read(path)?;
    Ok(ImuRecordingFacts {
        file: path.to_owned(),
        samples: recording.samples.len(),
        rate_hz: recording.rate_hz(),
        start_s: recording.start_secs(),
        seconds: recording.duration_secs(),
        fault: check_recording(&recording)
            .err()
            .map(|fault| fault.to_string()),
    })
}

impl ImuRecordingFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        vec![
            fact("recording", self.file.display()),
            fact(
                "samples",
                format!(
                    "{} in {:.2} s, {:.1} a second",
                    self.samples, self.seconds, self.rate_hz
                ),
            ),
            fact("fault", self.fault.as_deref().unwrap_or("none found")),
        ]
    }
}
