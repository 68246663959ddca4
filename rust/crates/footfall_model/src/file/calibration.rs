//! `.footcal` files: the container of every model, with errors that ask for a calibration and not for a training.

use super::container::{read_container, write_container};
use super::{CALIBRATION_KIND, FORMAT_1, ModelFileError, calibration_v1, check_kind};
use crate::provenance::Provenance;
use crate::sensor_calibration::{CalibrationError, SensorCalibration};

impl SensorCalibration {
    /// The bytes of a `.footcal` file.
    ///
    /// # Errors
    /// [`CalibrationError::Value`] when it would not load again.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CalibrationError> {
        self.check()?;
        let payload = calibration_v1::encode(self)?;
        let provenance = Provenance::default();
        Ok(write_container(
            FORMAT_1,
            CALIBRATION_KIND,
            &provenance,
            &payload,
        )?)
    }

    /// The calibration in the bytes of a `.footcal` file.
    ///
    /// # Errors
    /// [`CalibrationError`] says what is wrong with the bytes, and what to do; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CalibrationError> {
        let (version, header, payload) = read_container(bytes)?;
        check_kind(&header, CALIBRATION_KIND)?;
        if version > FORMAT_1 {
            return Err(CalibrationError::Newer {
                written_by: header.written_by,
            });
        }
        let calibration = calibration_v1::decode(payload)?;
        calibration.check()?;
        Ok(calibration)
    }
}

impl From<ModelFileError> for CalibrationError {
    fn from(error: ModelFileError) -> Self {
        match error {
            ModelFileError::NotAModel | ModelFileError::WrongKind { .. } => Self::NotACalibration,
            ModelFileError::Newer { written_by, .. } => Self::Newer { written_by },
            ModelFileError::Truncated { .. }
            | ModelFileError::Damaged
            | ModelFileError::Undecodable { .. }
            | ModelFileError::Content(_) => Self::Damaged,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor_calibration::CalibratedSensor;
    use footfall_core::Site;
    use glam::{Quat, Vec3};

    fn calibration() -> SensorCalibration {
        let foot = CalibratedSensor {
            device: "/dev/ttyUSB0".to_owned(),
            certainty: 0.97,
            rate_bias: Vec3::new(0.01, -0.02, 0.005),
            gravity_mps2: 9.71,
            ..CalibratedSensor::mounted(Site::RightFoot, Quat::from_rotation_x(1.2))
        };
        SensorCalibration {
            sensors: vec![foot],
            stride: 1.12,
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let bytes = calibration().to_bytes().unwrap();
        assert!(bytes.len() < 300, "{} bytes", bytes.len());
        assert_eq!(SensorCalibration::from_bytes(&bytes), Ok(calibration()));
    }

    #[test]
    fn what_is_no_calibration_says_what_to_do() {
        let bytes = calibration().to_bytes().unwrap();
        let fails = |bytes: &[u8]| SensorCalibration::from_bytes(bytes).unwrap_err();
        assert_eq!(fails(b"none"), CalibrationError::NotACalibration);
        for end in 8..bytes.len() {
            assert_eq!(
                fails(&bytes[..end]),
                CalibrationError::Damaged,
                "{end} bytes"
            );
        }
        for byte in 16..bytes.len() {
            let mut changed = bytes.clone();
            changed[byte] ^= 0x10;
            assert_eq!(fails(&changed), CalibrationError::Damaged, "byte {byte}");
        }
        let mut model = bytes.clone();
        model[8] = 99;
        assert!(matches!(fails(&model), CalibrationError::Newer { .. }));
        // A version that is known of models only.
        let payload = calibration_v1::encode(&calibration()).unwrap();
        let later = write_container(2, CALIBRATION_KIND, &Provenance::default(), &payload).unwrap();
        let text = fails(&later).to_string();
        assert!(text.contains("calibrate again"), "{text}");
        let other = write_container(FORMAT_1, "imu", &Provenance::default(), &payload).unwrap();
        assert_eq!(fails(&other), CalibrationError::NotACalibration);
    }

    #[test]
    fn numbers_that_cannot_be_are_refused() {
        let mut turned = calibration();
        turned.sensors[0].site_from_sensor = Quat::from_xyzw(0.0, 0.0, 0.0, 2.0);
        let mut still = calibration();
        still.sensors[0].rate_bias = Vec3::NAN;
        let mut light = calibration();
        light.sensors[0].gravity_mps2 = 1.0;
        let mut long = calibration();
        long.stride = 9.0;
        let mut none = calibration();
        none.sensors.clear();
        for (wrong, part) in [
            (turned, "mounting"),
            (still, "bias"),
            (light, "gravity"),
            (long, "steps"),
            (none, "number"),
        ] {
            let text = wrong.to_bytes().unwrap_err().to_string();
            assert!(text.contains(part), "{text}");
        }
    }

    #[test]
    fn sites_and_devices_are_compared() {
        let own = calibration();
        assert_eq!(own.check_sites(&[Site::RightFoot]), Ok(()));
        let text = own
            .check_sites(&[Site::RightThigh])
            .unwrap_err()
            .to_string();
        assert!(
            text.contains("for right_foot, the model for right_thigh"),
            "{text}"
        );
        assert!(own.check_sites(&[Site::RightFoot, Site::Root]).is_err());
        assert_eq!(own.check_device(0, "/dev/ttyUSB0"), Ok(()));
        assert_eq!(own.check_device(0, ""), Ok(()), "a replay has no name");
        let text = own.check_device(0, "COM3").unwrap_err().to_string();
        assert!(text.contains("connect '/dev/ttyUSB0'"), "{text}");
    }
}
