//! Format version 1 of a `.footcal` file's payload. Never edited after release.

use super::{ModelFileError, undecodable};
use crate::sensor_calibration::{CalibratedSensor, SensorCalibration};
use footfall_core::Site;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct CalibrationV1 {
    sensors: Vec<SensorV1>,
    stride: f32,
}

#[derive(Serialize, Deserialize)]
struct SensorV1 {
    site: String,
    device: String,
    site_from_sensor: [f32; 4],
    certainty: f32,
    rate_bias: [f32; 3],
    gravity_mps2: f32,
}

pub(super) fn encode(calibration: &SensorCalibration) -> Result<Vec<u8>, ModelFileError> {
    let sensors = calibration.sensors.iter().map(|sensor| SensorV1 {
        site: sensor.site.name().to_owned(),
        device: sensor.device.clone(),
        site_from_sensor: sensor.site_from_sensor.to_array(),
        certainty: sensor.certainty,
        rate_bias: sensor.rate_bias.to_array(),
        gravity_mps2: sensor.gravity_mps2,
    });
    let file = CalibrationV1 {
        sensors: sensors.collect(),
        stride: calibration.stride,
    };
    postcard::to_stdvec(&file).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8]) -> Result<SensorCalibration, ModelFileError> {
    let file: CalibrationV1 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let sensor = |sensor: SensorV1| {
        let site = Site::from_name(&sensor.site);
        Ok(CalibratedSensor {
            site: site.ok_or_else(|| undecodable("payload", &"a site is not known"))?,
            device: sensor.device,
            site_from_sensor: Quat::from_array(sensor.site_from_sensor),
            certainty: sensor.certainty,
            rate_bias: Vec3::from_array(sensor.rate_bias),
            gravity_mps2: sensor.gravity_mps2,
        })
    };
    let sensors: Result<Vec<_>, ModelFileError> = file.sensors.into_iter().map(sensor).collect();
    Ok(SensorCalibration {
        sensors: sensors?,
        stride: file.stride,
    })
}
