//! Mountings of the sensors, their values at rest, and their problems.

use super::Reconstructor;
use crate::prepared::Prepared;
use crate::problem::SensorProblem;
use crate::sensor::Sensor;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Silence after which it is reported, seconds.
const SILENT_SECS: f32 = 1.0;

/// Time of little explained motion after which it is reported, seconds.
const UNEXPLAINED_SECS: f32 = 1.0;

impl Reconstructor {
    /// Sets the mounting of a sensor: `site_from_sensor`. The identity is the `aligned` mounting, which a new reconstructor assumes.
    pub fn set_mounting(&mut self, sensor: usize, site_from_sensor: Quat) {
        self.wear(sensor, Some(site_from_sensor));
    }

    /// Discards the mounting of a sensor: until it is set, the wearer is assumed to stand.
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

    /// Restarts everything that depends on a sequence of samples.
    pub(super) fn forget_samples(&mut self) {
        self.ground.forget_sensor_heading();
        self.travel.forget_samples();
        self.clock.forget();
    }

    /// Sets a sensor's measurements at rest: its angular rate, in its own axes, and the strength of gravity.
    pub fn set_rest(&mut self, sensor: usize, rate_bias: Vec3, gravity_mps2: f32) {
        if let Some(sensor) = self.sensors.get_mut(sensor) {
            sensor.set_rest(rate_bias, gravity_mps2);
        }
    }

    /// Returns the length of the wearer's steps relative to the people in the model. A foot sensor measures it; with other sensors it stays as set.
    pub const fn stride(&self) -> f32 {
        self.travel.stride()
    }

    /// Sets the length of the wearer's steps relative to the people in the model, 0.7 to 1.4.
    pub const fn set_stride(&mut self, factor: f32) {
        self.travel.set_stride(factor);
    }

    pub(crate) const fn prepared(&self) -> &Arc<Prepared> {
        &self.prepared
    }

    pub(crate) fn sensor(&self, sensor: usize) -> Option<&Sensor> {
        self.sensors.get(sensor)
    }

    /// Sets the sample rate that a sensor should deliver; other rates are [reported](Self::problem).
    pub fn promise_rate(&mut self, sensor: usize, rate_hz: f64) {
        if let Some(sensor) = self.sensors.get_mut(sensor).filter(|_| rate_hz > 0.0) {
            sensor.promise_rate(rate_hz);
        }
    }

    /// Sets the finding of [`examine`](fn@crate::examine) about the mounting, which is [reported](Self::problem) until the mounting is set again.
    pub fn set_finding(&mut self, sensor: usize, finding: Option<SensorProblem>) {
        if let Some(own) = self.findings.get_mut(sensor) {
            *own = finding;
        }
    }

    /// Returns the problem of a sensor, with what to do about it; `None` if there is none or the model has no such sensor.
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
