//! Segment directions survive retargeting, on every recording that is there.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use footfall_core::{Joint, ModelPose, forward_kinematics};
use footfall_motion::bvh::{self, BvhFile, JointTransforms};
use footfall_motion::retarget::{RetargetOptions, SkeletonFit, retarget};
use glam::Vec3;

/// The names of hips, neck, left upper arm, elbow, hand, hip joint, knee, ankle and toe joint, then the right side.
/// Written down here again so that the test does not lean on the maps under test. `""`: the family has no such joint.
const FAMILIES: [[&str; 16]; 4] = [
    [
        "Hips",
        "Neck",
        "LeftArm",
        "LeftForeArm",
        "LeftHand",
        "LeftUpLeg",
        "LeftLeg",
        "LeftFoot",
        "LeftToeBase",
        "RightArm",
        "RightForeArm",
        "RightHand",
        "RightUpLeg",
        "RightLeg",
        "RightFoot",
        "RightToeBase",
    ],
    [
        "hip", "neck", "lShldr", "lForeArm", "lHand", "lThigh", "lShin", "lFoot", "", "rShldr",
        "rForeArm", "rHand", "rThigh", "rShin", "rFoot", "",
    ],
    [
        "Hips",
        "Neck",
        "UpperArm_L",
        "LowerArm_L",
        "Hand_L",
        "UpperLeg_L",
        "LowerLeg_L",
        "Foot_L",
        "Toes_L",
        "UpperArm_R",
        "LowerArm_R",
        "Hand_R",
        "UpperLeg_R",
        "LowerLeg_R",
        "Foot_R",
        "Toes_R",
    ],
    [
        "pelvis",
        "neck",
        "upper_arm.L",
        "forearm.L",
        "",
        "thigh.L",
        "shin.L",
        "foot.L",
        "",
        "upper_arm.R",
        "forearm.R",
        "",
        "thigh.R",
        "shin.R",
        "foot.R",
        "",
    ],
];

const CANONICAL: [Joint; 16] = [
    Joint::Hips,
    Joint::Neck,
    Joint::LeftUpperArm,
    Joint::LeftLowerArm,
    Joint::LeftHand,
    Joint::LeftUpperLeg,
    Joint::LeftLowerLeg,
    Joint::LeftFoot,
    Joint::LeftToes,
    Joint::RightUpperArm,
    Joint::RightLowerArm,
    Joint::RightHand,
    Joint::RightUpperLeg,
    Joint::RightLowerLeg,
    Joint::RightFoot,
    Joint::RightToes,
];

/// Pairs of the lists above: trunk, upper arms, forearms, thighs, shanks, feet.
const SEGMENTS: [(usize, usize); 11] = [
    (0, 1),
    (2, 3),
    (3, 4),
    (5, 6),
    (6, 7),
    (7, 8),
    (9, 10),
    (10, 11),
    (12, 13),
    (13, 14),
    (14, 15),
];

fn source_joints(file: &BvhFile) -> [Option<usize>; 16] {
    FAMILIES
        .iter()
        .map(|names| names.map(|name| file.joint_named(name)))
        .max_by_key(|joints| joints.iter().flatten().count())
        .unwrap()
}

#[test]
fn directions_agree_on_every_recording() {
    let Some(folder) = crate::common::data_folder() else {
        return;
    };
    let files = crate::common::bvh_files(&folder);
    assert!(!files.is_empty());
    let mut rows = Vec::new();
    let mut transforms = JointTransforms::default();
    let mut model = ModelPose::default();
    // Corrected legs point elsewhere on purpose.
    let as_recorded = RetargetOptions {
        fit: SkeletonFit::AsRecorded,
        ..RetargetOptions::default()
    };
    for path in &files {
        let file = bvh::read(path).unwrap();
        let retargeted = retarget(&file, &as_recorded).unwrap();
        let joints = source_joints(&file);
        let mut worst = (0.0_f32, 0, "");
        let mut sums = [(0.0_f64, 0.0_f64); SEGMENTS.len()];
        for (frame, pose) in retargeted.clip.poses.iter().enumerate() {
            file.place_joints(frame, &mut transforms);
            forward_kinematics(&retargeted.clip.skeleton, pose, &mut model);
            for (n, &(from, to)) in SEGMENTS.iter().enumerate() {
                let (Some(source_from), Some(source_to)) = (joints[from], joints[to]) else {
                    continue;
                };
                let source: Vec3 =
                    transforms.positions[source_to] - transforms.positions[source_from];
                let ours = model.position(CANONICAL[to]) - model.position(CANONICAL[from]);
                let degrees = source.angle_between(ours).to_degrees();
                assert!(degrees.is_finite());
                sums[n].0 += f64::from(degrees);
                sums[n].1 += 1.0;
                if degrees > worst.0 {
                    worst = (degrees, frame, CANONICAL[from].name());
                }
            }
        }
        let mean = sums
            .iter()
            .filter(|sum| sum.1 > 0.0)
            .map(|sum| sum.0 / sum.1)
            .fold(0.0, f64::max);
        rows.push((worst, mean, path.file_name().unwrap().to_owned()));
    }
    rows.sort_by(|a, b| b.0.0.total_cmp(&a.0.0));
    println!(
        "{} clips; worst degrees, frame, segment, worst segment's mean, clip",
        rows.len()
    );
    for (worst, mean, name) in rows.iter().take(8) {
        println!(
            "{:7.3} {:5} {:14} {mean:7.3} {}",
            worst.0,
            worst.1,
            worst.2,
            name.display()
        );
    }
    for (worst, mean, name) in rows {
        assert!(
            worst.0 < 5.0 && mean < 2.0,
            "{}: {worst:?}, mean {mean}",
            name.display()
        );
    }
}
