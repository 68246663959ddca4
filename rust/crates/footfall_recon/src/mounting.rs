//! Mounting of a sensor, estimated from its measurements.
//!
//! Gravity determines two of the three angles: the mean vertical over a stretch of motion must match the model's. The third angle is the one under which
//! the model explains the motion best. A few candidates are refined together with the other two angles, alternately finding the frames of the model and the rotation
//! that brings the measurements closest to theirs (Wahba's problem). The margin of the best over very different ones gives the certainty.
//!
//! The mounting is found to within a few degrees from 2 s of walking, turning, jumping or hopping; of two runs of 1.4 s one was found and one was not, with certainty.

use crate::measure::{SensorFrame, measure};
use crate::prepared::Prepared;
use crate::tracker::{Measurement, Tracker, TrackerConfig};
use core::f32::consts::TAU;
use footfall_imu::{FeatureFrame, FeatureStream, ImuRecording};
use footfall_model::imu_model::{MAX_SENSORS, MAX_WIDTH, SENSOR_COUNT};
use glam::{Mat3, Quat, Vec3};
use nalgebra::Matrix3;
use std::sync::Arc;

/// Number of rotations about the vertical to try.
const CANDIDATES: usize = 24;

/// Number of the best ones to refine.
const REFINED: usize = 5;

/// Rounds of refinement for each.
const ROUNDS: usize = 3;

/// Maximum number of frames used, 6 seconds at 30 frames a second.
const MOST_FRAMES: usize = 180;

/// Minimum time of motion for a mounting, seconds.
const LEAST_SECS: f64 = 1.0;

/// Angular rate below which a sensor rests, rad/s.
const REST_RADPS: f32 = 0.5;

/// Angle within which rotations count as the same mounting, radians.
const SAME: f32 = 0.6;

/// Mounting of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    /// Rotation from the sensor's axes to the site's.
    pub site_from_sensor: Quat,
    /// Probability that no very different rotation is right, 0 to 1.
    pub certainty: f32,
}

/// Errors of finding a mounting.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MountingError {
    /// Too little motion was recorded.
    #[error(
        "the sensor moves for {moving_secs:.1} s, too little to find its mounting; take a few steps, or align it with the body and pass `--mounting aligned`"
    )]
    TooLittleMotion {
        /// Time for which it moves.
        moving_secs: f64,
    },
}

/// Finds how the sensor at a site of the model is worn.
///
/// # Errors
/// [`MountingError::TooLittleMotion`] when the recording shows less than a second of motion.
pub fn find_mounting(
    prepared: &Arc<Prepared>,
    sensor: usize,
    recording: &ImuRecording,
    config: &TrackerConfig,
) -> Result<Mounting, MountingError> {
    let frames = moving_frames(recording, prepared.model.frame_rate_hz)?;
    Ok(Finder::new(prepared, sensor, &frames, config)
        .best()
        .mounting)
}

/// The best mounting, and how well the model explains the frames with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    pub(crate) mounting: Mounting,
    pub(crate) log_likelihood: f64,
}

/// Frames in the sensor's axes, from shortly before it begins to move.
pub(crate) fn moving_frames(
    recording: &ImuRecording,
    rate_hz: f64,
) -> Result<Vec<FeatureFrame>, MountingError> {
    let mut frames = FeatureStream::frames_of(recording, rate_hz);
    let begin = frames.iter().position(turns).unwrap_or(0);
    let lead = (0.5 * rate_hz) as usize;
    frames.drain(..begin.saturating_sub(lead));
    frames.truncate(MOST_FRAMES);
    let moving = frames.iter().filter(|frame| turns(frame)).count();
    let moving_secs = moving as f64 / rate_hz;
    if moving_secs < LEAST_SECS {
        return Err(MountingError::TooLittleMotion { moving_secs });
    }
    Ok(frames)
}

fn turns(frame: &FeatureFrame) -> bool {
    frame
        .values
        .is_some_and(|values| Vec3::from_slice(&values[..3]).length() > REST_RADPS)
}

/// Tries mountings on frames of a sensor.
pub(crate) struct Finder<'a> {
    prepared: &'a Prepared,
    sensor: usize,
    frames: &'a [FeatureFrame],
    tracker: Tracker,
}

impl<'a> Finder<'a> {
    /// For the frames of a sensor, by its number in the model.
    pub(crate) fn new(
        prepared: &'a Arc<Prepared>,
        sensor: usize,
        frames: &'a [FeatureFrame],
        config: &TrackerConfig,
    ) -> Self {
        // The misfit of a wrong rotation is as informative as the fit of the right one.
        let config = TrackerConfig {
            farthest: f32::INFINITY,
            ..*config
        };
        Self {
            prepared,
            sensor,
            frames,
            tracker: Tracker::new(prepared, config),
        }
    }

    /// The mounting under which the model explains the frames best.
    pub(crate) fn best(&mut self) -> Found {
        let level = self.level();
        let mut found: Vec<(f64, Quat)> = (0..CANDIDATES)
            .map(|n| {
                let turn = Quat::from_axis_angle(level.1, TAU * n as f32 / CANDIDATES as f32);
                let candidate = turn * level.0;
                (self.explain(candidate, None), candidate)
            })
            .collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(REFINED);
        for (likelihood, rotation) in &mut found {
            for _ in 0..ROUNDS {
                let mut attitude = Matrix3::zeros();
                self.explain(*rotation, Some(&mut attitude));
                *rotation = closest_rotation(&attitude).unwrap_or(*rotation);
            }
            *likelihood = self.explain(*rotation, None);
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (best, site_from_sensor) = found[0];
        let rival = found
            .iter()
            .find(|(_, rotation)| rotation.angle_between(site_from_sensor) > SAME)
            .map_or(f64::NEG_INFINITY, |(likelihood, _)| *likelihood);
        Found {
            mounting: Mounting {
                site_from_sensor,
                certainty: (1.0 / (1.0 + (rival - best).exp())) as f32,
            },
            log_likelihood: best,
        }
    }

    /// A rotation that brings the mean of up to the model's, and that direction.
    fn level(&self) -> (Quat, Vec3) {
        let measured: Vec3 = self
            .frames
            .iter()
            .filter_map(|frame| Some(Vec3::from_slice(&frame.values?[6..]) / frame.tilt_deviation))
            .sum();
        let model = &self.prepared.model;
        let width = model.sensor_width();
        let at = self.sensor * SENSOR_COUNT;
        let up: Vec3 = model
            .sensor
            .chunks_exact(width)
            .filter(|row| Vec3::from_slice(&row[at..at + 3]).length() > REST_RADPS)
            .map(|row| Vec3::from_slice(&row[at + 6..at + 9]))
            .sum();
        let up = up.normalize_or(Vec3::Y);
        (footfall_core::rotation::shortest_arc(measured, up), up)
    }

    /// Returns how well the model explains the frames when they are turned so. Adds up what was expected by what was measured, if asked to.
    pub(crate) fn explain(
        &mut self,
        site_from_sensor: Quat,
        mut attitude: Option<&mut Matrix3<f64>>,
    ) -> f64 {
        self.tracker.reset();
        let at = self.sensor * SENSOR_COUNT;
        for frame in self.frames {
            let measured = self.measured(frame, site_from_sensor);
            self.tracker.step(measured.as_ref());
            let (Some(attitude), Some(values)) = (attitude.as_deref_mut(), frame.values) else {
                continue;
            };
            let mut expected = [0.0; MAX_WIDTH];
            self.tracker
                .expected_sensor(&mut expected[..self.prepared.model.sensor_width()]);
            let deviations = &self.prepared.model.deviations[at..];
            // Specific force is left out: impacts make it the worst of the three.
            for part in [0, 6] {
                let spread: f32 = deviations[part..part + 3].iter().map(|d| d * d).sum();
                let weight = 1.0 / spread / (1.0 + (frame.tilt_deviation / 0.1).powi(2));
                let wanted = Vec3::from_slice(&expected[at + part..at + part + 3]) * weight;
                let had = Vec3::from_slice(&values[part..part + 3]);
                let product = Mat3::from_cols(wanted * had.x, wanted * had.y, wanted * had.z);
                let columns = product.to_cols_array().map(f64::from);
                *attitude += Matrix3::from_column_slice(&columns);
            }
        }
        self.tracker.log_likelihood()
    }

    /// A frame as the tracker takes it, with this sensor alone.
    fn measured(&self, frame: &FeatureFrame, site_from_sensor: Quat) -> Option<Measurement> {
        let mut turned = *frame;
        if let Some(values) = &mut turned.values {
            for vector in values.chunks_exact_mut(3) {
                let there = site_from_sensor * Vec3::from_slice(vector);
                vector.copy_from_slice(&there.to_array());
            }
        }
        let mut frames = [None; MAX_SENSORS];
        frames[self.sensor] = Some(SensorFrame {
            frame: turned,
            contact: None,
        });
        measure(&self.prepared.model, &frames)
    }
}

/// The rotation that a sum of products of wanted and measured vectors is closest to (Wahba 1965, by singular values).
fn closest_rotation(attitude: &Matrix3<f64>) -> Option<Quat> {
    let parts = attitude.svd(true, true);
    let (u, v) = (parts.u?, parts.v_t?);
    let mut sign = Matrix3::identity();
    sign[(2, 2)] = (u * v).determinant().signum();
    let rotation = u * sign * v;
    let columns: Vec<f32> = rotation.iter().map(|value| *value as f32).collect();
    let quat = Quat::from_mat3(&Mat3::from_cols_slice(&columns)).normalize();
    quat.is_finite().then_some(quat)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_between_two_sets_of_vectors_is_found() {
        let truth = Quat::from_scaled_axis(Vec3::new(0.7, -1.9, 0.4));
        let mut attitude = Matrix3::zeros();
        for vector in [
            Vec3::X,
            Vec3::new(0.3, 2.0, -1.0),
            Vec3::new(-1.0, 0.2, 0.5),
        ] {
            let turned = truth * vector;
            for (row, wanted) in turned.to_array().into_iter().enumerate() {
                for (column, had) in vector.to_array().into_iter().enumerate() {
                    attitude[(row, column)] += f64::from(wanted * had);
                }
            }
        }
        let found = closest_rotation(&attitude).unwrap();
        assert!(found.angle_between(truth) < 1e-3, "{found} is not {truth}");
    }
}
