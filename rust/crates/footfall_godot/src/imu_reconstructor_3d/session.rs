//! A reconstructor on a skeleton, and its sensors.

use super::worn_sensor::WornSensor;
use crate::imu_source::SourceSamples;
use crate::travel::Traveller;
use footfall_core::{Behaviour, Pose};
use footfall_imu::ImuSample;
use footfall_model::imu_model::MAX_SENSORS;
use footfall_model::{CalibrationError, SensorCalibration};
use footfall_recon::{
    CalibrationGuide, GuideStep, Prepared, Reconstructor, SensorProblem, SensorState,
};
use glam::Quat;
use std::sync::Arc;

/// Samples of standing that give the pose before the first real sample: a second.
const STANDING_SAMPLES: u32 = 50;
const STANDING_RATE_HZ: f64 = 50.0;

/// A reconstructor on a skeleton.
pub(crate) struct SensorSession {
    pub(super) reconstructor: Reconstructor,
    pub(super) prepared: Arc<Prepared>,
    pub(super) traveller: Traveller,
    pub(super) sensors: [WornSensor; MAX_SENSORS],
    /// True if the mounting of the sensors is estimated.
    pub(super) finds_mountings: bool,
    /// Pose of the body before the first sample.
    pub(super) standing: Pose,
    pub(super) pose: Pose,
    pub(super) behaviour: Behaviour,
    /// The calibration under way, and the last request to the player.
    pub(super) guide: Option<CalibrationGuide>,
    pub(super) asked: Option<GuideStep>,
    /// Problems of the sensors that were emitted last.
    pub(super) problems: [Option<SensorProblem>; MAX_SENSORS],
    pub(super) state: SensorState,
}

/// The pose, above the body's place, of a standing person.
pub(super) fn standing(reconstructor: &Reconstructor) -> Pose {
    let mut own = reconstructor.clone();
    let mut pose = Pose::default();
    for n in 0..STANDING_SAMPLES {
        for sensor in 0..MAX_SENSORS {
            own.push(sensor, ImuSample::standing(f64::from(n) / STANDING_RATE_HZ));
        }
        own.step((1.0 / STANDING_RATE_HZ) as f32, &mut pose);
    }
    own.split(&mut pose);
    pose
}

impl SensorSession {
    /// Takes over the sensors of an earlier session of the same skeleton and model: their sources, recordings and mountings.
    pub(super) fn take_over(&mut self, before: Self) {
        let same = Arc::ptr_eq(&self.prepared, &before.prepared)
            && self.traveller.skeleton() == before.traveller.skeleton();
        if !same {
            return;
        }
        if let Some(calibration) = before.reconstructor.calibration()
            && self.reconstructor.calibrate(&calibration).is_err()
        {
            return;
        }
        self.sensors = before.sensors;
        (self.guide, self.asked) = (before.guide, before.asked);
    }

    /// Takes a sample from a script.
    pub(super) fn push(&mut self, sensor: usize, sample: ImuSample) {
        let Some(worn) = self.sensors.get_mut(sensor) else {
            return;
        };
        if sample.is_finite() {
            worn.keep(sample);
        }
        self.take(sensor, sample);
    }

    /// Takes a source's samples of a frame.
    pub(super) fn hear(&mut self, sensor: usize, samples: SourceSamples, delta: f64) {
        let mut worn = core::mem::take(&mut self.sensors[sensor]);
        worn.hear(samples, delta, |sample| self.take(sensor, sample));
        self.sensors[sensor] = worn;
    }

    fn take(&mut self, sensor: usize, sample: ImuSample) {
        if let Some(guide) = self.guide.as_mut().filter(|_| sensor == 0) {
            guide.push(&sample);
        }
        self.reconstructor.push(sensor, sample);
    }

    pub(super) fn forget_mountings(&mut self) {
        for (sensor, worn) in self.sensors.iter_mut().enumerate() {
            worn.forget_mounting();
            if self.finds_mountings {
                self.reconstructor.forget_mounting(sensor);
            }
        }
        self.reconstructor.reset();
    }

    /// Estimates the mounting of the sensors at intervals, and its problems.
    pub(super) fn look(&mut self) {
        let used = self.prepared.model().sites.len();
        let asked = self.guide.is_some_and(|guide| guide.wants_mounting());
        for (sensor, worn) in self.sensors.iter_mut().enumerate().take(used) {
            let aligned = (!self.finds_mountings).then_some(Quat::IDENTITY);
            let Some(seen) = worn.look(&self.prepared, sensor, aligned, asked) else {
                continue;
            };
            if let Some(mounting) = seen.mounting {
                self.reconstructor
                    .set_mounting(sensor, mounting.site_from_sensor);
                if let Some(rest) = seen.rest {
                    let gravity = rest.force.length();
                    self.reconstructor.set_rest(sensor, rest.rate_bias, gravity);
                }
            }
            self.reconstructor.set_finding(sensor, seen.finding);
            // An estimate that began before the steps were taken does not include them.
            if let Some(guide) = &mut self.guide
                && (seen.asked || !guide.wants_mounting())
            {
                guide.found(worn.mounting.map_or(0.0, |found| found.certainty));
            }
        }
    }

    /// Calibration of wearer and sensors so far; `None` while a mounting is unknown.
    pub(super) fn calibration(&self) -> Option<SensorCalibration> {
        let mut calibration = self.reconstructor.calibration()?;
        for (sensor, worn) in calibration.sensors.iter_mut().zip(&self.sensors) {
            sensor.device = worn.device_name();
            sensor.certainty = worn.mounting.map_or(1.0, |found| found.certainty);
        }
        Some(calibration)
    }

    /// Takes over a calibration.
    pub(super) fn calibrate(
        &mut self,
        calibration: &SensorCalibration,
    ) -> Result<(), CalibrationError> {
        for (sensor, worn) in self.sensors.iter().enumerate() {
            calibration.check_device(sensor, &worn.device_name())?;
        }
        self.reconstructor.calibrate(calibration)?;
        for (worn, calibrated) in self.sensors.iter_mut().zip(&calibration.sensors) {
            worn.calibrate(calibrated);
        }
        self.guide = None;
        Ok(())
    }
}
