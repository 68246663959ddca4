//! Examination of a stretch of samples: the mounting and its problems.
//!
//! Legs are mirror images of each other: the measurements of a sensor on the left foot are, mirrored, those of a sensor on the right foot. If the model explains the
//! mirrored samples better than the samples, the sensor is on the other side.
//!
//! Logarithms of the ratio, by the shipped model of the right foot, on the first six seconds of walking of 36 recordings of real feet (the limit was chosen on them):
//!
//! | feet | recordings | least | most |
//! | --- | --- | --- | --- |
//! | right: ipol but subject 4, gaitmap, x-io | 17 | -87 | 2.6 |
//! | left: ipol but subject 4, gaitmap | 15 | 11 | 100 |
//! | ipol's subject 4, "right" | 2 | 88 | 93 |
//! | ipol's subject 4, "left" | 2 | -119 | -107 |
//!
//! Subject 4's sensors seem to have been swapped in both recordings.

use crate::mounting::{Finder, Found, Mounting, MountingError, moving_frames};
use crate::prepared::Prepared;
use crate::problem::SensorProblem;
use crate::tracker::TrackerConfig;
use footfall_core::Site;
use footfall_imu::{FeatureFrame, ImuRecording};
use glam::Quat;
use std::sync::Arc;

/// Logarithm of the probability ratio above which mirrored samples indicate the other side, or swapped sensors.
const OTHER_SIDE: f64 = 6.0;

/// Angle up to which a mounting agrees with the assumed one, radians.
const SAME: f32 = 0.7;

/// Certainty below which a mounting contradicts none.
const CERTAIN: f32 = 0.9;

/// Result of an examination.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Examination {
    /// Mounting that explains the samples best.
    pub mounting: Mounting,
    /// Problem with the mounting.
    pub finding: Option<SensorProblem>,
}

/// Finds the mounting of the sensor at a site of the model, and its problems: on the other side, or turned from the `believed` mounting.
///
/// # Errors
/// [`MountingError::TooLittleMotion`] when the recording shows less than a second of motion.
pub fn examine(
    prepared: &Arc<Prepared>,
    sensor: usize,
    recording: &ImuRecording,
    believed: Option<Quat>,
    config: &TrackerConfig,
) -> Result<Examination, MountingError> {
    let frames = moving_frames(recording, prepared.model.frame_rate_hz)?;
    let mut finder = Finder::new(prepared, sensor, &frames, config);
    let found = finder.best();
    let turned = believed.and_then(|believed| turned(&found, believed));
    let finding = match prepared.model.sites.get(sensor) {
        Some(site) => other_side(prepared, sensor, *site, &frames, &found, config).or(turned),
        None => turned,
    };
    Ok(Examination {
        mounting: found.mounting,
        finding,
    })
}

/// Finds out whether the recordings of the two sensors of a model are exchanged: each explained better at the other's site.
///
/// # Errors
/// [`MountingError::TooLittleMotion`] when one of them shows less than a second of motion.
pub fn find_exchange(
    prepared: &Arc<Prepared>,
    recordings: [&ImuRecording; 2],
    config: &TrackerConfig,
) -> Result<Option<SensorProblem>, MountingError> {
    let &[first, second] = prepared.model.sites.as_slice() else {
        return Ok(None);
    };
    let rate = prepared.model.frame_rate_hz;
    let frames = [
        moving_frames(recordings[0], rate)?,
        moving_frames(recordings[1], rate)?,
    ];
    let explained = |sensor: usize, recording: usize| {
        let mut finder = Finder::new(prepared, sensor, &frames[recording], config);
        finder.best().log_likelihood
    };
    let gain = explained(0, 1) + explained(1, 0) - explained(0, 0) - explained(1, 1);
    Ok((gain > OTHER_SIDE).then_some(SensorProblem::Exchanged { first, second }))
}

fn turned(found: &Found, believed: Quat) -> Option<SensorProblem> {
    let Mounting {
        site_from_sensor,
        certainty,
    } = found.mounting;
    let angle = site_from_sensor.angle_between(believed);
    (angle > SAME && certainty > CERTAIN).then_some(SensorProblem::Turned {
        degrees: angle.to_degrees(),
    })
}

/// The finding that the sensor sits on the other side.
fn other_side(
    prepared: &Arc<Prepared>,
    sensor: usize,
    site: Site,
    frames: &[FeatureFrame],
    found: &Found,
    config: &TrackerConfig,
) -> Option<SensorProblem> {
    let worn = site.opposite()?;
    let mirrored: Vec<FeatureFrame> = frames.iter().map(mirrored).collect();
    let other = Finder::new(prepared, sensor, &mirrored, config).best();
    (other.log_likelihood - found.log_likelihood > OTHER_SIDE)
        .then_some(SensorProblem::OtherSide { site, worn })
}

/// Measurement of a sensor in a world that is mirrored in its plane of y and z: angular rate is an axial vector, force and up are polar ones.
fn mirrored(frame: &FeatureFrame) -> FeatureFrame {
    let mut frame = *frame;
    if let Some([_, gy, gz, ax, _, _, ux, _, _]) = &mut frame.values {
        for value in [gy, gz, ax, ux] {
            *value = -*value;
        }
    }
    frame
}
