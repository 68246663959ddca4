//! Stretches of standing in a recording: upright, on planted feet, with hanging arms.

use super::RATE_HZ;
use footfall_core::rotation::heading;
use footfall_core::{Clip, Joint, ModelPose, Pose, Side};
use footfall_imu::filter::low_pass;
use footfall_model::{FEATURE_COUNT, layout};
use glam::{Vec2, Vec3};

/// A foot that moves faster over the ground is not planted, m/s; motion faster than this is noise, hertz.
const MOST_FOOT_SPEED_MPS: f32 = 0.05;
const FOOT_CUT_OFF_HZ: f64 = 2.0;

/// Knees and elbows of a person who stands at ease bend no more, radians.
const MOST_KNEE: f32 = 0.35;
const MOST_ELBOW: f32 = 1.05;

/// Ankles of a standing person are no farther apart over the ground, leg lengths.
const MOST_STRIDE: f32 = 0.42;

/// Coming to a stand and leaving it are no part of standing, seconds at either end; what is left must last.
const MARGIN_SECS: f64 = 0.4;
const LEAST_SECS: f64 = 2.5;

/// A stretch of standing at [`RATE_HZ`], seen from where the feet point.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// When it begins in its recording, seconds.
    pub begin_secs: f64,
    /// [`FEATURE_COUNT`] features a frame.
    pub features: Vec<Vec<f64>>,
    /// The hips from the middle of the ankles, to the left and forwards, leg lengths.
    pub hips: Vec<[f64; 2]>,
    /// The head's joint from there, likewise.
    pub head: Vec<[f64; 2]>,
    /// Direction of the face: to the left and down, radians.
    pub gaze: Vec<[f64; 2]>,
    /// By how much the feet point outwards, radians.
    pub turned_out: f64,
}

impl Stretch {
    /// Number of its frames.
    pub fn frames(&self) -> usize {
        self.features.len()
    }
}

/// The stretches of standing in a clip, without its first frames.
pub fn stretches(clip: &Clip, skip_frames: usize) -> Vec<Stretch> {
    let skip = (skip_frames as f64 * RATE_HZ / clip.frame_rate_hz).ceil() as usize;
    let clip = clip.resampled(RATE_HZ);
    let bodies: Vec<ModelPose> = clip.model_poses().collect();
    let mut stands = standing_frames(&clip, &bodies);
    let skipped = skip.min(stands.len());
    stands[..skipped].fill(false);
    let margin = (MARGIN_SECS * RATE_HZ) as usize;
    let least = (LEAST_SECS * RATE_HZ) as usize + 2 * margin;
    footfall_core::FrameSpan::runs(&stands)
        .into_iter()
        .filter(|run| run.last + 1 >= run.first + least)
        .map(|run| {
            let frames = run.first + margin..run.last + 1 - margin;
            let mut stretch = seen(&clip, &bodies[frames.clone()], &clip.poses[frames.clone()]);
            stretch.begin_secs = frames.start as f64 / RATE_HZ;
            stretch
        })
        .collect()
}

fn standing_frames(clip: &Clip, bodies: &[ModelPose]) -> Vec<bool> {
    let leg = clip.skeleton.mean_leg_length();
    let mut stands: Vec<bool> = clip
        .poses
        .iter()
        .zip(bodies)
        .map(|(pose, body)| {
            let bent = |joint: Joint| pose.rotation(joint).to_scaled_axis().length();
            let apart = body.position(Joint::LeftFoot) - body.position(Joint::RightFoot);
            let chest = body.position(Joint::Chest).y;
            let arms = [Joint::LeftLowerArm, Joint::RightLowerArm];
            let hands = [Joint::LeftHand, Joint::RightHand];
            Side::BOTH
                .iter()
                .all(|side| bent(side.lower_leg()) < MOST_KNEE)
                && arms.into_iter().all(|arm| bent(arm) < MOST_ELBOW)
                && hands.into_iter().all(|hand| body.position(hand).y < chest)
                && apart.with_y(0.0).length() < MOST_STRIDE * leg
        })
        .collect();
    for joint in Side::BOTH
        .into_iter()
        .flat_map(|side| [side.foot(), side.toes()])
    {
        let places: Vec<Vec3> = bodies.iter().map(|body| body.position(joint)).collect();
        let places = low_pass(&places, RATE_HZ, FOOT_CUT_OFF_HZ);
        for frame in 0..stands.len() {
            let [before, after] = [frame.saturating_sub(1), (frame + 1).min(stands.len() - 1)];
            let secs = (after - before).max(1) as f32 / RATE_HZ as f32;
            let way = (places[after] - places[before]).with_y(0.0).length();
            stands[frame] &= way < MOST_FOOT_SPEED_MPS * secs;
        }
    }
    stands
}

fn seen(clip: &Clip, bodies: &[ModelPose], poses: &[Pose]) -> Stretch {
    let mean_heading = |side: Side| {
        let directions = bodies.iter().map(|body| {
            let forward = body.rotation(side.foot()) * Vec3::Z;
            Vec2::new(forward.x, forward.z).normalize_or_zero()
        });
        let mean: Vec2 = directions.sum();
        mean.x.atan2(mean.y)
    };
    let [left, right] = Side::BOTH.map(mean_heading);
    let apart = footfall_core::rotation::wrap_angle(left - right);
    let faced = right + 0.5 * apart;
    let level = footfall_core::rotation::from_heading(-faced);
    let leg = clip.skeleton.mean_leg_length();
    let mut stretch = Stretch {
        begin_secs: 0.0,
        features: Vec::with_capacity(poses.len()),
        hips: Vec::with_capacity(poses.len()),
        head: Vec::with_capacity(poses.len()),
        gaze: Vec::with_capacity(poses.len()),
        turned_out: f64::from(0.5 * apart),
    };
    for (pose, body) in poses.iter().zip(bodies) {
        let mut row = vec![0.0; FEATURE_COUNT];
        let before = stretch.features.last().map(Vec::as_slice);
        layout::encode(pose, faced, before, &mut row);
        stretch.features.push(row);
        let ankles = Side::BOTH.map(|side| body.position(side.foot()));
        let middle = 0.5 * (ankles[0] + ankles[1]);
        let hips = level * (body.position(Joint::Hips) - middle) / leg;
        stretch.hips.push([f64::from(hips.x), f64::from(hips.z)]);
        let place = level * (body.position(Joint::Head) - middle) / leg;
        stretch.head.push([f64::from(place.x), f64::from(place.z)]);
        let head = level * body.rotation(Joint::Head);
        let down = -(head * Vec3::Z).y.clamp(-1.0, 1.0).asin();
        stretch
            .gaze
            .push([f64::from(heading(head)), f64::from(down)]);
    }
    stretch
}
