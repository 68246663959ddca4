//! Any captured body to the canonical body.
//!
//! Segment directions are what a retargeted clip keeps: trunk (hips to neck), arms, legs and feet point exactly where they
//! point in the source. Lengths are the canonical body's; travel and height are scaled by leg length over the source's leg
//! length, so the file's unit need not be known. The foot alone keeps the source's slope from ankle to ball (see
//! [`footfall_core::FootShape`]), so that a zero rotation is a flat sole and yet the foot points as in the source.

mod evidence;
mod feet;
mod floor;
mod joint_map;
mod legs;
mod report;
mod rest;
mod source;

pub use footfall_core::rig::{JointMap, Placement};
pub use joint_map::parse_joint_map;
pub use report::{RetargetError, RetargetReport};

use crate::bvh::BvhFile;
use crate::hip_centres::HipVerdict;
use crate::skeleton_fit::{FitFinding, find_fit};
use crate::walking_evidence::{Manner, Origin, WalkingEvidence};
use footfall_core::rotation::{from_heading, heading, shortest_arc};
use footfall_core::{Clip, JOINT_COUNT, Joint, Pose, Skeleton};
use glam::{Quat, Vec3};
use rest::{RestRotations, canonical_direction};
use source::{SourceFrame, SourceMotion};

/// Settings beyond the defaults.
#[derive(Clone, Debug, Default)]
pub struct RetargetOptions {
    /// Names of the joints; chosen among [`JointMap::known`] when absent.
    pub map: Option<JointMap>,
    /// Rate of the clip, frames per second; the file's own when absent.
    pub frame_rate_hz: Option<f64>,
    /// Treatment of a skeleton that fits the person badly.
    pub fit: SkeletonFit,
}

/// Source of the hip joints' places and of the head's carriage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SkeletonFit {
    /// The walking of the recording itself, where it shows that the file has them wrong; the file where it does not. See
    /// [`hip_centres`](crate::hip_centres) and [`head_carriage`](crate::head_carriage).
    #[default]
    FromRecording,
    /// The file.
    AsRecorded,
    /// A finding from several recordings of the person.
    Known(FitFinding),
}

/// A clip on the canonical body, and how it came about.
#[derive(Clone, Debug)]
pub struct Retargeted {
    /// The motion. Frame numbers are those of the file unless another rate was asked for.
    pub clip: Clip,
    /// Frames before this one are not part of the motion (a T-pose that an exporter put in front); leave them out of contacts
    /// and training.
    pub first_frame: usize,
    /// Findings on the way.
    pub report: RetargetReport,
    /// Rotations of neck and head before they were corrected, frame by frame; empty where they were not.
    pub recorded_heads: Vec<[Quat; 2]>,
}

impl Retargeted {
    /// A motion that is on the canonical body already, such as one that was generated.
    pub fn canonical(clip: Clip) -> Self {
        Self {
            clip,
            first_frame: 0,
            report: RetargetReport {
                map: "canonical".to_owned(),
                source_joints: Joint::ALL.map(|joint| Some(joint.name().to_owned())),
                scale: 1.0,
                flat_foot_frames: [0; 2],
                in_place: false,
                cycle_frames: None,
                repeats: 1,
                fit: FitFinding::without_evidence(HipVerdict::OwnBody),
            },
            recorded_heads: Vec::new(),
        }
    }

    /// Turns neck and head back to where the file has them, to the bit unless the clip was resampled or unrolled.
    pub(crate) fn leave_head(&mut self) {
        let Some(head) = self.report.fit.head.take() else {
            return;
        };
        if self.recorded_heads.len() != self.clip.poses.len() {
            turn_head(&mut self.clip, head.turns().map(Quat::inverse));
            return;
        }
        for (pose, [neck, head]) in self.clip.poses.iter_mut().zip(&self.recorded_heads) {
            pose.rotations[Joint::Neck.index()] = *neck;
            pose.rotations[Joint::Head.index()] = *head;
        }
    }
}

/// Turns a file into a clip on the canonical body.
///
/// # Errors
/// [`RetargetError`] for a skeleton whose joints cannot be placed, legs without length, numbers beyond all measure,
/// and a rate that is not above zero.
pub fn retarget(file: &BvhFile, options: &RetargetOptions) -> Result<Retargeted, RetargetError> {
    retarget_with_way(file, options, |_, _| None)
}

/// As [`retarget`], for a body that may walk in place: `way` returns, from the clip and its first frame, the place of the root in every
/// frame from there on.
///
/// Ground and feet are found from feet that stand, which those of a body in place do not; so it is put on the canonical body again with its way.
pub(crate) fn retarget_with_way(
    file: &BvhFile,
    options: &RetargetOptions,
    way: impl Fn(&Clip, usize) -> Option<Vec<Vec3>>,
) -> Result<Retargeted, RetargetError> {
    check_rate(options)?;
    let placed = Placed::new(file, options.map.as_ref(), way)?;
    let fit = match options.fit {
        SkeletonFit::FromRecording => find_fit(&[&placed.evidence()], Manner::Unlabelled),
        SkeletonFit::AsRecorded => FitFinding::without_evidence(HipVerdict::AsRecorded),
        SkeletonFit::Known(finding) => finding,
    };
    placed.corrected(fit, options.frame_rate_hz)
}

/// As [`retarget_with_way`], with the joints as the file has them, and the file's evidence about its skeleton: of all files of a
/// person, [`find_fit`] decides whether the joints are corrected.
pub(crate) fn retarget_as_recorded(
    file: &BvhFile,
    options: &RetargetOptions,
    way: impl Fn(&Clip, usize) -> Option<Vec<Vec3>>,
) -> Result<(Retargeted, WalkingEvidence), RetargetError> {
    check_rate(options)?;
    let placed = Placed::new(file, options.map.as_ref(), way)?;
    let evidence = placed.evidence();
    let finding = FitFinding::without_evidence(HipVerdict::AsRecorded);
    let retargeted = placed.corrected(finding, options.frame_rate_hz)?;
    Ok((retargeted, evidence))
}

fn check_rate(options: &RetargetOptions) -> Result<(), RetargetError> {
    match options.frame_rate_hz {
        Some(rate) if !(rate.is_finite() && rate > 0.0) => Err(RetargetError::FrameRate(rate)),
        _ => Ok(()),
    }
}

/// A motion with its joints as the file has them, as they are there and on the canonical body.
struct Placed {
    map: String,
    source_joints: [Option<String>; JOINT_COUNT],
    origin: Origin,
    source: SourceMotion,
    body: Embodied,
    in_place: bool,
}

impl Placed {
    fn new(
        file: &BvhFile,
        map: Option<&JointMap>,
        way: impl Fn(&Clip, usize) -> Option<Vec<Vec3>>,
    ) -> Result<Self, RetargetError> {
        let (map, placement) = joint_map::place(file, map)?;
        let name_of = |joint: Joint| placement.joint(joint).map(|n| file.joints[n].name.clone());
        let mut source = SourceMotion::new(file, &placement);
        if !(source.leg_length.is_finite() && source.leg_length > 1e-6) {
            return Err(RetargetError::NoLegs {
                length: source.leg_length,
                knee: name_of(Joint::LeftLowerLeg).unwrap_or_default(),
                ankle: name_of(Joint::LeftFoot).unwrap_or_default(),
            });
        }
        let mut body = embody(&source)?;
        let way = way(&body.clip, source.first_motion_frame);
        if let Some(way) = &way {
            source.travel(way, body.scale);
            body = embody(&source)?;
        }
        Ok(Self {
            map,
            source_joints: Joint::ALL.map(name_of),
            origin: Origin::of(&file.joints.iter().map(|joint| joint.name.as_str())),
            source,
            body,
            in_place: way.is_some(),
        })
    }

    fn evidence(&self) -> WalkingEvidence {
        evidence::walking_evidence(&self.source, &self.body.clip, self.origin)
    }

    /// The motion with its legs and its head corrected as found, at the file's rate or another.
    fn corrected(
        mut self,
        fit: FitFinding,
        frame_rate_hz: Option<f64>,
    ) -> Result<Retargeted, RetargetError> {
        if let Some(correction) = fit.hip_centres.verdict.correction() {
            legs::correct_legs(&mut self.source, correction);
            self.body = embody(&self.source)?;
        }
        let mut recorded_heads = Vec::new();
        if let Some(head) = &fit.head {
            let poses = self.body.clip.poses.iter();
            let heads =
                poses.map(|pose| [Joint::Neck, Joint::Head].map(|joint| pose.rotation(joint)));
            recorded_heads = heads.collect();
            turn_head(&mut self.body.clip, head.turns());
        }
        let Embodied {
            mut clip,
            scale,
            flat_foot_frames,
        } = self.body;
        let mut first_frame = self.source.first_motion_frame;
        if let Some(rate) = frame_rate_hz {
            first_frame = (first_frame as f64 / clip.frame_rate_hz * rate).ceil() as usize;
            clip = clip.resampled(rate);
            first_frame = first_frame.min(clip.poses.len().saturating_sub(1));
        }
        Ok(Retargeted {
            clip,
            first_frame,
            report: RetargetReport {
                map: self.map,
                source_joints: self.source_joints,
                scale,
                flat_foot_frames,
                in_place: self.in_place,
                cycle_frames: None,
                repeats: 1,
                fit,
            },
            recorded_heads,
        })
    }
}

/// Turns neck and head in every frame; what is above the neck keeps its own turn.
fn turn_head(clip: &mut Clip, [neck, head]: [Quat; 2]) {
    for pose in &mut clip.poses {
        let [on_trunk, on_neck] =
            [Joint::Neck, Joint::Head].map(|joint| pose.rotations[joint.index()]);
        pose.rotations[Joint::Neck.index()] = (on_trunk * neck).normalize();
        pose.rotations[Joint::Head.index()] = (neck.inverse() * on_neck * head).normalize();
    }
}

/// A motion on the canonical body, on its ground, at the file's rate.
struct Embodied {
    clip: Clip,
    scale: f32,
    flat_foot_frames: [usize; 2],
}

fn embody(source: &SourceMotion) -> Result<Embodied, RetargetError> {
    let mut rest = rest::rest_rotations(source);
    let flat = feet::flat_feet(source, &mut rest);
    let skeleton = Skeleton::with_feet([flat[0].direction, flat[1].direction]);
    let scale = skeleton.mean_leg_length() / (source.leg_length * source.leg_factor);
    let poses: Vec<Pose> = source
        .frames
        .iter()
        .map(|frame| pose_of(frame, &rest, &skeleton, scale, &source.has))
        .collect();
    let mut clip = Clip {
        skeleton,
        frame_rate_hz: source.frame_rate_hz,
        poses,
    };
    floor::put_on_floor(&mut clip, source.first_motion_frame);
    floor::lift_toes(&mut clip);
    match clip.poses.iter().position(|pose| !pose.is_finite()) {
        Some(frame) => Err(RetargetError::NotFinite { frame }),
        None => Ok(Embodied {
            clip,
            scale,
            flat_foot_frames: flat.map(|foot| foot.frames),
        }),
    }
}

/// One frame on the canonical body.
fn pose_of(
    frame: &SourceFrame,
    rest: &RestRotations,
    skeleton: &Skeleton,
    scale: f32,
    has: &[bool; JOINT_COUNT],
) -> Pose {
    let mut world: [Quat; JOINT_COUNT] =
        core::array::from_fn(|n| (frame.rotations[n] * rest[n].inverse()).normalize());
    for joint in Joint::ALL {
        let index = joint.index();
        let is_trunk = joint < Joint::LeftShoulder;
        let is_end = matches!(
            joint,
            Joint::LeftShoulder
                | Joint::RightShoulder
                | Joint::LeftHand
                | Joint::RightHand
                | Joint::LeftToes
                | Joint::RightToes
        );
        if is_end && !has[index] {
            // The file does not know: no turn against the parent.
            world[index] = joint
                .parent()
                .map_or(world[index], |parent| world[parent.index()]);
        } else if !is_trunk && !is_end {
            let axis = match joint {
                Joint::LeftFoot => skeleton.offset(Joint::LeftToes),
                Joint::RightFoot => skeleton.offset(Joint::RightToes),
                _ => canonical_direction(joint),
            };
            // Exact even where position channels move the joints of the source.
            world[index] = shortest_arc(world[index] * axis, frame.direction(joint)) * world[index];
        }
    }
    straighten_trunk(frame, skeleton, &mut world);
    let mut pose = Pose::default();
    for joint in Joint::ALL {
        let index = joint.index();
        pose.rotations[index] = match joint.parent() {
            None => world[index],
            Some(parent) => (world[parent.index()].inverse() * world[index]).normalize(),
        };
    }
    // The point between the hip joints is what carries the legs; the pelvis joint sits elsewhere in every skeleton.
    let source_centre =
        0.5 * (frame.position(Joint::LeftUpperLeg) + frame.position(Joint::RightUpperLeg));
    let centre =
        0.5 * (skeleton.offset(Joint::LeftUpperLeg) + skeleton.offset(Joint::RightUpperLeg));
    pose.root_position = source_centre * scale - world[Joint::Hips.index()] * centre;
    pose
}

/// Turns spine and chest together until the line from hips to neck points as in the source.
fn straighten_trunk(frame: &SourceFrame, skeleton: &Skeleton, world: &mut [Quat; JOINT_COUNT]) {
    let target = (frame.position(Joint::Neck) - frame.position(Joint::Hips)).normalize_or_zero();
    if target == Vec3::ZERO {
        return;
    }
    let chain = [Joint::Hips, Joint::Spine, Joint::Chest, Joint::UpperChest];
    let above = [Joint::Spine, Joint::Chest, Joint::UpperChest, Joint::Neck];
    for _ in 0..6 {
        let line: Vec3 = chain
            .into_iter()
            .zip(above)
            .map(|(joint, next)| world[joint.index()] * skeleton.offset(next))
            .sum();
        let turn = shortest_arc(line, target);
        for joint in &chain[1..] {
            world[joint.index()] = (turn * world[joint.index()]).normalize();
        }
    }
}

/// The same motion with its start at the origin, facing +Z. Frames before `first_frame` (no part of the motion) are
/// placed there one by one.
///
/// "Facing" is the direction of the hips, seen from above.
#[must_use]
pub fn normalised_start(clip: &Clip, first_frame: usize) -> Clip {
    let mut normalised = clip.clone();
    let place = |pose: &mut Pose, start: &Pose| {
        let turn = from_heading(-heading(start.rotation(Joint::Hips)));
        let origin = start.root_position.with_y(0.0);
        pose.root_position = turn * (pose.root_position - origin);
        pose.rotations[0] = (turn * pose.rotations[0]).normalize();
    };
    let first_frame = first_frame.min(clip.poses.len().saturating_sub(1));
    for (n, pose) in normalised.poses.iter_mut().enumerate() {
        place(pose, &clip.poses[n.min(first_frame)]);
    }
    normalised
}
