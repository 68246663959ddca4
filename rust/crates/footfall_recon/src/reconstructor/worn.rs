//! Wear of the sensors: their mountings, what they measure at rest, and what is wrong with them.

use super::Reconstructor;
use crate::prepared::Prepared;
use crate::problem::SensorProblem;
use crate::sensor::Sensor;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Silence that is told, seconds.
const SILENT_SECS: f32 = 1.0;

/// Time in which the model explains little before it is told, seconds.
const UNEXPLAINED_SECS: f32 = 1.0;

impl Reconstructor {
    /// Sets the mounting of a sensor: `site_from_sensor`. The identity for `aligned` mounting, which is what a new reconstructor takes it for.
    pub fn set_mounting(&mut self, sensor: usize, site_from_sensor: Quat) {
        self.wear(sensor, Some(site_from_sensor));
    }

    /// Forgets the mounting of a sensor: until it is set, its wearer is taken to stand.
    pub fn forget_mounting(&mut self, sensor: usize) {
        self.wear(sensor, None);
    }

    fn wear(&mut self, sensor: usize, mounting: Option<Quat>) {
        if let Some(own) = self.sensors.get_mut(sensor) {
            own.set_mounting(mounting);
            self.findings[sensor] = None;
            self.forget_samples();
        }
    }

    /// Begins anew with everything that follows from a row of samples.
    pub(super) fn forget_samples(&mut self) {
        self.ground.forget_sensor_heading();
        self.travel.forget_samples();
    }

    /// Sets what a sensor measures at rest: its angular rate, in its own axes, and the strength of gravity.
    pub fn set_rest(&mut self, sensor: usize, rate_bias: Vec3, gravity_mps2: f32) {
        if let Some(sensor) = self.sensors.get_mut(sensor) {
            sensor.set_rest(rate_bias, gravity_mps2);
        }
    }

    /// Length of the wearer's steps beside those of the people in the model: a sensor on a foot measures it as they walk, others leave it as it was set.
    pub const fn stride(&self) -> f32 {
        self.travel.stride()
    }

    /// Sets the length of the wearer's steps beside those of the people in the model, 0.7 to 1.4.
    pub const fn set_stride(&mut self, factor: f32) {
        self.travel.set_stride(factor);
    }

    pub(crate) const fn prepared(&self) -> &Arc<Prepared> {
        &self.prepared
    }

    pub(crate) fn sensor(&self, sensor: usize) -> Option<&Sensor> {
        self.sensors.get(sensor)
    }

    /// Says how many samples a second a sensor was promised to give, so that fewer or more are [told](Self::problem).
    pub fn promise_rate(&mut self, sensor: usize, rate_hz: f64) {
        if let Some(sensor) = self.sensors.get_mut(sensor).filter(|_| rate_hz > 0.0) {
            sensor.promise_rate(rate_hz);
        }
    }

    /// Sets what [`examine`](fn@crate::examine) found about how a sensor is worn, to be [told](Self::problem) until its mounting is set anew.
    pub fn set_finding(&mut self, sensor: usize, finding: Option<SensorProblem>) {
        if let Some(own) = self.findings.get_mut(sensor) {
            *own = finding;
        }
    }

    /// Problem of a sensor, with what to do about it; `None` while all is well and for a sensor that the model has not.
    pub fn problem(&self, sensor: usize) -> Option<SensorProblem> {
        let site = *self.prepared.model.sites.get(sensor)?;
        let own = &self.sensors[sensor];
        if self.silent_secs > SILENT_SECS.max(self.config.lost_after_secs) {
            return Some(SensorProblem::Silent);
        }
        let unexplained = self.unexplained_secs > UNEXPLAINED_SECS;
        own.problem()
            .or(self.findings[sensor])
            .or(unexplained.then_some(SensorProblem::Unexplained { site }))
    }
}
