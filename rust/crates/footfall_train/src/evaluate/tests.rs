//! The whole on walks whose style is known because it was made.

use super::*;
use footfall_core::rotation::exp_map;
use footfall_core::{Joint, Side, Skeleton};
use footfall_motion::retarget::Retargeted;
use footfall_motion::steps::{Step, Walk};
use glam::Vec3;

const STEP_FRAMES: usize = 24;

/// A walk whose steps vary a little; `stoop` radians is its style, `seed` its variation.
fn walk(style: &str, stoop: f32, seed: u32, steps: usize) -> Recording {
    let skeleton = Skeleton::standard();
    let poses = (0..=steps * STEP_FRAMES)
        .map(|frame| {
            let step = frame / STEP_FRAMES;
            let wobble = ((step as u32 * 7919 + seed * 104_729) % 101) as f32 / 101.0 - 0.5;
            let phase = core::f32::consts::PI * frame as f32 / STEP_FRAMES as f32;
            let mut pose = Pose::rest(&skeleton);
            pose.root_position.z = 0.02 * frame as f32;
            pose.rotations[Joint::Chest.index()] = exp_map(Vec3::X * (stoop + 0.02 * wobble));
            for side in Side::BOTH {
                let swing = (0.4 + 0.05 * wobble) * phase.sin() * side.sign();
                pose.rotations[side.upper_leg().index()] = exp_map(Vec3::X * swing);
            }
            pose
        })
        .collect();
    let steps = (0..steps)
        .map(|index| {
            Step::inside(
                Side::BOTH[index % 2],
                index * STEP_FRAMES,
                (index + 1) * STEP_FRAMES,
            )
        })
        .collect();
    let clip = Clip {
        skeleton,
        frame_rate_hz: 30.0,
        poses,
    };
    let mut recording = Recording::detected(Retargeted::canonical(clip));
    recording.row.set("style", style);
    recording.walks = vec![Walk { steps }];
    recording
}

fn real() -> Vec<Recording> {
    [
        ("upright", 0.0, 1),
        ("sad", 0.3, 2),
        ("upright", 0.01, 3),
        ("sad", 0.29, 4),
    ]
    .map(|(style, stoop, seed)| walk(style, stoop, seed, 14))
    .to_vec()
}

#[test]
fn styles_that_differ_are_told_apart_however_they_are_split() {
    for split in [None, Some(Split::Take), Some(Split::Half)] {
        let judged = evaluate_styles(&real(), None, split).unwrap();
        assert_eq!(judged.split, split.unwrap_or(Split::Take));
        assert_eq!(judged.real.labels, ["sad", "upright"]);
        assert_eq!(judged.real.rate(), Some(1.0), "{:?}", judged.real);
        assert_eq!(judged.real.efficiency(), Some(2.0));
        assert_eq!(judged.synthesised, None);
        assert_eq!(judged.ratio(), None);
        // Halves leave out the stride that reaches across the middle.
        let strides = if judged.split == Split::Take { 52 } else { 48 };
        assert_eq!(judged.real.total(), strides);
    }
}

#[test]
fn a_wrong_synthesis_is_found_out() {
    let good = [walk("sad", 0.3, 9, 10), walk("upright", 0.0, 10, 10)];
    let judged = evaluate_styles(&real(), Some(&good), None).unwrap();
    assert_eq!(judged.ratio(), Some(1.0));
    let near = judged.styles[0]
        .synthesised
        .as_ref()
        .unwrap()
        .1
        .distance
        .unwrap();
    // One who walks upright under the name of sad.
    let bad = [walk("sad", 0.0, 9, 10), walk("upright", 0.0, 10, 10)];
    let judged = evaluate_styles(&real(), Some(&bad), None).unwrap();
    assert_eq!(judged.ratio(), Some(0.5));
    assert_eq!(
        judged.synthesised.as_ref().unwrap().class_rate(0),
        Some(0.0)
    );
    let far = judged.styles[0]
        .synthesised
        .as_ref()
        .unwrap()
        .1
        .distance
        .unwrap();
    assert!(far > 3.0 * near, "{far} is not far beyond {near}");
}

#[test]
fn damped_and_repeated_steps_are_found_out() {
    let mut damped = walk("sad", 0.3, 2, 14);
    for pose in &mut damped.retargeted.clip.poses {
        let joint = Joint::LeftUpperLeg.index();
        pose.rotations[joint] = glam::Quat::IDENTITY.slerp(pose.rotations[joint], 0.5);
    }
    let judged = evaluate_styles(&real(), Some(&[damped]), None).unwrap();
    let [least, greatest] = judged.styles[0]
        .synthesised
        .as_ref()
        .unwrap()
        .1
        .variance
        .extremes()
        .unwrap();
    assert_eq!(least.0, Joint::LeftUpperLeg);
    assert!(
        (least.1 - 0.25).abs() < 0.05 && greatest.1 > 0.9,
        "{least:?} {greatest:?}"
    );
    // One step over and over.
    let mut repeated = walk("sad", 0.3, 2, 14);
    for frame in 0..repeated.clip().poses.len() {
        let poses = &mut repeated.retargeted.clip.poses;
        poses[frame].rotations = poses[frame % (2 * STEP_FRAMES)].rotations;
    }
    let judged = evaluate_styles(&real(), Some(&[repeated]), None).unwrap();
    let ratio = judged.styles[0]
        .synthesised
        .as_ref()
        .unwrap()
        .1
        .variability
        .median();
    assert!(ratio.unwrap() < 1e-3, "{ratio:?}");
    let natural = judged.styles[0]
        .real_against_real
        .variability
        .median()
        .unwrap();
    assert!((0.85..1.15).contains(&natural), "{natural}");
}

#[test]
fn bad_input_says_what_to_do() {
    let error = |real: &[Recording], synthesised: Option<&[Recording]>, split| {
        evaluate_styles(real, synthesised, split).unwrap_err()
    };
    assert_eq!(error(&[], None, None), EvaluateError::OneStyle { found: 0 });
    assert_eq!(
        error(&real()[..1], None, None),
        EvaluateError::OneStyle { found: 1 }
    );
    let single = error(&real()[..3], None, Some(Split::Take)).to_string();
    assert!(
        single.contains("sad") && single.contains("--split half"),
        "{single}"
    );
    let short: Vec<Recording> = vec![walk("sad", 0.3, 1, 3), walk("upright", 0.0, 1, 14)];
    assert!(
        matches!(error(&short, None, None), EvaluateError::Split { style, .. } if style == "sad")
    );
    let unknown = error(&real(), Some(&[walk("proud", 0.0, 1, 6)]), None);
    assert!(matches!(unknown, EvaluateError::UnknownStyle { style, .. } if style == "proud"));
    let standing = walk("sad", 0.3, 1, 1);
    assert_eq!(
        error(&real(), Some(&[standing]), None),
        EvaluateError::NoSynthesisedStride
    );
    let mut broken = real();
    broken[0].retargeted.clip.poses[40].rotations[3] =
        glam::Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0);
    let frame = error(&broken, None, None);
    assert!(
        matches!(frame, EvaluateError::NotFinite { frame: 40, .. }),
        "{frame}"
    );
}
