//! Jumps and crouches that the model makes are learned from the recordings of them.

#![expect(clippy::unwrap_used, reason = "tests may fail")]

use footfall_core::rotation::exp_map;
use footfall_core::{Clip, Joint};
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, GaitModel};
use footfall_synth::{Controls, Move, StandConfig, synthesize_moves};
use footfall_tests::data::repository;
use footfall_train::crouching::LearnedCrouching;
use footfall_train::{crouching, jumping};
use glam::{DVec3, Quat};
use std::sync::Arc;

fn model() -> Arc<GaitModel> {
    let path = repository().join("tests/model_versions/v6.footfall");
    Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap())
}

fn clip(moves: &[Move], seconds: f64) -> Clip {
    let model = model();
    let config = StandConfig {
        seconds,
        seed: 3,
        variation: 1.0,
        motion: 0.5,
        frame_rate_hz: None,
    };
    let made = synthesize_moves(&model, &model.skeleton, moves, &config);
    made.unwrap().clip
}

fn row(time_secs: f64, speed_mps: f32, crouch: f32, jump_m: f32) -> Move {
    Move {
        time_secs,
        controls: Controls {
            speed_mps,
            crouch,
            ..Controls::STAND
        },
        jump_m,
    }
}

#[test]
fn jumps_of_known_height_are_learned() {
    let heights = [0.2, 0.3, 0.4, 0.45];
    let moves: Vec<Move> = (0_u8..)
        .zip(heights)
        .map(|(index, rise)| row(1.0 + 3.0 * f64::from(index), 0.0, 0.0, rise))
        .collect();
    let clip = clip(&moves, 13.0);
    let learned = jumping::learn(&[(&clip, 0)], None).expect("four jumps");
    assert_eq!(learned.jumps, heights.len());
    let leg = f64::from(clip.skeleton.mean_leg_length());
    let [least, _, most] = learned.model.rise.map(|rise| rise * leg);
    assert!((least - 0.2).abs() < 0.02, "{least}");
    assert!((most - 0.45).abs() < 0.03, "{most}");
    // They go nowhere, and knees that were bent most are bent as much in what is learned.
    assert!(learned.model.way[2].abs() < 0.02, "{:?}", learned.model.way);
    let [dip, push, ..] = &learned.model.phases;
    let lowest = dip.knots.last().unwrap()[0][FEATURE_COUNT] * leg;
    let apart = push.knots[0][0][FEATURE_COUNT] * leg - lowest;
    assert!((-0.4..-0.08).contains(&lowest), "hips {lowest} m lower");
    assert!(apart.abs() < 1e-9, "phases meet: {apart}");
}

#[test]
fn who_only_walks_teaches_nothing() {
    let clip = clip(&[row(0.5, 1.3, 0.0, 0.0)], 8.0);
    assert!(jumping::learn(&[(&clip, 0)], None).is_none());
    assert!(crouching::learn(&[(&clip, 0)], None).is_none());
}

/// A walk that is crouched for seven seconds.
fn crouched() -> Clip {
    let moves = [
        row(0.0, 0.0, 0.0, 0.0),
        row(2.0, 0.8, 1.0, 0.0),
        row(9.0, 0.0, 0.0, 0.0),
    ];
    clip(&moves, 12.0)
}

/// The crouch of a clip, for a model.
fn learned(model: &GaitModel, clip: &Clip) -> LearnedCrouching {
    crouching::learn(&[(clip, 0)], model.standing.as_ref()).expect("seven seconds")
}

#[test]
fn a_crouch_of_known_depth_is_learned() {
    let clip = crouched();
    let model = model();
    let learned = learned(&model, &clip);
    let known = &model.crouch.as_ref().expect("a crouch").beside;
    let found = &learned.model.beside;
    // Steps bend the knees on top of it.
    let depth = found[FEATURE_COUNT] / known[FEATURE_COUNT];
    assert!((0.9..1.5).contains(&depth), "{depth} of the depth");
    let at = footfall_model::layout::feature_offset(Joint::Spine);
    assert!(
        (found[at] / known[at] - depth).abs() < 0.35,
        "spine {} of {}",
        found[at],
        known[at]
    );
    assert!(learned.secs > 6.0 && learned.model.fastest > 0.4);
}

/// Whoever carries the arms in another way, standing and crouched alike, teaches the same trunk and other arms.
#[test]
fn crouched_arms_are_those_of_the_recording_whatever_the_model_stands_like() {
    let clip = crouched();
    let mut abducted = clip.clone();
    let arm = Joint::LeftUpperArm;
    let turn = Quat::from_rotation_z(0.4);
    for pose in &mut abducted.poses {
        let rotation = &mut pose.rotations[arm.index()];
        *rotation *= turn;
    }
    let model = model();
    let [plain, turned] = [&clip, &abducted].map(|clip| learned(&model, clip).model.beside);
    let rotation = |beside: &[f64], joint: Joint| {
        let at = feature_offset(joint);
        exp_map(DVec3::from_slice(&beside[at..at + 3]).as_vec3())
    };
    let gained = rotation(&plain, arm).inverse() * rotation(&turned, arm);
    assert!(gained.angle_between(turn) < 0.03, "{gained}");
    for joint in [Joint::RightUpperArm, Joint::Spine, Joint::Neck] {
        let gained = rotation(&plain, joint).angle_between(rotation(&turned, joint));
        assert!(gained < 1e-3, "{joint:?}: {gained}");
    }
}
