//! Brings a real sensor's recording onto the time of a clip that was captured at the same time, and into the axes of its site.
//!
//! Two devices never start at the same time. The angular rate of the site shows when one began on the other's clock: its magnitude does not depend on how
//! the sensor is worn, and on a real foot a simulated one agrees with it to r = 0.996 (specific force to 0.53 to 0.73 only). Both clocks are taken to run
//! alike: over a minute, crystals part by some milliseconds.

use crate::error::TrainError;
use footfall_core::{Clip, Site};
use footfall_imu::{ImuRecording, ImuSample};
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use glam::{DMat3, DQuat, DVec3, Quat};
use nalgebra::Matrix3;
use std::ops::Range;

/// Samples a second at which both are compared.
const RATE_HZ: f64 = 120.0;

/// Number of samples over which the real sensor is smoothed: a clip contains nothing faster.
const SMOOTHED: usize = 5;

/// With less than this the recording is of something else, or of another site. Two people's walks at the same pace can come to 0.96, so this finds
/// no mistake between those.
const LEAST_CORRELATION: f64 = 0.95;

/// Greatest part of a clip that a recording may lack at its beginning or end, seconds.
const MARGIN_SECS: f64 = 0.1;

/// Least number of common samples for an estimate: a second.
const LEAST_SAMPLES: usize = 120;

/// A recording that goes with a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct Synchronised {
    /// On the clip's time and in the site's axes, from the clip's first frame of motion to its last.
    pub recording: ImuRecording,
    /// The clip's time is the sensor's less this, seconds.
    pub offset_secs: f64,
    /// Agreement of both angular rates, at most 1.
    pub correlation: f64,
    /// `site_from_sensor` rotation.
    pub mounting: Quat,
}

/// Finds the clip in a recording, which may begin long before it and end long after, and turns it into the site's axes.
///
/// # Errors
/// [`TrainError::Unsynchronised`] where no part of the recording agrees with the clip, or either is too short.
pub fn synchronise(
    clip: &Clip,
    first_frame: usize,
    site: Site,
    recording: &ImuRecording,
) -> Result<Synchronised, TrainError> {
    let fail = |correlation: f64| TrainError::Unsynchronised { site, correlation };
    let ideal = simulate(clip, first_frame, site, &VirtualImuConfig::ideal(RATE_HZ));
    let real = at_even_times(recording);
    if ideal.samples.len() < LEAST_SAMPLES || real.samples.len() < ideal.samples.len() {
        return Err(fail(0.0));
    }
    let speed = |recording: &ImuRecording| -> Vec<f64> {
        let samples = recording.samples.iter();
        samples
            .map(|sample| f64::from(sample.rate.length()))
            .collect()
    };
    let (place, correlation) = best_place(&speed(&ideal), &smoothed(&speed(&real)));
    if correlation < LEAST_CORRELATION {
        return Err(fail(correlation));
    }
    let offset_secs = real.start_secs() + place / RATE_HZ - ideal.start_secs();
    let cut: Vec<ImuSample> = ideal
        .samples
        .iter()
        .map(|sample| ImuSample {
            time_secs: sample.time_secs,
            ..recording.at(sample.time_secs + offset_secs)
        })
        .collect();
    let mounting = mounting(&ideal.samples, &cut);
    Ok(Synchronised {
        recording: ImuRecording { samples: cut }.turned(mounting),
        offset_secs,
        correlation,
        mounting,
    })
}

fn at_even_times(recording: &ImuRecording) -> ImuRecording {
    let start = recording.start_secs() - MARGIN_SECS;
    let count = ((recording.duration_secs() + 2.0 * MARGIN_SECS) * RATE_HZ) as usize;
    ImuRecording {
        samples: (0..count)
            .map(|n| recording.at(start + n as f64 / RATE_HZ))
            .collect(),
    }
}

fn smoothed(values: &[f64]) -> Vec<f64> {
    let around =
        |n: usize| n.saturating_sub(SMOOTHED / 2)..(n + SMOOTHED / 2 + 1).min(values.len());
    let mean = |range: Range<usize>| values[range.clone()].iter().sum::<f64>() / range.len() as f64;
    (0..values.len()).map(|n| mean(around(n))).collect()
}

/// Offset at which a short series correlates best with a long one, to a part of a sample, and that correlation.
fn best_place(short: &[f64], long: &[f64]) -> (f64, f64) {
    let count = short.len() as f64;
    let mean = short.iter().sum::<f64>() / count;
    let short: Vec<f64> = short.iter().map(|value| value - mean).collect();
    let power: f64 = short.iter().map(|value| value * value).sum();
    let correlations: Vec<f64> = long
        .windows(short.len())
        .map(|window| {
            let (mut sum, mut squares, mut product) = (0.0, 0.0, 0.0);
            for (a, b) in window.iter().zip(&short) {
                sum += a;
                squares += a * a;
                product += a * b;
            }
            let own = squares - sum * sum / count;
            product / (own * power).sqrt().max(f64::MIN_POSITIVE)
        })
        .collect();
    let best = (0..correlations.len()).max_by(|a, b| correlations[*a].total_cmp(&correlations[*b]));
    let Some(best) = best else { return (0.0, 0.0) };
    let at = |n: Option<usize>| n.and_then(|n| correlations.get(n)).copied();
    // The top of the parabola through the best and its neighbours.
    let part = match (at(best.checked_sub(1)), at(Some(best + 1))) {
        (Some(before), Some(after)) => {
            let bend = before - 2.0 * correlations[best] + after;
            if bend < 0.0 {
                0.5 * (before - after) / bend
            } else {
                0.0
            }
        }
        _ => 0.0,
    };
    (best as f64 + part, correlations[best])
}

/// The rotation that brings a sensor's angular rates closest to the site's (Kabsch 1976, doi:10.1107/S0567739476001873).
fn mounting(site: &[ImuSample], sensor: &[ImuSample]) -> Quat {
    let mut across = Matrix3::zeros();
    for (site, sensor) in site.iter().zip(sensor) {
        let [a, b] = [site, sensor].map(|sample| {
            let rate = sample.rate.as_dvec3();
            nalgebra::Vector3::new(rate.x, rate.y, rate.z)
        });
        across += a * b.transpose();
    }
    let svd = across.svd(true, true);
    let (Some(left), Some(right)) = (svd.u, svd.v_t) else {
        return Quat::IDENTITY;
    };
    // A rotation, not a mirror image.
    let sign = (left.determinant() * right.determinant()).signum();
    let turn = left * Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 1.0, sign)) * right;
    let column = |n: usize| DVec3::new(turn[(0, n)], turn[(1, n)], turn[(2, n)]);
    let turn = DMat3::from_cols(column(0), column(1), column(2));
    DQuat::from_mat3(&turn).as_quat().normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{Joint, Pose, Skeleton};
    use footfall_motion::virtual_imu::SensorNoise;
    use glam::Vec3;

    /// A leg that swings ever faster, twelve seconds at 60 frames a second, from a frame on.
    fn clip(from: usize, frames: usize) -> Clip {
        let skeleton = Skeleton::standard();
        let pose = |frame: usize| {
            let secs = frame as f32 / 60.0;
            let mut pose = Pose::rest(&skeleton);
            let swing = 0.6 * (3.0 * secs + 0.2 * secs * secs).sin();
            let turns = [
                (Joint::Hips, Vec3::Y * (0.4 * (0.9 * secs).sin())),
                (
                    Joint::RightUpperLeg,
                    Vec3::new(swing, 0.0, 0.2 * (2.3 * secs).cos()),
                ),
                (
                    Joint::RightLowerLeg,
                    Vec3::X * (0.5 - 0.5 * (3.1 * secs).cos()),
                ),
            ];
            for (joint, turn) in turns {
                pose.rotations[joint.index()] = exp_map(turn);
            }
            pose
        };
        Clip {
            poses: (from..from + frames).map(pose).collect(),
            skeleton: skeleton.clone(),
            frame_rate_hz: 60.0,
        }
    }

    #[test]
    fn a_recording_is_found_and_turned() {
        let worn = exp_map(Vec3::new(0.7, -1.1, 0.4));
        let config = VirtualImuConfig {
            mounting: worn,
            noise: Some(SensorNoise::consumer(1.0)),
            seed: 4,
            ..VirtualImuConfig::ideal(97.0)
        };
        let mut recording = simulate(&clip(0, 720), 0, Site::RightFoot, &config);
        for sample in &mut recording.samples {
            sample.time_secs += 1000.0;
        }
        // The clip begins two seconds after the sensor, and its motion six frames later.
        let captured = clip(120, 480);
        let found = synchronise(&captured, 6, Site::RightFoot, &recording).unwrap();
        assert!(
            (found.offset_secs - 1002.0).abs() < 4e-3,
            "{}",
            found.offset_secs
        );
        assert!(found.correlation > 0.98, "{}", found.correlation);
        assert!(
            found.mounting.angle_between(worn) < 0.03,
            "{}",
            found.mounting
        );
        let samples = &found.recording.samples;
        assert!((samples[0].time_secs - 0.1).abs() < 1e-9);
        let ideal = simulate(
            &captured,
            6,
            Site::RightFoot,
            &VirtualImuConfig::ideal(RATE_HZ),
        );
        assert_eq!(samples.len(), ideal.samples.len());
        let apart = samples.iter().zip(&ideal.samples);
        let apart: f32 = apart.map(|(a, b)| a.rate.distance(b.rate)).sum();
        assert!(apart / (samples.len() as f32) < 0.15, "{apart}");
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let ideal = VirtualImuConfig::ideal(100.0);
        let captured = clip(120, 480);
        let refused = |recording: &ImuRecording| {
            matches!(
                synchronise(&captured, 0, Site::RightFoot, recording),
                Err(TrainError::Unsynchronised { .. })
            )
        };
        let hips = simulate(&clip(0, 720), 0, Site::Root, &ideal);
        assert!(refused(&hips));
        let foot = simulate(&clip(0, 720), 0, Site::RightFoot, &ideal);
        let part = ImuRecording {
            samples: foot.samples[..300].to_vec(),
        };
        assert!(refused(&part));
        assert!(refused(&ImuRecording {
            samples: Vec::new()
        }));
        let short = clip(0, 30);
        assert!(synchronise(&short, 0, Site::RightFoot, &foot).is_err());
    }
}
