//! Calibrations of a reconstructor: everything that a session has learned about wearer and sensors, for the next session.

use crate::reconstructor::Reconstructor;
use footfall_imu::GRAVITY_MPS2;
use footfall_model::{CalibratedSensor, CalibrationError, SensorCalibration};
use glam::Quat;

impl Reconstructor {
    /// Applies a calibration: mountings, errors of the sensors, and length of the wearer's steps.
    ///
    /// # Errors
    /// [`CalibrationError::OtherSites`] when it is for sensors at sites other than the model's; nothing is applied then.
    pub fn calibrate(&mut self, calibration: &SensorCalibration) -> Result<(), CalibrationError> {
        calibration.check()?;
        calibration.check_sites(&self.prepared().model().sites)?;
        for (n, sensor) in calibration.sensors.iter().enumerate() {
            self.set_mounting(n, sensor.site_from_sensor);
            self.set_rest(n, sensor.rate_bias, sensor.gravity_mps2);
        }
        self.set_stride(calibration.stride);
        Ok(())
    }

    /// Returns the calibration of wearer and sensors so far; `None` while a mounting is unknown. Names of devices are empty and every mounting counts as certain; the caller fills them in.
    pub fn calibration(&self) -> Option<SensorCalibration> {
        let sites = self.prepared().model().sites.iter().enumerate();
        let sensors: Option<Vec<CalibratedSensor>> = sites
            .map(|(n, site)| {
                let sensor = self.sensor(n)?;
                let mounting: Quat = sensor.mounting()?;
                let gravity_mps2 = sensor.gravity_mps2().unwrap_or(GRAVITY_MPS2);
                let worn = CalibratedSensor::mounted(*site, mounting);
                Some(worn.resting(sensor.rate_bias(), gravity_mps2))
            })
            .collect();
        Some(SensorCalibration {
            sensors: sensors?,
            stride: self.stride(),
        })
    }
}
