//! Retargeting of a walker whose joint angles are known, dressed up as other skeletons.

mod unusable;

use crate::common::rigs::{MIXAMO, MVN, RIGIFY, UNREAL, XSENS};
use crate::common::walker::walker;
use footfall_core::{Clip, Joint, ModelPose, Side, forward_kinematics};
use footfall_motion::bvh::{BvhFile, clip_to_bvh, parse};
use footfall_motion::retarget::{
    RetargetError, RetargetOptions, Retargeted, normalised_start, retarget,
};
use glam::{EulerRot, Quat, Vec3};

fn options() -> RetargetOptions {
    RetargetOptions::default()
}

/// Largest angle between a segment of both clips, degrees, over trunk, limbs and feet.
fn worst_direction(a: &Clip, b: &Clip) -> f32 {
    use Joint::{
        Hips, LeftFoot, LeftHand, LeftLowerArm, LeftLowerLeg, LeftToes, LeftUpperArm, LeftUpperLeg,
        Neck, RightFoot, RightHand, RightLowerArm, RightLowerLeg, RightToes, RightUpperArm,
        RightUpperLeg,
    };
    let segments = [
        (Hips, Neck),
        (LeftUpperArm, LeftLowerArm),
        (LeftLowerArm, LeftHand),
        (RightUpperArm, RightLowerArm),
        (RightLowerArm, RightHand),
        (LeftUpperLeg, LeftLowerLeg),
        (LeftLowerLeg, LeftFoot),
        (LeftFoot, LeftToes),
        (RightUpperLeg, RightLowerLeg),
        (RightLowerLeg, RightFoot),
        (RightFoot, RightToes),
    ];
    assert_eq!(a.poses.len(), b.poses.len());
    let (mut model_a, mut model_b) = (ModelPose::default(), ModelPose::default());
    let mut worst = 0.0_f32;
    for (pose_a, pose_b) in a.poses.iter().zip(&b.poses) {
        forward_kinematics(&a.skeleton, pose_a, &mut model_a);
        forward_kinematics(&b.skeleton, pose_b, &mut model_b);
        for (from, to) in segments {
            let direction_a = model_a.position(to) - model_a.position(from);
            let direction_b = model_b.position(to) - model_b.position(from);
            worst = worst.max(direction_a.angle_between(direction_b).to_degrees());
        }
    }
    worst
}

/// Largest difference of a local rotation, degrees, and its joint.
fn worst_rotation(a: &Clip, b: &Clip, joints: &[Joint]) -> (f32, Joint) {
    let mut worst = (0.0, Joint::Hips);
    for (pose_a, pose_b) in a.poses.iter().zip(&b.poses) {
        for &joint in joints {
            let turn = pose_a
                .rotation(joint)
                .angle_between(pose_b.rotation(joint))
                .to_degrees();
            if turn > worst.0 {
                worst = (turn, joint);
            }
        }
    }
    worst
}

const LEGS: [Joint; 8] = [
    Joint::LeftUpperLeg,
    Joint::LeftLowerLeg,
    Joint::LeftFoot,
    Joint::LeftToes,
    Joint::RightUpperLeg,
    Joint::RightLowerLeg,
    Joint::RightFoot,
    Joint::RightToes,
];

/// Renames the joints by position in [`Joint::ALL`].
fn renamed(mut file: BvhFile, names: &[&str; 22]) -> BvhFile {
    for (joint, name) in file.joints.iter_mut().zip(names) {
        (*name).clone_into(&mut joint.name);
    }
    file
}

/// The same motion with every joint's axes turned: `basis[n]` is `joint_from_new_joint`. Lengths times `scale`.
fn rebased(file: &BvhFile, basis: &[Quat], scale: f32) -> BvhFile {
    let mut rebased = file.clone();
    for (n, joint) in rebased.joints.iter_mut().enumerate() {
        let parent = joint.parent.map_or(Quat::IDENTITY, |parent| basis[parent]);
        joint.offset = parent.inverse() * joint.offset * scale;
        for end in &mut joint.end_sites {
            *end = basis[n].inverse() * *end * scale;
        }
    }
    let width = file.channel_count();
    for frame in 0..file.frame_count {
        let row = file.frame(frame);
        let mut values: Vec<f32> = row[..3].iter().map(|value| value * scale).collect();
        for (n, angles) in row[3..].chunks_exact(3).enumerate() {
            let [z, x, y] = [angles[0], angles[1], angles[2]].map(f32::to_radians);
            let parent = file.joints[n]
                .parent
                .map_or(Quat::IDENTITY, |parent| basis[parent]);
            let turn = parent.inverse() * Quat::from_euler(EulerRot::ZXY, z, x, y) * basis[n];
            let (z, x, y) = turn.to_euler(EulerRot::ZXY);
            values.extend([z, x, y].map(f32::to_degrees));
        }
        rebased.values[frame * width..(frame + 1) * width].copy_from_slice(&values);
    }
    rebased
}

/// A right-angled turn, chosen by a number.
fn right_angled(n: usize) -> Quat {
    let quarter = std::f32::consts::FRAC_PI_2;
    Quat::from_rotation_x(quarter * (n % 4) as f32)
        * Quat::from_rotation_y(quarter * (n / 4 % 4) as f32)
        * Quat::from_rotation_z(quarter * (n / 16 % 4) as f32)
}

fn source() -> (Clip, BvhFile) {
    let clip = walker(60.0, 240);
    let file = clip_to_bvh(&clip);
    (clip, file)
}

fn expect_near(clip: &Clip, retargeted: &Retargeted, rotation_degrees: f32) {
    let direction = worst_direction(clip, &retargeted.clip);
    assert!(direction < 0.2, "directions differ by {direction} degrees");
    let (turn, joint) = worst_rotation(clip, &retargeted.clip, &LEGS);
    assert!(
        turn < rotation_degrees,
        "{joint:?} differs by {turn} degrees"
    );
    let gap = clip
        .poses
        .iter()
        .zip(&retargeted.clip.poses)
        .map(|(a, b)| (a.root_position - b.root_position).length())
        .fold(0.0, f32::max);
    assert!(gap < 0.02, "the hips are {gap} m off");
}

#[test]
fn our_own_files_come_back_as_they_are() {
    let (clip, file) = source();
    let retargeted = retarget(&file, &options()).unwrap();
    expect_near(&clip, &retargeted, 1.0);
    let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &Joint::ALL);
    assert!(turn < 2.0, "{joint:?} differs by {turn} degrees");
    assert_eq!(retargeted.first_frame, 0);
    assert!((retargeted.report.scale - 1.0).abs() < 1e-3);
}

#[test]
fn names_unit_and_up_axis_do_not_matter() {
    let (clip, file) = source();
    let prefixed = MIXAMO.map(|name| format!("mixamorig:{name}"));
    let families = [
        MIXAMO,
        prefixed.each_ref().map(String::as_str),
        XSENS,
        MVN,
        RIGIFY,
        UNREAL,
    ];
    for (names, scale) in families
        .into_iter()
        .zip([1.0, 100.0, 39.37, 0.01, 1.0, 100.0])
    {
        let file = rebased(&renamed(file.clone(), &names), &[Quat::IDENTITY; 22], scale);
        // Z up: X stays, Y becomes Z. Stated by a joint above the hips, as exporters do.
        let mut z_up = file.clone();
        z_up.joints
            .iter_mut()
            .for_each(|joint| joint.parent = joint.parent.map(|n| n + 1).or(Some(0)));
        let root = parse(
            "HIERARCHY ROOT Reference { OFFSET 0 0 0 CHANNELS 1 Xrotation } MOTION Frames: 1 Frame Time: 1\n90\n",
        )
        .unwrap();
        z_up.joints.insert(0, root.joints[0].clone());
        let width = file.channel_count();
        z_up.values = file
            .values
            .chunks(width)
            .flat_map(|row| [&[90.0], row].concat())
            .collect();
        for (file, map) in [(&file, "as it is"), (&z_up, "Z up")] {
            let retargeted = retarget(file, &options()).unwrap();
            let report = &retargeted.report;
            assert_eq!(
                report.source_joints.iter().flatten().count(),
                22,
                "{map}: {report:?}"
            );
            expect_near_up_to_heading(&clip, &retargeted, map);
        }
    }
}

fn expect_near_up_to_heading(clip: &Clip, retargeted: &Retargeted, what: &str) {
    let ours = normalised_start(&retargeted.clip, retargeted.first_frame);
    let theirs = normalised_start(clip, 0);
    let direction = worst_direction(&theirs, &ours);
    assert!(
        direction < 0.3,
        "{what}: directions differ by {direction} degrees"
    );
    let (turn, joint) = worst_rotation(&theirs, &ours, &LEGS);
    assert!(turn < 2.0, "{what}: {joint:?} differs by {turn} degrees");
}

#[test]
fn zero_rotations_need_not_be_a_body() {
    // Every joint has axes of its own, as in files whose segments all lie along one axis.
    let (clip, file) = source();
    for seed in [3_usize, 17, 41] {
        let basis: Vec<Quat> = (0..22)
            .map(|n| right_angled(seed * (n + 5) + n * n))
            .collect();
        let retargeted = retarget(&rebased(&file, &basis, 100.0), &options()).unwrap();
        let direction = worst_direction(&clip, &retargeted.clip);
        assert!(
            direction < 0.2,
            "seed {seed}: directions differ by {direction} degrees"
        );
        // Knees bend about the same axis and soles are flat at zero.
        let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &LEGS);
        assert!(
            turn < 3.0,
            "seed {seed}: {joint:?} differs by {turn} degrees"
        );
        let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &Joint::ALL);
        assert!(
            turn < 15.0,
            "seed {seed}: {joint:?} differs by {turn} degrees"
        );
    }
}

#[test]
fn slanting_joint_axes_are_read_from_the_motion() {
    let (clip, file) = source();
    let basis: Vec<Quat> = (0..22)
        .map(|n| {
            let axis = Vec3::new(1.0, n as f32 - 9.0, 0.7 * n as f32).normalize();
            Quat::from_axis_angle(axis, 1.0 + 0.07 * n as f32)
        })
        .collect();
    let retargeted = retarget(&rebased(&file, &basis, 1.0), &options()).unwrap();
    let direction = worst_direction(&clip, &retargeted.clip);
    assert!(direction < 0.2, "directions differ by {direction} degrees");
    let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &LEGS);
    assert!(turn < 3.0, "{joint:?} differs by {turn} degrees");
}

#[test]
fn a_leading_t_pose_is_kept_and_told() {
    let (mut clip, _) = source();
    clip.poses[0] = footfall_core::Pose::rest(&clip.skeleton);
    let retargeted = retarget(&clip_to_bvh(&clip), &options()).unwrap();
    assert_eq!(retargeted.first_frame, 1);
    assert_eq!(retargeted.clip.poses.len(), clip.poses.len());
    let start = normalised_start(&retargeted.clip, 1);
    for pose in &start.poses[..2] {
        assert!(pose.root_position.with_y(0.0).length() < 1e-5);
        assert!(footfall_core::rotation::heading(pose.rotation(Joint::Hips)).abs() < 1e-4);
    }
}

#[test]
fn the_floor_is_found_and_levelled() {
    let (clip, _) = source();
    let mut lifted = clip.clone();
    for pose in &mut lifted.poses {
        pose.root_position.y += 0.7 + 0.02 * pose.root_position.z;
    }
    let retargeted = retarget(&clip_to_bvh(&lifted), &options()).unwrap();
    let gap = clip
        .poses
        .iter()
        .zip(&retargeted.clip.poses)
        .map(|(a, b)| (a.root_position.y - b.root_position.y).abs())
        .fold(0.0, f32::max);
    assert!(gap < 0.01, "{gap} m");
}

#[test]
fn feet_keep_their_slope_and_stand_flat() {
    let (mut clip, _) = source();
    // A body with higher ankles.
    for side in Side::BOTH {
        clip.skeleton.offsets[side.toes().index()] = Vec3::new(0.0, -0.1, 0.11);
        clip.skeleton.feet[side.index()].heel.y = -0.12;
    }
    clip.skeleton.offsets[0].y += 0.035;
    for pose in &mut clip.poses {
        pose.root_position.y += 0.035;
    }
    let retargeted = retarget(&clip_to_bvh(&clip), &options()).unwrap();
    assert!(worst_direction(&clip, &retargeted.clip) < 0.2);
    let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &LEGS);
    assert!(turn < 1.5, "{joint:?} differs by {turn} degrees");
    assert!(
        retargeted
            .report
            .flat_foot_frames
            .iter()
            .all(|frames| *frames > 20)
    );
}

#[test]
fn our_own_walkers_on_tiptoe_stay_on_tiptoe() {
    let (mut clip, _) = source();
    for pose in &mut clip.poses {
        for side in Side::BOTH {
            pose.rotations[side.foot().index()] *= Quat::from_rotation_x(0.5);
        }
    }
    let retargeted = retarget(&clip_to_bvh(&clip), &options()).unwrap();
    let feet = Side::BOTH.map(Side::foot);
    let (turn, joint) = worst_rotation(&clip, &retargeted.clip, &feet);
    assert!(turn < 0.1, "{joint:?} differs by {turn} degrees");
}

#[test]
fn another_rate_keeps_time() {
    let (clip, file) = source();
    let with_rate = RetargetOptions {
        frame_rate_hz: Some(30.0),
        ..options()
    };
    let retargeted = retarget(&file, &with_rate).unwrap();
    assert_eq!(retargeted.clip.poses.len(), 120);
    assert!((retargeted.clip.duration_secs() - clip.duration_secs()).abs() < 1.0 / 30.0);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = RetargetOptions {
            frame_rate_hz: Some(bad),
            ..options()
        };
        assert!(matches!(
            retarget(&file, &options),
            Err(RetargetError::FrameRate(_))
        ));
    }
}
