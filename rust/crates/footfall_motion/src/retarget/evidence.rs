//! Evidence of a file about its skeleton: the stances of its walking, seen from the pelvis, and the carriage of the head.

use super::rest::rest_rotations;
use super::source::{SourceFrame, SourceMotion};
use crate::contacts::{ContactConfig, detect_contacts};
use crate::steps::segment_walks;
use crate::walking_evidence::{
    FARTHEST, HeadCarriage, Origin, PHASES, STRIDE_SHARES, Stance, WalkingEvidence,
};
use footfall_core::rotation::{from_heading, heading, wrap_angle};
use footfall_core::{Clip, Joint, ModelPose, Pose, Side, Skeleton, StepPosition};
use glam::{Quat, Vec3, Vec4};

/// Plain walking: seconds a stride, metres a second of the canonical body; the most that the way may lead aside and the body
/// may turn within a stride, radians.
const STRIDE_SECS: core::ops::RangeInclusive<f64> = 0.75..=1.7;
const SPEED_MPS: core::ops::RangeInclusive<f32> = 0.5..=2.0;
const MOST_ASIDE: f32 = 0.5;
const MOST_TURNED: f32 = 0.5;
/// A walker's foot stands for more than half of a stride, a runner's for less.
const LEAST_STANCE: f64 = 0.54;
/// Shares of the stride before and after the landing in which the leg reaches farthest.
const BEFORE_LANDING: f32 = 0.12;
const AFTER_LANDING: f32 = 0.03;
/// Bones of the canonical body differ from its own files' by rounding alone.
const OWN_BONES: f32 = 2e-3;

/// Collects the evidence of a motion that is finite, and on the canonical body in `clip`.
pub(super) fn walking_evidence(
    source: &SourceMotion,
    clip: &Clip,
    origin: Origin,
) -> WalkingEvidence {
    let mut evidence = WalkingEvidence {
        segments: Side::BOTH.map(|side| {
            [side.upper_leg(), side.lower_leg()]
                .map(|joint| source.mean_length(joint) / source.leg_length)
        }),
        bones: bones(|joint| source.rest.position(joint), source.leg_length),
        is_own_body: is_canonical(source),
        origin,
        stances: Vec::new(),
        heads: Vec::new(),
    };
    if evidence.is_own_body {
        return evidence;
    }
    let pelvis = rest_rotations(source)[Joint::Hips.index()].inverse();
    for (side, first, end) in plain_strides(source, clip) {
        evidence.stances.push(Stance {
            side,
            hip_from_ankle: hips_over_stance(source, pelvis, side, first, end),
        });
        if origin == Origin::MarkerFit {
            evidence.heads.push(head_carriage(clip, first, end));
        }
    }
    evidence
}

/// Lengths of all bones below the hips joint in leg lengths.
fn bones(position: impl Fn(Joint) -> Vec3, leg_length: f32) -> Vec<f32> {
    let length = |joint: Joint| {
        let parent = joint.parent()?;
        Some(position(joint).distance(position(parent)) / leg_length)
    };
    Joint::ALL.into_iter().filter_map(length).collect()
}

pub(super) fn is_canonical(source: &SourceMotion) -> bool {
    let standard = Skeleton::standard();
    let own = Joint::ALL
        .into_iter()
        .filter(|joint| joint.parent().is_some())
        .map(|joint| standard.offset(joint).length() / standard.mean_leg_length());
    source.has.iter().all(|has| *has)
        && bones(|joint| source.rest.position(joint), source.leg_length)
            .iter()
            .zip(own)
            .all(|(bone, own)| (bone - own).abs() < OWN_BONES)
}

/// Strides of plain walking straight ahead: the foot that stands first, the frame of its landing and that of its next.
fn plain_strides(source: &SourceMotion, clip: &Clip) -> Vec<(Side, usize, usize)> {
    let contacts = detect_contacts(clip, &ContactConfig::from_frame(source.first_motion_frame));
    let mut strides = Vec::new();
    for walk in segment_walks(clip, &contacts) {
        for pair in walk.steps.windows(2) {
            let is_inside = pair
                .iter()
                .all(|step| step.position == StepPosition::Inside);
            let (side, first, end) = (pair[0].side, pair[0].first, pair[1].end);
            let stood = contacts
                .foot(side)
                .stances
                .iter()
                .find(|s| s.first == first);
            let stood = stood.map_or(0, |stance| stance.last + 1 - first);
            let is_walking = stood as f64 >= LEAST_STANCE * (end - first) as f64;
            if is_inside && is_walking && goes_ahead(clip, first, end) {
                strides.push((side, first, end));
            }
        }
    }
    strides
}

/// Mean attitude of neck and head over a stride, seen along its way.
fn head_carriage(clip: &Clip, first: usize, end: usize) -> HeadCarriage {
    let frames = &clip.poses[first..end.min(clip.poses.len())];
    let place = |pose: Option<&Pose>| pose.map_or(Vec3::ZERO, |pose| pose.root_position);
    let way = place(frames.last()) - place(frames.first());
    let along_way = from_heading(-way.x.atan2(way.z));
    let mut sums = [Vec4::ZERO; 2];
    for pose in frames {
        let body = ModelPose::of(&clip.skeleton, pose);
        for (sum, joint) in sums.iter_mut().zip([Joint::Neck, Joint::Head]) {
            let turned = along_way * body.rotation(joint);
            // Of the two quaternions of a rotation the one near no turn.
            *sum += Vec4::from(turned) * turned.w.signum();
        }
    }
    let [neck, head] = sums.map(|sum| Quat::from_vec4(sum.normalize_or(Vec4::W)));
    HeadCarriage::of_rotations(neck, head)
}

/// Returns true when a stride is plain walking straight ahead.
fn goes_ahead(clip: &Clip, first: usize, end: usize) -> bool {
    let secs = (end - first) as f64 / clip.frame_rate_hz;
    let [from, to] = [first, end].map(|frame| &clip.poses[frame.min(clip.poses.len() - 1)]);
    let way = (to.root_position - from.root_position).with_y(0.0);
    let [before, after] = [from, to].map(|pose| heading(pose.rotation(Joint::Hips)));
    let turned = wrap_angle(after - before);
    let aside = wrap_angle(way.x.atan2(way.z) - before - 0.5 * turned);
    STRIDE_SECS.contains(&secs)
        && SPEED_MPS.contains(&(way.length() / secs as f32))
        && turned.abs() < MOST_TURNED
        && aside.abs() < MOST_ASIDE
}

/// The hip joint over the ankle at the phases of a stance.
fn hips_over_stance(
    source: &SourceMotion,
    pelvis: Quat,
    side: Side,
    first: usize,
    end: usize,
) -> [Vec3; PHASES] {
    let frames = (end - first) as f32;
    let mut hips =
        STRIDE_SHARES.map(|share| hip_at(source, pelvis, side, first as f32 + share * frames));
    let before = (BEFORE_LANDING * frames) as usize;
    let after = (AFTER_LANDING * frames) as usize;
    for frame in first.saturating_sub(before)..=first + after {
        let hip = hip_at(source, pelvis, side, frame as f32);
        if hip.length_squared() > hips[FARTHEST].length_squared() {
            hips[FARTHEST] = hip;
        }
    }
    hips
}

/// From ankle to hip joint in the pelvis' axes between two frames, in leg lengths.
fn hip_at(source: &SourceMotion, pelvis: Quat, side: Side, at: f32) -> Vec3 {
    let place = |frame: &SourceFrame| {
        let world_from_pelvis = frame.rotation(Joint::Hips) * pelvis;
        let hip = frame.position(side.upper_leg()) - frame.position(side.foot());
        world_from_pelvis.inverse() * hip / source.leg_length
    };
    let last = source.frames.len() - 1;
    let frame = (at as usize).min(last);
    let next = (frame + 1).min(last);
    place(&source.frames[frame]).lerp(place(&source.frames[next]), at.fract())
}
