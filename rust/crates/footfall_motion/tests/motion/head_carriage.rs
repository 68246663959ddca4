//! Necks and faces of skeletons that were fitted to markers: levelled person by person, their motion kept.

use crate::common::natural::{misfitted, natural_walker};
use footfall_core::{Clip, Joint, ModelPose};
use footfall_motion::bvh::{BvhFile, BvhJoint, write};
use footfall_motion::corpus::Corpus;
use footfall_motion::retarget::{RetargetOptions, Retargeted, SkeletonFit, retarget};
use glam::{Quat, Vec3};
use std::fmt::Write as _;

/// Nods of the walker about the mean, degrees.
const NOD_DEG: f32 = 6.0;

/// A walker with the neck forwards and the face down by these degrees, on a skeleton that is not ours.
fn walker(neck_deg: f32, head_deg: f32) -> BvhFile {
    let turn = |degrees: f32| Quat::from_rotation_x(degrees.to_radians());
    let mut clip = natural_walker(60.0, 500, 0.0);
    for (frame, pose) in clip.poses.iter_mut().enumerate() {
        let nod = NOD_DEG * (frame as f32 * 0.07).sin();
        pose.rotations[Joint::Neck.index()] = turn(neck_deg);
        pose.rotations[Joint::Head.index()] = turn(head_deg + nod - neck_deg);
    }
    misfitted(&clip, Vec3::new(0.0, -0.018, 0.045))
}

/// The same of the CMU library's family.
fn fitted(neck_deg: f32, head_deg: f32) -> BvhFile {
    let mut file = walker(neck_deg, head_deg);
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

/// Pitch of a joint in every frame, degrees forwards and down.
fn pitches(clip: &Clip, joint: Joint) -> Vec<f32> {
    let pitch = |pose| {
        let forward = ModelPose::of(&clip.skeleton, pose).rotation(joint) * Vec3::Z;
        -forward.y.asin().to_degrees()
    };
    clip.poses.iter().map(pitch).collect()
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

/// Mean pitch of neck and face.
fn carriage(clip: &Clip) -> [f32; 2] {
    [Joint::Neck, Joint::Head].map(|joint| mean(&pitches(clip, joint)))
}

#[test]
fn the_usual_error_is_taken_away_and_every_nod_stays() {
    let file = fitted(-13.0, 17.0);
    let recorded = read(&file, SkeletonFit::AsRecorded);
    assert_eq!(recorded.report.fit.head, None);
    let [neck, face] = carriage(&recorded.clip);
    assert!((neck + 13.0).abs() < 1.0 && (face - 17.0).abs() < 1.0);
    let corrected = read(&file, SkeletonFit::FromRecording);
    let [neck, face] = carriage(&corrected.clip);
    assert!((2.0..7.0).contains(&neck), "the neck is {neck} forwards");
    assert!((3.0..7.0).contains(&face), "the face is {face} down");
    for joint in [Joint::Neck, Joint::Head] {
        let [before, after] = [&recorded, &corrected].map(|read| pitches(&read.clip, joint));
        let turned = mean(&after) - mean(&before);
        for (frame, (before, after)) in before.iter().zip(&after).enumerate() {
            let off = after - before - turned;
            assert!(off.abs() < 0.05, "{joint:?} in {frame}: {off} degrees");
        }
    }
}

#[test]
fn other_skeletons_keep_their_heads() {
    let file = walker(-13.0, 17.0);
    let read = read(&file, SkeletonFit::FromRecording);
    assert_eq!(read.report.fit.head, None);
    let [neck, face] = carriage(&read.clip);
    assert!((neck + 13.0).abs() < 1.0 && (face - 17.0).abs() < 1.0);
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
            write(&fitted(-13.0, face)),
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
        .map(|clip| carriage(clip.clip())[1])
        .collect();
    // What is plain is near to level; an act is as far from it as it was, and nothing is known of who only acts.
    assert!((5.0..12.0).contains(&faces[0]), "{faces:?}");
    assert!((faces[1] - faces[0] - 25.0).abs() < 1.0, "{faces:?}");
    assert!((faces[2] - 40.0).abs() < 1.0, "{faces:?}");
    // A file alone may show any manner.
    let unlabelled = carriage(&read(&fitted(-13.0, 40.0), SkeletonFit::FromRecording).clip)[1];
    assert!((15.0..25.0).contains(&unlabelled), "{unlabelled}");
}
