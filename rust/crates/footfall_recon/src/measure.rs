//! Frames of the sensors as the tracker takes them.

use crate::body::BodyFrame;
use crate::stride_phase::StridePhase;
use crate::tracker::Measurement;
use footfall_core::rotation::heading;
use footfall_imu::{FeatureFrame, SENSOR_FEATURES, SensorContact};
use footfall_model::ImuModel;
use footfall_model::imu_model::{MAX_SENSORS, MAX_WIDTH, SENSOR_COUNT, SENSOR_HEADING};
use glam::Vec3;

const _: () = assert!(SENSOR_FEATURES == SENSOR_COUNT, "one layout of features");

/// A sensor that lies so flat has no heading: the least height of its up axis.
const LEAST_UPRIGHT: f32 = 0.6;

/// Largest uncertainty of the vertical for a heading, radians.
const TILT_KNOWN: f32 = 0.12;

/// A sensor's frame, and the contact of the foot that wears it when the frame ends; `None` while unknown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SensorFrame {
    pub(crate) frame: FeatureFrame,
    pub(crate) contact: Option<SensorContact>,
}

/// Frames of all sensors.
pub(crate) type SensorFrames = [Option<SensorFrame>; MAX_SENSORS];

/// Joins what all sensors measured; `None` when none did. What is uncertain or missing counts less or nothing.
pub(crate) fn measure(model: &ImuModel, frames: &SensorFrames) -> Option<Measurement> {
    let mut measurement = Measurement {
        values: [0.0; MAX_WIDTH],
        weights: [0.0; MAX_WIDTH],
        stride: StridePhase::default(),
    };
    let mut any = false;
    for (n, frame) in frames.iter().enumerate().take(model.sites.len()) {
        let frame = frame.map(|heard| heard.frame);
        let Some((frame, values)) = frame.and_then(|frame| Some((frame, frame.values?))) else {
            continue;
        };
        any = true;
        let at = n * SENSOR_COUNT;
        measurement.values[at..at + SENSOR_COUNT].copy_from_slice(&values);
        for number in 0..SENSOR_COUNT {
            let deviation = model.deviations[at + number];
            // The last three numbers are the vertical, which may not be known yet.
            let doubt = if number < 6 {
                0.0
            } else {
                frame.tilt_deviation
            };
            let variance = deviation * deviation;
            measurement.weights[at + number] = variance / (variance + doubt * doubt);
        }
    }
    any.then_some(measurement)
}

/// The heading of the body that the first upright sensor gives, from an unknown direction on.
pub(crate) fn sensor_heading(frames: &SensorFrames, body: &BodyFrame) -> Option<f32> {
    frames.iter().enumerate().find_map(|(n, frame)| {
        let known = |frame: &FeatureFrame| frame.tilt_deviation < TILT_KNOWN;
        let frame = frame.map(|heard| heard.frame);
        let frame = frame.filter(|frame| frame.values.is_some() && known(frame))?;
        let turn = frame.world_from_sensor;
        let upright = (turn * Vec3::Y).y > LEAST_UPRIGHT;
        upright.then(|| heading(turn) - body[SENSOR_HEADING + n])
    })
}
