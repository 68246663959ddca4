//! Calibration of sensors on a wearer: how each is worn, what it measures at rest, and how long the wearer's steps are.

use crate::imu_model::MAX_SENSORS;
use footfall_core::Site;
use glam::{Quat, Vec3};

/// Gravity that an accelerometer may measure, m/s²: one that is further off is broken.
const GRAVITY: core::ops::RangeInclusive<f32> = 7.0..=13.0;

/// Greatest bias of a gyroscope, rad/s.
const MOST_BIAS: f32 = 0.5;

/// Factors on the length of steps that can be.
const STRIDES: core::ops::RangeInclusive<f32> = 0.5..=2.0;

/// Calibration of the sensors of one wearer (`.footcal`).
#[derive(Clone, Debug, PartialEq)]
pub struct SensorCalibration {
    /// The sensors, in the order of the model's sites.
    pub sensors: Vec<CalibratedSensor>,
    /// Length of the wearer's steps beside those of the people in the model.
    pub stride: f32,
}

/// One sensor, as it is worn.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibratedSensor {
    /// The place on the body.
    pub site: Site,
    /// Name of the device, by which it is known again; empty where it has none.
    pub device: String,
    /// Rotation from the sensor's axes to the site's.
    pub site_from_sensor: Quat,
    /// Probability that no very different mounting is right, 0 to 1.
    pub certainty: f32,
    /// Angular rate at rest, in the sensor's axes, rad/s.
    pub rate_bias: Vec3,
    /// Magnitude of specific force at rest, m/s².
    pub gravity_mps2: f32,
}

impl CalibratedSensor {
    /// A sensor without errors that is mounted so, with certainty.
    pub const fn mounted(site: Site, site_from_sensor: Quat) -> Self {
        Self {
            site,
            device: String::new(),
            site_from_sensor,
            certainty: 1.0,
            rate_bias: Vec3::ZERO,
            gravity_mps2: 9.806_65,
        }
    }

    /// The same sensor, which measured this at rest; what cannot be is left out.
    #[must_use]
    pub fn resting(mut self, rate_bias: Vec3, gravity_mps2: f32) -> Self {
        if rate_bias.length() <= MOST_BIAS {
            self.rate_bias = rate_bias;
        }
        if GRAVITY.contains(&gravity_mps2) {
            self.gravity_mps2 = gravity_mps2;
        }
        self
    }

    fn fault(&self) -> Option<&'static str> {
        let bias = self.rate_bias.length();
        if !self.site_from_sensor.is_normalized() {
            Some("mounting")
        } else if !(0.0..=1.0).contains(&self.certainty) {
            Some("certainty")
        } else if bias.is_nan() || bias > MOST_BIAS {
            Some("bias of the angular rate")
        } else if !GRAVITY.contains(&self.gravity_mps2) {
            Some("gravity at rest")
        } else {
            None
        }
    }
}

/// Errors of reading or using a calibration.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CalibrationError {
    /// The bytes are no calibration.
    #[error("the file is not a sensor calibration; calibrate, and save the calibration")]
    NotACalibration,
    /// The file was written by a later version.
    #[error(
        "the calibration has a format of Footfall {written_by}, which this build does not know; update Footfall, or calibrate again"
    )]
    Newer {
        /// The version of Footfall that wrote it.
        written_by: String,
    },
    /// The bytes were changed, or end too early.
    #[error("the calibration is damaged; calibrate again")]
    Damaged,
    /// A number makes no sense.
    #[error("the calibration's {part} is not valid; calibrate again")]
    Value {
        /// Name of the part.
        part: &'static str,
    },
    /// It is for sensors at other sites than the model's.
    #[error(
        "the calibration is for {calibrated}, the model for {model}; load the model for {calibrated}, or calibrate again"
    )]
    OtherSites {
        /// Sites of the calibration.
        calibrated: String,
        /// Sites of the model.
        model: String,
    },
    /// It is of another sensor than the one that is connected.
    #[error(
        "the calibration is of the sensor '{calibrated}', but '{connected}' is connected; connect '{calibrated}', or calibrate again"
    )]
    OtherDevice {
        /// Name of the device in the calibration.
        calibrated: String,
        /// Name of the one that is connected.
        connected: String,
    },
}

impl SensorCalibration {
    /// Checks that the numbers can be.
    ///
    /// # Errors
    /// [`CalibrationError::Value`] names the part at fault.
    pub fn check(&self) -> Result<(), CalibrationError> {
        let fault = if !(1..=MAX_SENSORS).contains(&self.sensors.len()) {
            Some("number of sensors")
        } else if STRIDES.contains(&self.stride) {
            self.sensors.iter().find_map(CalibratedSensor::fault)
        } else {
            Some("length of steps")
        };
        fault.map_or(Ok(()), |part| Err(CalibrationError::Value { part }))
    }

    /// Checks that it is for these sites, in this order.
    ///
    /// # Errors
    /// [`CalibrationError::OtherSites`] names both.
    pub fn check_sites(&self, sites: &[Site]) -> Result<(), CalibrationError> {
        if self
            .sensors
            .iter()
            .map(|sensor| sensor.site)
            .eq(sites.iter().copied())
        {
            return Ok(());
        }
        let names = |sites: &mut dyn Iterator<Item = Site>| {
            let names: Vec<&str> = sites.map(Site::name).collect();
            names.join(" and ")
        };
        Err(CalibrationError::OtherSites {
            calibrated: names(&mut self.sensors.iter().map(|sensor| sensor.site)),
            model: names(&mut sites.iter().copied()),
        })
    }

    /// Checks that a sensor, by its number, is the device of this name. One without a name in the calibration or in `connected` may be any.
    ///
    /// # Errors
    /// [`CalibrationError::OtherDevice`] names both.
    pub fn check_device(&self, sensor: usize, connected: &str) -> Result<(), CalibrationError> {
        let calibrated = self
            .sensors
            .get(sensor)
            .map_or("", |own| own.device.as_str());
        if calibrated.is_empty() || connected.is_empty() || calibrated == connected {
            return Ok(());
        }
        Err(CalibrationError::OtherDevice {
            calibrated: calibrated.to_owned(),
            connected: connected.to_owned(),
        })
    }
}
