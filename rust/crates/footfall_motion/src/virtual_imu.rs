//! Measurements of an inertial sensor that the body might have worn.
//!
//! Position and orientation of the site are differentiated over windows of equal length in seconds, so that clips of all rates are
//! band-limited alike (near 10 Hz). Impacts, soft tissue and what a capture smooths away are not in a pose: on a real recording the magnitude of
//! the angular rate of a foot agrees with the simulated one (r = 0.996), that of specific force only at 0.53 to 0.73.

mod errors;
mod wear;

pub use errors::SensorNoise;
pub use wear::Wear;

use errors::Errors;
use footfall_core::rotation::log_map;
use footfall_core::{Clip, ModelPose, Site, forward_kinematics};
use footfall_imu::{GRAVITY_MPS2, ImuRecording, ImuSample};
use glam::{Quat, Vec3};

/// Half of the window over which a position is differentiated twice, seconds.
const FORCE_WINDOW_SECS: f64 = 0.034;

/// Half of the window over which an orientation is differentiated, seconds.
const RATE_WINDOW_SECS: f64 = 0.017;

/// Mounting, errors and wear of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualImuConfig {
    /// Samples per second.
    pub rate_hz: f64,
    /// `site_from_sensor` rotation; the identity for `aligned` mounting.
    pub mounting: Quat,
    /// Errors; none for an ideal sensor.
    pub noise: Option<SensorNoise>,
    /// Strap that holds it; none for a sensor that is one with the body, exactly at the site.
    pub wear: Option<Wear>,
    /// Seed of the errors and of the place on the strap.
    pub seed: u64,
}

impl VirtualImuConfig {
    /// An ideal sensor, mounted `aligned`.
    pub const fn ideal(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            mounting: Quat::IDENTITY,
            noise: None,
            wear: None,
            seed: 0,
        }
    }

    /// Uncalibrated board, on a loose strap, `aligned` but for that. Its clock is true, so that its times are the clip's.
    pub fn strapped(rate_hz: f64, seed: u64) -> Self {
        Self {
            noise: Some(SensorNoise {
                clock: 0.0,
                ..SensorNoise::uncalibrated(1.0)
            }),
            wear: Some(Wear::strapped(1.0)),
            seed,
            ..Self::ideal(rate_hz)
        }
    }
}

/// Measurements of a sensor at a site of a moving body from `first_frame` to the end; times are the clip's. Fewer than two frames give
/// nothing.
pub fn simulate(
    clip: &Clip,
    first_frame: usize,
    site: Site,
    config: &VirtualImuConfig,
) -> ImuRecording {
    let fps = clip.frame_rate_hz;
    let mut errors = Errors::new(config);
    let off = config
        .wear
        .map_or(Vec3::ZERO, |wear| errors.place(wear.off_m));
    let mut track = Track::of(clip, first_frame, site, off);
    if let Some(wear) = config.wear {
        wear.swing(&mut track, fps);
    }
    let start_secs = first_frame as f64 / fps;
    let last = track.turns.len().saturating_sub(1) as f64;
    let count = (last / fps * config.rate_hz * (1.0 + 1e-9)).floor() as usize;
    let samples = (0..=count).filter(|_| last > 0.0).filter_map(|n| {
        let frame = (n as f64 / config.rate_hz * fps).min(last);
        let (turn, acceleration, rate) = track.at(frame);
        let force = turn.inverse() * (acceleration + Vec3::Y * GRAVITY_MPS2);
        let sample = ImuSample {
            time_secs: start_secs + n as f64 / config.rate_hz,
            force,
            rate,
        };
        errors.add(sample.turned(config.mounting.inverse()))
    });
    ImuRecording {
        samples: samples.collect(),
    }
}

/// The site over time, frame by frame.
struct Track {
    /// `world_from_site` rotations.
    turns: Vec<Quat>,
    /// In the world, m/s².
    accelerations: Vec<Vec3>,
    /// In the site's axes, rad/s.
    rates: Vec<Vec3>,
}

impl Track {
    /// The site, or a place this far from it, over the frames of a clip.
    fn of(clip: &Clip, first_frame: usize, site: Site, off: Vec3) -> Self {
        let fps = clip.frame_rate_hz;
        let mut model = ModelPose::default();
        let (mut places, mut turns): (Vec<Vec3>, Vec<Quat>) = (Vec::new(), Vec::new());
        for pose in clip.poses.iter().skip(first_frame) {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            places.push(model.point(site.joint(), site.position() + off));
            turns.push(model.rotation(site.joint()));
        }
        let window = |secs: f64| {
            let frames = (secs * fps).round().max(1.0) as usize;
            frames.min(turns.len().saturating_sub(1) / 2)
        };
        Self {
            accelerations: accelerations(&places, window(FORCE_WINDOW_SECS), fps as f32),
            rates: rates(&turns, window(RATE_WINDOW_SECS), fps as f32),
            turns,
        }
    }

    /// Orientation, acceleration and angular rate at a frame, or between two.
    fn at(&self, frame: f64) -> (Quat, Vec3, Vec3) {
        let first = frame.floor() as usize;
        let next = (first + 1).min(self.turns.len() - 1);
        let share = (frame - first as f64) as f32;
        (
            self.turns[first].slerp(self.turns[next], share),
            self.accelerations[first].lerp(self.accelerations[next], share),
            self.rates[first].lerp(self.rates[next], share),
        )
    }
}

/// Second derivative of the parabola that fits a window best (Savitzky and Golay 1964); the ends take their neighbours'.
fn accelerations(places: &[Vec3], half: usize, fps: f32) -> Vec<Vec3> {
    if half == 0 {
        return vec![Vec3::ZERO; places.len()];
    }
    let h = half as f32;
    let norm = h * (h + 1.0) * (2.0 * h - 1.0) * (2.0 * h + 1.0) * (2.0 * h + 3.0) / 15.0;
    let centred = |frame: usize| {
        let centre = frame.clamp(half, places.len() - 1 - half);
        let window = &places[centre - half..=centre + half];
        let terms = window.iter().enumerate().map(|(n, place)| {
            let u = n as f32 - h;
            // Relative to the centre: positions are large, their differences small.
            (*place - places[centre]) * (3.0 * u * u - h * (h + 1.0))
        });
        terms.sum::<Vec3>() * (2.0 * fps * fps / norm)
    };
    (0..places.len()).map(centred).collect()
}

/// Angular rates in the site's own axes, over a window.
fn rates(turns: &[Quat], half: usize, fps: f32) -> Vec<Vec3> {
    if half == 0 {
        return vec![Vec3::ZERO; turns.len()];
    }
    let centred = |frame: usize| {
        let centre = frame.clamp(half, turns.len() - 1 - half);
        let (before, after) = (turns[centre - half], turns[centre + half]);
        // Half of the turn lies before the frame, whose axes are those of the result.
        log_map(before.inverse() * after) * (fps / (2 * half) as f32)
    };
    (0..turns.len()).map(centred).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;
    use footfall_core::{Joint, Pose, Skeleton};

    fn clip(frames: usize, fps: f64, pose_at: impl Fn(f32, &mut Pose)) -> Clip {
        let skeleton = Skeleton::standard();
        let poses = (0..frames)
            .map(|frame| {
                let mut pose = Pose::rest(&skeleton);
                pose_at(frame as f32 / fps as f32, &mut pose);
                pose
            })
            .collect();
        Clip {
            skeleton,
            frame_rate_hz: fps,
            poses,
        }
    }

    #[test]
    fn a_sensor_at_rest_reads_gravity_along_up() {
        let lying = clip(50, 30.0, |_, pose| {
            pose.rotations[0] = Quat::from_rotation_x(-FRAC_PI_2);
        });
        let recording = simulate(&lying, 0, Site::Root, &VirtualImuConfig::ideal(100.0));
        assert!((recording.rate_hz() - 100.0).abs() < 1e-6);
        for sample in &recording.samples {
            assert!(
                sample.force.distance(Vec3::Z * GRAVITY_MPS2) < 1e-3,
                "{}",
                sample.force
            );
            assert!(sample.rate.length() < 1e-4);
        }
    }

    #[test]
    fn a_pendulum_feels_its_own_motion() {
        for fps in [30.0, 120.0] {
            // The hips turn about x at 2 rad/s: the sensor on the lower back goes round a circle.
            let turning = clip(60, fps, |secs, pose| {
                pose.rotations[Joint::Hips.index()] = Quat::from_rotation_x(2.0 * secs);
            });
            let config = VirtualImuConfig::ideal(100.0);
            let recording = simulate(&turning, 0, Site::Root, &config);
            let arm = Site::Root.position();
            for sample in &recording.samples[5..recording.samples.len() - 10] {
                let up = Quat::from_rotation_x(-2.0 * sample.time_secs as f32) * Vec3::Y;
                let expected = up * GRAVITY_MPS2 - arm * 4.0;
                assert!(
                    sample.force.distance(expected) < 0.05,
                    "{} {expected}",
                    sample.force
                );
                assert!(sample.rate.distance(Vec3::X * 2.0) < 1e-3);
            }
        }
    }

    #[test]
    fn mounting_turns_the_axes_and_noise_repeats_with_its_seed() {
        let still = clip(200, 30.0, |_, _| {});
        let turned = VirtualImuConfig {
            mounting: Quat::from_rotation_z(FRAC_PI_2),
            ..VirtualImuConfig::ideal(100.0)
        };
        // Up of the body is the sensor's x axis.
        let sample = simulate(&still, 1, Site::RightFoot, &turned).samples[3];
        assert!(
            sample.force.distance(Vec3::X * GRAVITY_MPS2) < 1e-3,
            "{}",
            sample.force
        );
        let noisy = VirtualImuConfig {
            noise: Some(SensorNoise::consumer(1.0)),
            seed: 7,
            ..VirtualImuConfig::ideal(100.0)
        };
        let first = simulate(&still, 0, Site::RightFoot, &noisy);
        assert_eq!(first, simulate(&still, 0, Site::RightFoot, &noisy));
        let mean =
            first.samples.iter().map(|s| s.force.y).sum::<f32>() / first.samples.len() as f32;
        assert!((mean - GRAVITY_MPS2).abs() < 0.6 && first.samples[0] != first.samples[1]);
    }
}
