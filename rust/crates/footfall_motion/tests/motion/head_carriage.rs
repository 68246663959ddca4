//! Necks and faces of skeletons that were fitted to markers: levelled person by person, their motion kept.

use crate::common::natural::{misfitted, natural_walker};
use footfall_core::{Clip, Joint, ModelPose};
use footfall_motion::bvh::{BvhFile, BvhJoint, write};
use footfall_motion::corpus::Corpus;
use footfall_motion::retarget::{RetargetOptions, Retargeted, SkeletonFit, retarget};
use glam::{EulerRot, Quat, Vec3};
use std::fmt::Write as _;

/// Nods of the walker about the mean, degrees.
const NOD_DEG: f32 = 6.0;

/// Attitude in degrees down, to the left and towards the right shoulder.
fn attitude(degrees: Vec3) -> Quat {
    let [x, y, z] = degrees.map(f32::to_radians).to_array();
    Quat::from_euler(EulerRot::YXZ, y, x, z)
}

/// A walker who holds neck and head like this, on a skeleton that is not ours.
fn walker(neck: Vec3, head: Vec3) -> BvhFile {
    let mut clip = natural_walker(60.0, 500, 0.0);
    for (frame, pose) in clip.poses.iter_mut().enumerate() {
        let nod = Vec3::X * NOD_DEG * (frame as f32 * 0.07).sin();
        pose.rotations[Joint::Neck.index()] = attitude(neck);
        pose.rotations[Joint::Head.index()] = attitude(neck).inverse() * attitude(head + nod);
    }
    misfitted(&clip, Vec3::new(0.0, -0.018, 0.045))
}

/// The same of the CMU library's family.
fn fitted(neck: Vec3, head: Vec3) -> BvhFile {
    let mut file = walker(neck, head);
    for name in ["LHipJoint", "RHipJoint"] {
        file.joints.push(BvhJoint {
            name: name.to_owned(),
            parent: Some(0),
            offset: Vec3::ZERO,
            channels: Vec::new(),
            end_sites: vec![Vec3::NEG_Y],
        });
    }
    file
}

fn read(file: &BvhFile, fit: SkeletonFit) -> Retargeted {
    let options = RetargetOptions {
        fit,
        ..RetargetOptions::default()
    };
    retarget(file, &options).expect("a body that can be placed")
}

/// Turn of a joint in every frame; the walker goes along +Z.
fn turns(clip: &Clip, joint: Joint) -> Vec<Quat> {
    let poses = clip.poses.iter();
    poses
        .map(|pose| ModelPose::of(&clip.skeleton, pose).rotation(joint))
        .collect()
}

/// Mean attitude of neck and face, degrees.
fn carriage(clip: &Clip) -> [Vec3; 2] {
    [Joint::Neck, Joint::Head].map(|joint| {
        let sum: Vec3 = turns(clip, joint)
            .iter()
            .map(|turn| {
                let (y, x, z) = turn.to_euler(EulerRot::YXZ);
                Vec3::new(x, y, z).map(f32::to_degrees)
            })
            .sum();
        sum / clip.poses.len() as f32
    })
}

/// The usual error of the family, and a turn and a tilt on top of it.
const NECK: Vec3 = Vec3::new(-13.0, 0.0, 13.0);
const FACE: Vec3 = Vec3::new(17.0, -9.0, 2.0);

#[test]
fn the_usual_error_is_taken_away_and_every_nod_stays() {
    let file = fitted(NECK, FACE);
    let recorded = read(&file, SkeletonFit::AsRecorded);
    assert_eq!(recorded.report.fit.head, None);
    let [neck, face] = carriage(&recorded.clip);
    assert!(neck.abs_diff_eq(NECK, 1.0) && face.abs_diff_eq(FACE, 1.0));
    let corrected = read(&file, SkeletonFit::FromRecording);
    let [neck, face] = carriage(&corrected.clip);
    assert!(neck.abs_diff_eq(Vec3::new(4.5, 0.0, 0.0), 3.0), "{neck}");
    assert!(face.abs_diff_eq(Vec3::new(5.0, 0.0, 0.0), 2.0), "{face}");
    for joint in [Joint::Neck, Joint::Head] {
        let [before, after] = [&recorded, &corrected].map(|read| turns(&read.clip, joint));
        // What is turned in the joint's own axes is turned by the same in every frame.
        let turn = before[0].inverse() * after[0];
        for (frame, (before, after)) in before.iter().zip(&after).enumerate() {
            let off = (before.inverse() * *after).angle_between(turn).to_degrees();
            assert!(off < 0.1, "{joint:?} in {frame}: {off} degrees");
        }
    }
}

#[test]
fn other_skeletons_keep_their_heads() {
    let read = read(&walker(NECK, FACE), SkeletonFit::FromRecording);
    assert_eq!(read.report.fit.head, None);
    let [neck, face] = carriage(&read.clip);
    assert!(neck.abs_diff_eq(NECK, 1.0) && face.abs_diff_eq(FACE, 1.0));
}

#[test]
fn a_lowered_face_is_a_manner_unless_it_is_labelled_as_plain() {
    let folder = tempfile::tempdir().unwrap();
    let mut index = "path,category,style,subject\n".to_owned();
    for (name, style, subject, face) in [
        ("plain", "neutral", "one", 40.0),
        ("sad", "sad", "one", 65.0),
        ("alone", "sad", "two", 40.0),
    ] {
        std::fs::write(
            folder.path().join(format!("{name}.bvh")),
            write(&fitted(NECK, Vec3::X * face)),
        )
        .unwrap();
        writeln!(index, "{name}.bvh,walk,{style},{subject}").unwrap();
    }
    let path = folder.path().join("index.csv");
    std::fs::write(&path, index).unwrap();
    let corpus = Corpus::read(&path, &[]).unwrap();
    let faces: Vec<f32> = corpus
        .clips
        .iter()
        .map(|clip| carriage(clip.clip())[1].x)
        .collect();
    // What is plain is near to level; an act is as far from it as it was, and nothing is known of who only acts.
    assert!((5.0..12.0).contains(&faces[0]), "{faces:?}");
    assert!((faces[1] - faces[0] - 25.0).abs() < 1.0, "{faces:?}");
    assert!((faces[2] - 40.0).abs() < 1.0, "{faces:?}");
    // A file alone may show any manner.
    let unlabelled =
        carriage(&read(&fitted(NECK, Vec3::X * 40.0), SkeletonFit::FromRecording).clip)[1].x;
    assert!((15.0..25.0).contains(&unlabelled), "{unlabelled}");
}
