//! Misplaced hip joints of whole recordings: found, corrected, and left alone where there is nothing to correct.

use crate::common::natural::{knee_degrees, misfitted, natural_walker};
use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use footfall_motion::bvh::{BvhFile, clip_to_bvh, write};
use footfall_motion::corpus::{Corpus, CorpusError, Where};
use footfall_motion::hip_centres::HipVerdict;
use footfall_motion::retarget::{RetargetOptions, Retargeted, SkeletonFit, retarget};
use glam::Vec3;
use std::fmt::Write as _;
use std::path::Path;

fn read(file: &BvhFile) -> Retargeted {
    let options = RetargetOptions {
        fit: SkeletonFit::FromRecording,
        ..RetargetOptions::default()
    };
    retarget(file, &options).expect("a body that can be placed")
}

fn as_recorded(file: &BvhFile) -> Retargeted {
    let options = RetargetOptions {
        fit: SkeletonFit::AsRecorded,
        ..RetargetOptions::default()
    };
    retarget(file, &options).expect("a body that can be placed")
}

/// Root mean square difference of the knees between two clips of one walk, degrees, the ends left out.
fn knees_apart(a: &Clip, b: &Clip) -> f32 {
    let frames = 10..a.poses.len() - 10;
    let count = 2.0 * frames.len() as f32;
    let squares = frames.flat_map(|frame| {
        Side::BOTH.map(|side| (knee_degrees(a, frame, side) - knee_degrees(b, frame, side)).powi(2))
    });
    (squares.sum::<f32>() / count).sqrt()
}

/// Recordings of an index, with the hip joints found person by person.
fn read_corpus(index: &Path, conditions: &[Where]) -> Result<Corpus, CorpusError> {
    let options = RetargetOptions {
        fit: SkeletonFit::FromRecording,
        ..RetargetOptions::default()
    };
    Corpus::read_with(index, conditions, &options)
}

#[test]
fn a_badly_fitted_skeleton_gets_its_knees_back() {
    let truth = natural_walker(60.0, 500, 0.0);
    // Below and ahead of the joint, as fits of markers have it.
    for offset in [Vec3::new(0.0, -0.018, 0.045), Vec3::new(0.0, -0.02, 0.035)] {
        let file = misfitted(&truth, offset);
        let recorded = as_recorded(&file);
        assert_eq!(
            recorded.report.fit.hip_centres.verdict,
            HipVerdict::AsRecorded
        );
        let bad = knees_apart(&truth, &recorded.clip);
        assert!(bad > 5.0, "the fit is bad: {bad}");
        let read = read(&file);
        let correction = *read.report.fit.hip_centres.verdict.correction().unwrap();
        for side in Side::BOTH {
            let moved = correction.offset(side) * 0.84;
            assert!(
                (moved.z + offset.z).abs() < 0.01,
                "{offset} came back as {moved}"
            );
            let raised = moved.y - 0.84 * (correction.leg_factor - 1.0);
            assert!(
                (raised + offset.y).abs() < 0.005,
                "{offset} came back as {moved}"
            );
        }
        let knee = knees_apart(&truth, &read.clip);
        assert!(
            knee < 0.45 * bad,
            "{offset}: knees are {knee} degrees off, {bad} before"
        );
    }
}

#[test]
fn pelvis_and_feet_stay_where_they_were() {
    let file = misfitted(
        &natural_walker(60.0, 400, 0.0),
        Vec3::new(0.0, -0.018, 0.045),
    );
    let recorded = as_recorded(&file);
    let corrected = read(&file);
    let correction = *corrected
        .report
        .fit
        .hip_centres
        .verdict
        .correction()
        .unwrap();
    let scale = corrected.report.scale / recorded.report.scale;
    let unit = recorded.clip.skeleton.mean_leg_length();
    // The body has two legs alike, so it hangs between the hip joints, and shows nothing of what one moves more than the other.
    let [left, right] = Side::BOTH.map(|side| unit * correction.offset(side));
    let (moved, apart) = (0.5 * (left + right), 0.5 * (left - right).length());
    assert!(apart < 0.001, "the legs are alike: {correction:?}");
    let (mut before, mut after) = (ModelPose::default(), ModelPose::default());
    for (a, b) in recorded.clip.poses.iter().zip(&corrected.clip.poses) {
        forward_kinematics(&recorded.clip.skeleton, a, &mut before);
        forward_kinematics(&corrected.clip.skeleton, b, &mut after);
        assert!(a.rotations[0].angle_between(b.rotations[0]).to_degrees() < 0.1);
        let gap = (scale * (a.root_position + a.rotations[0] * moved)).distance(b.root_position);
        assert!(gap < 0.001, "the pelvis moved by {gap} m");
        for side in Side::BOTH {
            let foot = side.foot();
            let turned = before.rotation(foot).angle_between(after.rotation(foot));
            assert!(turned.to_degrees() < 0.1, "a foot turned by {turned}");
            let gap = (before.position(foot) * scale).distance(after.position(foot));
            assert!(gap < 0.001 + apart, "an ankle moved by {gap} m");
        }
    }
}

#[test]
fn our_own_files_are_never_corrected() {
    for crouch in [0.0, 0.03, 0.2] {
        let clip = natural_walker(60.0, 400, crouch);
        let read = read(&clip_to_bvh(&clip));
        assert_eq!(read.report.fit.hip_centres.verdict, HipVerdict::OwnBody);
        let knee = knees_apart(&clip, &read.clip);
        assert!(knee < 0.1, "knees moved by {knee} degrees");
        let again = self::read(&clip_to_bvh(&read.clip));
        assert!(knees_apart(&read.clip, &again.clip) < 0.1);
    }
}

#[test]
fn natural_and_crouching_people_stay_as_they_are() {
    // Another body than ours, so that it is looked at.
    let slight = Vec3::new(0.01, 0.0, 0.004);
    for (crouch, expected) in [(0.0, HipVerdict::Natural), (0.2, HipVerdict::OwnManner)] {
        let clip = natural_walker(60.0, 500, crouch);
        let read = read(&misfitted(&clip, slight));
        assert_eq!(read.report.fit.hip_centres.verdict, expected, "{crouch}");
        assert!(knees_apart(&clip, &read.clip) < 4.0);
    }
}

#[test]
fn knees_that_could_be_bent_on_purpose_are_left() {
    let slight = misfitted(
        &natural_walker(60.0, 500, 0.0),
        Vec3::new(0.0, -0.008, 0.006),
    );
    let bent = misfitted(
        &natural_walker(60.0, 500, 0.02),
        Vec3::new(0.01, 0.0, 0.004),
    );
    for file in [slight, bent] {
        let left = read(&file);
        assert_eq!(left.report.fit.hip_centres.verdict.correction(), None);
        assert!(left.report.fit.hip_centres.probability.unwrap() < 0.5);
        assert!(knees_apart(&left.clip, &as_recorded(&file).clip) < 1e-3);
    }
}

#[test]
fn a_clip_of_two_steps_is_too_short_to_tell() {
    let file = misfitted(
        &natural_walker(60.0, 80, 0.0),
        Vec3::new(0.0, -0.018, 0.045),
    );
    assert_eq!(
        read(&file).report.fit.hip_centres.verdict,
        HipVerdict::TooLittleWalking
    );
}

#[test]
fn all_clips_of_a_person_tell_and_all_are_corrected() {
    let folder = tempfile::tempdir().unwrap();
    let offset = Vec3::new(0.0, -0.018, 0.045);
    let other = Vec3::new(0.02, 0.0, 0.0);
    let [short, long] = [80, 500].map(|frames| natural_walker(60.0, frames, 0.0));
    let mut index = "path,category,style,subject\n".to_owned();
    for (name, subject, clip, offset) in [
        ("long", "one", &long, offset),
        ("short", "one", &short, offset),
        // The same subject on another skeleton is somebody else, and so is whoever the index is not sure of.
        ("another", "one", &short, other),
        ("unsure", "one?", &short, offset),
        // One person under two names is found from each name's own clips.
        ("renamed", "uno", &short, offset),
    ] {
        let path = folder.path().join(format!("{name}.bvh"));
        std::fs::write(path, write(&misfitted(clip, offset))).unwrap();
        writeln!(index, "{name}.bvh,walk,neutral,{subject}").unwrap();
    }
    let path = folder.path().join("index.csv");
    std::fs::write(&path, index).unwrap();
    let verdicts = |conditions: &[&str]| -> Vec<HipVerdict> {
        let conditions: Vec<_> = conditions
            .iter()
            .map(|text| text.parse().unwrap())
            .collect();
        let corpus = read_corpus(&path, &conditions).unwrap();
        let clips = corpus.clips.iter();
        clips
            .map(|clip| clip.retargeted.report.fit.hip_centres.verdict)
            .collect()
    };
    let all = verdicts(&[]);
    assert!(all[0].correction().is_some());
    assert_eq!(all[1], all[0]);
    assert_eq!(all[2..], [HipVerdict::TooLittleWalking; 3]);
    // Clips that were not chosen are evidence for the person all the same.
    assert_eq!(verdicts(&["path=short*"]), all[1..2]);
}

#[test]
fn a_deep_crouch_of_a_corrected_person_stays_a_deep_crouch() {
    let folder = tempfile::tempdir().unwrap();
    let offset = Vec3::new(0.0, -0.018, 0.045);
    let crouched = natural_walker(60.0, 400, 0.2);
    for (name, clip) in [
        ("plain", &natural_walker(60.0, 500, 0.0)),
        ("crouched", &crouched),
    ] {
        let path = folder.path().join(format!("{name}.bvh"));
        std::fs::write(path, write(&misfitted(clip, offset))).unwrap();
    }
    let path = folder.path().join("index.csv");
    let rows = "plain.bvh,walk,neutral,one\ncrouched.bvh,walk,crouching,one\n";
    std::fs::write(&path, format!("path,category,style,subject\n{rows}")).unwrap();
    let corpus = read_corpus(&path, &["style=crouching".parse().unwrap()]).unwrap();
    let read = &corpus.clips[0].retargeted;
    assert!(read.report.fit.hip_centres.verdict.correction().is_some());
    let apart = knees_apart(&crouched, &read.clip);
    assert!(apart < 4.0, "knees are {apart} degrees off");
    let deep = |clip: &Clip| knee_degrees(clip, 200, Side::Left);
    assert!(deep(&read.clip) > 50.0, "{}", deep(&read.clip));
}
