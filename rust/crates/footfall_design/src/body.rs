//! Rotations above the legs, and of the pelvis.

use crate::chance::drift;
use crate::course::Course;
use crate::curve::stance_wave;
use crate::sheet::{Axis, JointEdit, StyleSheet};
use crate::timeline::Timeline;
use core::f32::consts::TAU;
use footfall_core::rotation::{exp_map, log_map};
use footfall_core::{Joint, Pose, Side};
use glam::{Quat, Vec3};

/// Share of a forward lean that a hanging arm does not follow.
const ARM_HANGS: f32 = 0.8;
/// Least and greatest bend of an elbow, radians.
const ELBOW: [f32; 2] = [0.05, 2.4];

/// Facts of a frame that the edits need.
struct Frame {
    level: Quat,
    phase: f32,
    secs: f32,
}

/// Turns pelvis, trunk, head and arms of every frame into the style.
pub(crate) fn edit_body(
    poses: &mut [Pose],
    course: &Course,
    timeline: &Timeline,
    sheet: &StyleSheet,
    rate_hz: f64,
    seed: u64,
) {
    let frames: Vec<Frame> = (0..poses.len())
        .map(|frame| Frame {
            level: course.level(frame),
            phase: timeline.phase[frame],
            secs: frame as f32 / rate_hz as f32,
        })
        .collect();
    edit_trunk(poses, &frames, sheet, seed);
    edit_head(poses, &frames, sheet, seed);
    for side in Side::BOTH {
        edit_arm(poses, &frames, side, sheet, seed);
    }
    for joint in Joint::ALL {
        edit_joint(poses, &frames, joint, sheet);
    }
}

/// The pelvis, and the spine so that the trunk keeps its own attitude.
fn edit_trunk(poses: &mut [Pose], frames: &[Frame], sheet: &StyleSheet, seed: u64) {
    let (pelvis, trunk, chance) = (&sheet.pelvis, &sheet.trunk, &sheet.irregular);
    let hips_of = |pose: &Pose, frame: &Frame| frame.level.inverse() * pose.rotation(Joint::Hips);
    let hips: Vec<Quat> = poses
        .iter()
        .zip(frames)
        .map(|(pose, frame)| hips_of(pose, frame))
        .collect();
    let waist: Vec<Quat> = poses
        .iter()
        .zip(&hips)
        .map(|(pose, hips)| *hips * pose.rotation(Joint::Spine))
        .collect();
    let (mean_hips, mean_waist) = (mean_rotation(&hips), mean_rotation(&waist));
    let chest = [Joint::Chest, Joint::UpperChest];
    let mean_chest = chest.map(|joint| mean_of(poses, joint));
    let amplitude = trunk.amplitude / 100.0;
    for (index, (pose, frame)) in poses.iter_mut().zip(frames).enumerate() {
        let wave = stance_wave(frame.phase);
        let stepping = (frame.phase * TAU).cos();
        let slow = |stream| chance.trunk * drift(seed, stream, frame.secs / chance.period);
        let about_mean = log_map(hips[index] * mean_hips.inverse());
        let more = Vec3::new(0.0, -pelvis.turn * stepping, pelvis.list * wave);
        let tilt = degrees(Vec3::X * pelvis.tilt);
        let new_hips = exp_map(about_mean + more * TAU / 360.0) * tilt * mean_hips;
        pose.rotations[Joint::Hips.index()] = (frame.level * new_hips).normalize();

        let about_mean = log_map(waist[index] * mean_waist.inverse()) * amplitude;
        let more = Vec3::new(
            slow(10),
            trunk.turn * stepping,
            -trunk.sway * wave + 0.8 * slow(11),
        );
        let attitude = degrees(Vec3::new(0.5 * trunk.lean, 0.0, -0.5 * trunk.side_lean));
        let new_waist = exp_map(about_mean + 0.6 * more * TAU / 360.0) * attitude * mean_waist;
        pose.rotations[Joint::Spine.index()] = (new_hips.inverse() * new_waist).normalize();

        for (n, joint) in chest.into_iter().enumerate() {
            let about_mean = log_map(pose.rotation(joint) * mean_chest[n].inverse()) * amplitude;
            let rounding = trunk.slump * [0.4, 0.6][n];
            let attitude = degrees(Vec3::new(
                0.25 * trunk.lean + rounding,
                0.0,
                -0.25 * trunk.side_lean,
            ));
            let turned = exp_map(about_mean + 0.2 * more * TAU / 360.0) * attitude * mean_chest[n];
            pose.rotations[joint.index()] = turned.normalize();
        }
    }
}

fn edit_head(poses: &mut [Pose], frames: &[Frame], sheet: &StyleSheet, seed: u64) {
    let (head, chance) = (&sheet.head, &sheet.irregular);
    // The face looks where the sheet says, whatever the trunk does below it.
    let pitch = head.pitch - sheet.trunk.lean - sheet.trunk.slump;
    let attitude = Vec3::new(pitch, head.turn, -head.tilt + sheet.trunk.side_lean);
    for (joint, share) in [(Joint::Neck, 0.45), (Joint::Head, 0.55)] {
        let mean = mean_of(poses, joint);
        for (pose, frame) in poses.iter_mut().zip(frames) {
            let slow = |stream| chance.head * drift(seed, stream, frame.secs / chance.period);
            let nod = Vec3::new(slow(20), 0.8 * slow(21), 0.6 * slow(22));
            let about_mean = log_map(pose.rotation(joint) * mean.inverse());
            let turned = exp_map(about_mean * head.amplitude / 100.0)
                * degrees((attitude + nod) * share)
                * mean;
            pose.rotations[joint.index()] = turned.normalize();
        }
    }
}

fn edit_arm(poses: &mut [Pose], frames: &[Frame], side: Side, sheet: &StyleSheet, seed: u64) {
    let shoulder = match side {
        Side::Left => Joint::LeftShoulder,
        Side::Right => Joint::RightShoulder,
    };
    let upper = Joint::ALL[shoulder.index() + 1];
    let lower = Joint::ALL[shoulder.index() + 2];
    let (arms, girdle, chance) = (&sheet.arms, &sheet.shoulders, &sheet.irregular);
    let sign = side.sign();
    let shift = degrees(Vec3::new(0.0, -girdle.forward * sign, girdle.raise * sign));
    let mean_upper = mean_of(poses, upper);
    let mean_lower = mean_of(poses, lower);
    let elbow_axis = elbow_axis(mean_lower, sign);
    let hang = ARM_HANGS * (sheet.trunk.lean + sheet.trunk.slump);
    let swing = arms.swing / 100.0 * sheet.sides[side.index()].arm_swing / 100.0;
    let carriage = degrees(Vec3::Z * arms.out * sign) * degrees(Vec3::X * -(arms.forward + hang));
    let turn_in = degrees(Vec3::X * arms.turn_in);
    let axis_along_x = Vec3::X * sign;
    for (pose, frame) in poses.iter_mut().zip(frames) {
        let stream = 30 + 4 * side.index() as u64;
        let slow = |n| chance.arms * drift(seed, stream + n, frame.secs / chance.period);
        let girdle_turn = shift * pose.rotation(shoulder);
        pose.rotations[shoulder.index()] = girdle_turn.normalize();

        let about_mean = log_map(pose.rotation(upper) * mean_upper.inverse()) * swing;
        let more = Vec3::new(slow(0), 0.0, 0.6 * slow(1)) * TAU / 360.0;
        let new_upper = carriage * exp_map(about_mean + more) * mean_upper * turn_in;
        // The girdle carries the arm's root, not its direction.
        pose.rotations[upper.index()] = (shift.inverse() * new_upper).normalize();

        let about_mean = log_map(pose.rotation(lower) * mean_lower.inverse());
        let swung = exp_map(about_mean * arms.elbow_swing / 100.0) * mean_lower;
        let bend = (swung * axis_along_x).angle_between(axis_along_x);
        let wanted = bend + (arms.elbow + 0.5 * slow(2)).to_radians();
        let add = if arms.elbow == 0.0 && chance.arms == 0.0 {
            0.0
        } else {
            wanted.clamp(ELBOW[0], ELBOW[1]) - bend
        };
        let bent = Quat::from_axis_angle(elbow_axis, add) * swung;
        pose.rotations[lower.index()] = bent.normalize();
    }
}

/// The axis about which this elbow bends, in the frame of the upper arm.
fn elbow_axis(mean_lower: Quat, sign: f32) -> Vec3 {
    let straight = Vec3::X * sign;
    // In the T-pose, palms down, a forearm bends forwards.
    let anatomical = Vec3::Y * -sign;
    let bent = straight.cross(mean_lower * straight);
    // A stretched arm's plane is mostly noise.
    (bent + anatomical * 0.05).normalize_or(anatomical)
}

/// `[joints.NAME]` and `[[curve]]`.
fn edit_joint(poses: &mut [Pose], frames: &[Frame], joint: Joint, sheet: &StyleSheet) {
    let edits: Vec<&JointEdit> = sheet
        .joints
        .iter()
        .filter(|(edited, _)| *edited == joint)
        .map(|(_, edit)| edit)
        .collect();
    let curves: Vec<_> = sheet
        .curves
        .iter()
        .filter(|curve| curve.joint == joint)
        .collect();
    if edits.is_empty() && curves.is_empty() {
        return;
    }
    let delay = if joint.name().starts_with("Right") {
        0.5
    } else {
        0.0
    };
    let is_root = joint == Joint::Hips;
    let parent = |frame: &Frame| {
        if is_root { frame.level } else { Quat::IDENTITY }
    };
    let local: Vec<Quat> = poses
        .iter()
        .zip(frames)
        .map(|(pose, frame)| parent(frame).inverse() * pose.rotation(joint))
        .collect();
    let mean = mean_rotation(&local);
    for ((pose, frame), local) in poses.iter_mut().zip(frames).zip(local) {
        let mut offset = Vec3::ZERO;
        let mut amplitude = 1.0;
        for edit in &edits {
            offset += Vec3::new(edit.pitch, edit.yaw, edit.roll);
            amplitude *= edit.amplitude / 100.0;
        }
        for curve in &curves {
            let axis = match curve.axis {
                Axis::Pitch => Vec3::X,
                Axis::Yaw => Vec3::Y,
                Axis::Roll => Vec3::Z,
            };
            offset += axis * curve.offset.at(frame.phase - delay);
            amplitude *= curve.amplitude.at(frame.phase - delay) / 100.0;
        }
        let about_mean = log_map(local * mean.inverse()) * amplitude;
        let turned = parent(frame) * degrees(offset) * exp_map(about_mean) * mean;
        pose.rotations[joint.index()] = turned.normalize();
    }
}

/// The rotation by these degrees about the axes x, y and z at once.
fn degrees(angles: Vec3) -> Quat {
    exp_map(angles * (TAU / 360.0))
}

fn mean_of(poses: &[Pose], joint: Joint) -> Quat {
    let rotations: Vec<Quat> = poses.iter().map(|pose| pose.rotation(joint)).collect();
    mean_rotation(&rotations)
}

/// The rotation from which the given ones differ by zero on average.
fn mean_rotation(rotations: &[Quat]) -> Quat {
    let mut mean = rotations[0];
    for _ in 0..4 {
        let sum: Vec3 = rotations
            .iter()
            .map(|rotation| log_map(*rotation * mean.inverse()))
            .sum();
        mean = (exp_map(sum / rotations.len() as f32) * mean).normalize();
    }
    mean
}
