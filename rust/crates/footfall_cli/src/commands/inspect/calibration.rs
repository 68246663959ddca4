//! Facts of a calibration of sensors.

use super::fact;
use crate::commands::imu::read_calibration;
use anyhow::Result;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Facts of a calibration.
#[derive(Serialize)]
pub(super) struct CalibrationFacts {
    file: PathBuf,
    sensors: Vec<SensorFacts>,
    /// Length of the wearer's steps beside those of the people in the model.
    stride: f32,
}

#[derive(Serialize)]
struct SensorFacts {
    site: &'static str,
    device: String,
    site_from_sensor: [f32; 4],
    certainty: f32,
    rate_bias_radps: [f32; 3],
    gravity_mps2: f32,
}

/// Reads a calibration.
pub(super) fn inspect(path: &Path) -> Result<CalibrationFacts> {
    let calibration = read_calibration(path)?;
    let sensors = calibration.sensors.into_iter().map(|sensor| SensorFacts {
        site: sensor.site.name(),
        device: sensor.device,
        site_from_sensor: sensor.site_from_sensor.to_array(),
        certainty: sensor.certainty,
        rate_bias_radps: sensor.rate_bias.to_array(),
        gravity_mps2: sensor.gravity_mps2,
    });
    Ok(CalibrationFacts {
        file: path.to_owned(),
        sensors: sensors.collect(),
        stride: calibration.stride,
    })
}

impl CalibrationFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = vec![
            fact("calibration", self.file.display()),
            fact(
                "stride",
                format!("{:.2} of the model's people", self.stride),
            ),
        ];
        lines.extend(self.sensors.iter().map(|sensor| {
            let [x, y, z] = sensor.rate_bias_radps;
            let device = if sensor.device.is_empty() {
                "any sensor"
            } else {
                &sensor.device
            };
            fact(
                sensor.site,
                format!(
                    "{device}, mounting {:.0} % certain, at rest {x:.3}, {y:.3}, {z:.3} rad/s and {:.2} m/s²",
                    100.0 * sensor.certainty,
                    sensor.gravity_mps2
                ),
            )
        }));
        lines
    }
}
