//! Swing of the body's parts over a stride, from positions that are low-passed.

use super::bouts::Gait;
use crate::dataset::smooth_headings;
use footfall_core::rotation::{from_heading, log_map, shortest_arc};
use footfall_core::{Clip, Joint, ModelPose, Side, StepPosition, forward_kinematics};
use footfall_imu::filter::low_pass;
use footfall_motion::steps::Walk;
use glam::Vec3;

/// Frames a second of what is judged.
pub const RATE_HZ: f64 = 30.0;
/// Motion above this frequency is not judged: markers are noisier there than people are lively.
pub const CUT_OFF_HZ: f64 = 6.0;
/// Lower end of what counts as detail.
pub const DETAIL_FROM_HZ: f64 = 3.0;
/// Hips are judged up to this frequency.
const ROOT_CUT_OFF_HZ: f64 = 8.0;
/// Samples of a time-normalised stride.
pub const PHASES: usize = 40;

/// Number of parts that are judged.
pub const PART_COUNT: usize = 14;

/// Names of the parts.
pub const PARTS: [&str; PART_COUNT] = [
    "pelvis",
    "girdle",
    "trunk",
    "head",
    "left upper arm",
    "left forearm",
    "right upper arm",
    "right forearm",
    "left thigh",
    "left shank",
    "left foot",
    "right thigh",
    "right shank",
    "right foot",
];

/// Reference of a runner's feet, forwards and down. In a run's swing toes point backwards, nearly opposite to where they point in standing,
/// and the rotation from there has no definite axis.
const RUNNING_FOOT: Vec3 = Vec3::new(
    0.0,
    -core::f32::consts::FRAC_1_SQRT_2,
    core::f32::consts::FRAC_1_SQRT_2,
);

/// The line of each part, from one joint to another, and its direction on a standing body with hanging arms.
/// The head's line ends at its top.
const LINES: [(Joint, Option<Joint>, Vec3); PART_COUNT] = [
    (Joint::RightUpperLeg, Some(Joint::LeftUpperLeg), Vec3::X),
    (Joint::RightUpperArm, Some(Joint::LeftUpperArm), Vec3::X),
    (Joint::Hips, Some(Joint::Neck), Vec3::Y),
    (Joint::Head, None, Vec3::Y),
    (Joint::LeftUpperArm, Some(Joint::LeftLowerArm), Vec3::NEG_Y),
    (Joint::LeftLowerArm, Some(Joint::LeftHand), Vec3::NEG_Y),
    (
        Joint::RightUpperArm,
        Some(Joint::RightLowerArm),
        Vec3::NEG_Y,
    ),
    (Joint::RightLowerArm, Some(Joint::RightHand), Vec3::NEG_Y),
    (Joint::LeftUpperLeg, Some(Joint::LeftLowerLeg), Vec3::NEG_Y),
    (Joint::LeftLowerLeg, Some(Joint::LeftFoot), Vec3::NEG_Y),
    (Joint::LeftFoot, Some(Joint::LeftToes), Vec3::Z),
    (
        Joint::RightUpperLeg,
        Some(Joint::RightLowerLeg),
        Vec3::NEG_Y,
    ),
    (Joint::RightLowerLeg, Some(Joint::RightFoot), Vec3::NEG_Y),
    (Joint::RightFoot, Some(Joint::RightToes), Vec3::Z),
];

/// A stride as the comparison sees it.
#[derive(Clone, Debug)]
pub struct StrideSwings {
    /// The foot whose initial contacts begin and end it.
    pub side: Side,
    /// Its duration, seconds.
    pub secs: f64,
    /// Swing of each part at [`RATE_HZ`]: exponential map from the part's direction when standing, radians, heading removed. Of a runner's feet it is from
    /// forwards and down.
    pub angles: Vec<[Vec3; PART_COUNT]>,
    /// The same between [`DETAIL_FROM_HZ`] and [`CUT_OFF_HZ`] at [`PHASES`] equally spaced moments.
    pub detail: Vec<[Vec3; PART_COUNT]>,
    /// Velocity of the hips along the stride (x, m/s) and their height (y, m) at [`PHASES`] equally spaced moments.
    pub root: Vec<Vec3>,
    /// Flexion of the left and right knee, radians, at [`PHASES`] equally spaced moments.
    pub knees: Vec<[f32; 2]>,
    /// Pitch of the left and right sole, radians, positive with the toes down, at [`PHASES`] equally spaced moments.
    pub pitch: Vec<[f32; 2]>,
}

/// Strides of a clip's walks, without those out of and into standing.
pub fn stride_swings(clip: &Clip, walks: &[Walk], gait: Gait) -> Vec<StrideSwings> {
    if clip.poses.is_empty() {
        return Vec::new();
    }
    let motion = Motion::of(clip, gait);
    let pairs = walks.iter().flat_map(|walk| walk.steps.windows(2));
    pairs
        .filter(|pair| {
            pair.iter()
                .all(|step| !matches!(step.position, StepPosition::First | StepPosition::Last))
                && pair[1].end < clip.poses.len()
        })
        .map(|pair| motion.stride(pair[0].side, pair[0].first, pair[1].end))
        .collect()
}

/// A clip in the terms that strides are made of, at its own rate.
struct Motion {
    rate_hz: f64,
    angles: Vec<[Vec3; PART_COUNT]>,
    detail: Vec<[Vec3; PART_COUNT]>,
    /// Velocity of the hips over the ground and, as y, their height.
    hips: Vec<Vec3>,
    places: Vec<Vec3>,
    knees: Vec<[f32; 2]>,
    pitch: Vec<[f32; 2]>,
}

impl Motion {
    fn of(clip: &Clip, gait: Gait) -> Self {
        let rate = clip.frame_rate_hz;
        let headings = smooth_headings(clip);
        let frames: Vec<ModelPose> = clip
            .poses
            .iter()
            .map(|pose| {
                let mut model = ModelPose::default();
                forward_kinematics(&clip.skeleton, pose, &mut model);
                model
            })
            .collect();
        let mut angles = vec![[Vec3::ZERO; PART_COUNT]; frames.len()];
        let mut detail = angles.clone();
        for (part, (from, to, standing)) in LINES.into_iter().enumerate() {
            let reference = match (gait, from) {
                (Gait::Run, Joint::LeftFoot | Joint::RightFoot) => RUNNING_FOOT,
                _ => standing,
            };
            let line: Vec<Vec3> = frames
                .iter()
                .zip(&headings)
                .map(|(frame, heading)| {
                    let end = match to {
                        Some(joint) => frame.position(joint),
                        None => {
                            frame.position(from) + frame.rotation(from) * clip.skeleton.head_top
                        }
                    };
                    from_heading(-*heading as f32) * (end - frame.position(from))
                })
                .collect();
            let swing: Vec<Vec3> = low_pass(&line, rate, CUT_OFF_HZ)
                .into_iter()
                .map(|direction| log_map(shortest_arc(reference, direction)))
                .collect();
            let slow = low_pass(&swing, rate, DETAIL_FROM_HZ);
            for (frame, (swing, slow)) in swing.iter().zip(&slow).enumerate() {
                angles[frame][part] = *swing;
                detail[frame][part] = *swing - *slow;
            }
        }
        let places: Vec<Vec3> = frames
            .iter()
            .map(|frame| frame.position(Joint::Hips))
            .collect();
        let velocities: Vec<Vec3> = (0..places.len())
            .map(|frame| {
                let (before, after) = (frame.saturating_sub(1), (frame + 1).min(places.len() - 1));
                let secs = (after - before).max(1) as f64 / rate;
                let velocity = (places[after] - places[before]) / secs as f32;
                velocity.with_y(places[frame].y)
            })
            .collect();
        let legs = |frame: &ModelPose| {
            Side::BOTH.map(|side| {
                let hip = frame.position(side.upper_leg());
                let knee = frame.position(side.lower_leg());
                (knee - hip).angle_between(frame.position(side.foot()) - knee)
            })
        };
        let soles = |frame: &ModelPose| {
            Side::BOTH.map(|side| {
                -(frame.rotation(side.foot()) * Vec3::Z)
                    .y
                    .clamp(-1.0, 1.0)
                    .asin()
            })
        };
        Self {
            rate_hz: rate,
            angles,
            detail,
            hips: low_pass(&velocities, rate, ROOT_CUT_OFF_HZ),
            knees: frames.iter().map(legs).collect(),
            pitch: frames.iter().map(soles).collect(),
            places,
        }
    }

    fn stride(&self, side: Side, first: usize, end: usize) -> StrideSwings {
        let secs = (end - first) as f64 / self.rate_hz;
        let along = (self.places[end] - self.places[first])
            .with_y(0.0)
            .normalize_or(Vec3::Z);
        let count = (secs * RATE_HZ).floor() as usize + 1;
        let timed = (0..count).map(|n| first as f64 + n as f64 * self.rate_hz / RATE_HZ);
        let phased = || {
            let frames = (end - first) as f64;
            (0..PHASES).map(move |n| first as f64 + frames * n as f64 / PHASES as f64)
        };
        let pairs = |of: &[[f32; 2]]| {
            phased()
                .map(|at| {
                    let (frame, share) = (at.floor() as usize, at.fract() as f32);
                    let next = (frame + 1).min(of.len() - 1);
                    [0, 1].map(|leg| of[frame][leg] + share * (of[next][leg] - of[frame][leg]))
                })
                .collect()
        };
        StrideSwings {
            side,
            secs,
            angles: timed.map(|at| sample(&self.angles, at)).collect(),
            detail: phased().map(|at| sample(&self.detail, at)).collect(),
            root: phased()
                .map(|at| {
                    let frame = (at.round() as usize).min(self.hips.len() - 1);
                    let hips = self.hips[frame];
                    Vec3::new(hips.with_y(0.0).dot(along), hips.y, 0.0)
                })
                .collect(),
            knees: pairs(&self.knees),
            pitch: pairs(&self.pitch),
        }
    }
}

/// Values between two frames.
fn sample(frames: &[[Vec3; PART_COUNT]], at: f64) -> [Vec3; PART_COUNT] {
    let frame = (at.floor() as usize).min(frames.len() - 1);
    let next = (frame + 1).min(frames.len() - 1);
    let share = at.fract() as f32;
    core::array::from_fn(|part| frames[frame][part].lerp(frames[next][part], share))
}
