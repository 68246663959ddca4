//! A reconstructor on a skeleton, and the sensors that it hears.

use super::worn::Worn;
use crate::imu_source::Heard;
use crate::travel::Traveller;
use footfall_core::{Behaviour, Pose};
use footfall_imu::{GRAVITY_MPS2, ImuSample};
use footfall_model::imu_model::MAX_SENSORS;
use footfall_recon::{Prepared, Reconstructor, SensorState};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Somebody has stood for so long before anything is heard: a second.
const STANDING_SAMPLES: u32 = 50;
const STANDING_RATE_HZ: f64 = 50.0;

/// A reconstructor on a skeleton.
pub(super) struct Session {
    pub(super) reconstructor: Reconstructor,
    pub(super) prepared: Arc<Prepared>,
    pub(super) traveller: Traveller,
    pub(super) sensors: [Worn; MAX_SENSORS],
    /// True when it is found out how sensors are worn.
    pub(super) finds_mountings: bool,
    /// Pose of the body before anything is heard.
    pub(super) standing: Pose,
    pub(super) pose: Pose,
    pub(super) behaviour: Behaviour,
    pub(super) state: SensorState,
}

/// Measurement of every sensor of a person who stands.
fn standing_sample(time_secs: f64) -> ImuSample {
    ImuSample {
        time_secs,
        force: Vec3::Y * GRAVITY_MPS2,
        rate: Vec3::ZERO,
    }
}

/// The pose, above the body's place, of somebody who stands.
pub(super) fn standing(reconstructor: &Reconstructor) -> Pose {
    let mut own = reconstructor.clone();
    let mut pose = Pose::default();
    for n in 0..STANDING_SAMPLES {
        for sensor in 0..MAX_SENSORS {
            own.push(sensor, standing_sample(f64::from(n) / STANDING_RATE_HZ));
        }
        own.step((1.0 / STANDING_RATE_HZ) as f32, &mut pose);
    }
    own.split(&mut pose);
    pose
}

/// A sample as the reconstructor takes it: as long as nobody knows how the sensor is worn, the person is taken to stand.
fn understood(sample: ImuSample, unknown_mounting: bool) -> ImuSample {
    if !unknown_mounting || !sample.is_finite() {
        return sample;
    }
    standing_sample(sample.time_secs)
}

impl Session {
    pub(super) fn push(&mut self, sensor: usize, sample: ImuSample) {
        let Some(worn) = self.sensors.get_mut(sensor) else {
            return;
        };
        if sample.is_finite() {
            worn.keep(sample);
        }
        let understood = understood(sample, self.finds_mountings && worn.mounting.is_none());
        self.reconstructor.push(sensor, understood);
    }

    /// Takes what a source gives in a frame.
    pub(super) fn hear(&mut self, sensor: usize, heard: Heard, delta: f64) {
        let reconstructor = &mut self.reconstructor;
        let worn = &mut self.sensors[sensor];
        let unknown = self.finds_mountings && worn.mounting.is_none();
        worn.hear(heard, delta, |sample| {
            reconstructor.push(sensor, understood(sample, unknown));
        });
    }

    pub(super) fn forget_mountings(&mut self) {
        for (sensor, worn) in self.sensors.iter_mut().enumerate() {
            worn.forget_mounting();
            self.reconstructor.set_mounting(sensor, Quat::IDENTITY);
        }
        self.reconstructor.reset();
    }

    pub(super) fn find_mountings(&mut self) {
        let used = self.prepared.model().sites.len();
        for (sensor, worn) in self.sensors.iter_mut().enumerate().take(used) {
            if let Some(mounting) = worn.find_mounting(&self.prepared, sensor) {
                self.reconstructor.set_mounting(sensor, mounting);
            }
        }
    }
}
