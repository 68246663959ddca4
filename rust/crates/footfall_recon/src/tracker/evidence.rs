//! Evidence of a measurement for each frame of the model.

use super::{Measurement, Tracker};
use crate::confidence::Confidence;
use crate::kernels::{distances, weigh};
use crate::stride_phase::{NO_STRIDE, PHASE_COUNT, PHASE_DEVIATION};
use footfall_core::Behaviour;
use footfall_model::imu_model::MAX_WIDTH;

/// Most numbers that a frame is compared by: those of the sensors, and the phase of the stride.
const MOST_NUMBERS: usize = MAX_WIDTH + PHASE_COUNT;

/// Frames that are predicted with less than this share of what each would have if all were alike are not compared with the measurement.
const LEAST_SHARE: f32 = 0.15;

impl Tracker {
    /// Goes on by a frame in which the phase of the stride counts by as much as the wearer is a stranger, the body is known to walk or run and the model explains it;
    /// weighs it so in `sensor`. The sensors of a wearer who moves like people in the model are more informative, and a shaken sensor also has a rhythm.
    pub(crate) fn step_striding(&mut self, sensor: Option<&mut Measurement>, explains: Confidence) {
        let strides = self.strangeness.share() * self.strides() * explains.trusted();
        let sensor = sensor.map(|sensor| {
            sensor.stride.weight *= strides;
            &*sensor
        });
        self.step(sensor);
    }

    /// Weighs what may be with what was measured (appendix A, "update"). Returns the sum.
    pub(super) fn update(&mut self, sensor: &Measurement) -> f32 {
        let limit = LEAST_SHARE / self.prepared.frames as f32;
        let nearest = self.measure(sensor, limit);
        let factor = self.factor(sensor);
        let sum = weigh(
            &self.predicted,
            &self.distance,
            factor,
            [nearest, self.farthest()],
            &mut self.weighed,
        );
        self.log_density = f64::from(sum.max(f32::MIN_POSITIVE)).ln() + f64::from(factor * nearest);
        self.log_likelihood += self.log_density;
        sum
    }

    /// Compares what was measured with what the probable frames measured: how strange the wearer is.
    pub(super) fn compare(&mut self, sensor: &Measurement) {
        let model = &*self.prepared.model;
        let mut expected = [0.0; MAX_WIDTH];
        self.expected_sensor(&mut expected);
        let numbers = model.deviations.iter().enumerate();
        let squares = numbers.map(|(n, deviation)| {
            let apart = (sensor.values[n] - expected[n]) / deviation;
            sensor.weights[n] * apart * apart
        });
        let distance = squares.sum::<f32>().min(self.farthest()) / model.sites.len() as f32;
        let moves = 1.0 - self.behaviours[Behaviour::Stand.index()];
        self.strangeness
            .step(distance, moves / model.frame_rate_hz as f32);
    }

    /// Factor from a squared distance of all sensors to the logarithm of a probability.
    pub(super) fn factor(&self, sensor: &Measurement) -> f32 {
        -0.5 * self.config.evidence * self.counted(sensor) / self.prepared.model.sites.len() as f32
    }

    /// Share of a measurement that counts.
    fn counted(&self, sensor: &Measurement) -> f32 {
        1.0 - self.stride_weight(sensor) * (1.0 - self.config.repeated)
    }

    /// Weight of the phase of the stride.
    fn stride_weight(&self, sensor: &Measurement) -> f32 {
        if self.prepared.has_strides() {
            self.config.stride * sensor.stride.weight
        } else {
            0.0
        }
    }

    /// Probability that the body walks or runs.
    const fn strides(&self) -> f32 {
        self.behaviours[Behaviour::Walk.index()] + self.behaviours[Behaviour::Run.index()]
    }

    /// Squared distance of all sensors beyond which a frame counts as no farther.
    pub(super) fn farthest(&self) -> f32 {
        self.config.farthest * self.prepared.model.sites.len() as f32
    }

    /// Measures how far frames that are predicted with more than a limit are from what was measured. Returns the least distance.
    pub(super) fn measure(&mut self, sensor: &Measurement, limit: f32) -> f32 {
        let farthest = self.farthest();
        if let Some(phases) = &self.prepared.phase_deviations {
            phases.distances(&self.prepared, sensor, &mut self.distance);
            return self.distance.iter().copied().fold(farthest, f32::min);
        }
        let (mut measured, mut weights) = ([0.0; MOST_NUMBERS], [0.0; MOST_NUMBERS]);
        let deviations = &self.prepared.model.deviations;
        for (n, deviation) in deviations.iter().enumerate() {
            measured[n] = sensor.values[n] / deviation;
            weights[n] = sensor.weights[n];
        }
        let mut width = deviations.len();
        // Its evidence counts in full.
        let stride = self.stride_weight(sensor) / self.counted(sensor);
        if stride > 0.0 {
            for value in sensor.stride.values {
                (measured[width], weights[width]) = (value / PHASE_DEVIATION, stride);
                width += 1;
            }
        }
        let mut nearest = distances(
            &self.prepared.sensor,
            self.prepared.columns,
            [&measured[..width], &weights[..width]],
            &self.predicted,
            limit,
            &mut self.distance,
        );
        if stride > 0.0 {
            // Their phase of zeros is as far from all others.
            let nearer = stride * (PHASE_DEVIATION.powi(-2) - NO_STRIDE);
            for frames in &self.prepared.without_stride {
                for distance in &mut self.distance[frames.clone()] {
                    *distance -= nearer;
                    nearest = nearest.min(*distance);
                }
            }
        }
        nearest.min(farthest)
    }
}
