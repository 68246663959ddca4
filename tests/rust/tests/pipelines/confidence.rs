//! Low confidence in unknown motion, and a body that it never shakes.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use core::f32::consts::TAU;
use footfall_core::{Behaviour, Joint, Pose};
use footfall_imu::{GRAVITY_MPS2, ImuSample, csv};
use footfall_model::ImuModel;
use footfall_recon::{Prepared, ReconConfig, Reconstructor};
use footfall_tests::data::repository;
use glam::Vec3;
use std::sync::Arc;

const DT_SECS: f32 = 0.01;

fn reconstructor() -> Reconstructor {
    let path = repository().join("addons/footfall/models/right_foot.footimu");
    let model = Arc::new(ImuModel::from_bytes(&std::fs::read(path).unwrap()).unwrap());
    let prepared = Arc::new(Prepared::new(model).unwrap());
    let body = prepared.model().skeleton.clone();
    Reconstructor::new(&prepared, &body, &ReconConfig::default()).unwrap()
}

/// Samples between poses that are compared: a frame of the model.
const APART: u32 = 4;

/// Fastest turn of a joint between two such poses, rad/s.
fn fastest_radps(before: &Pose, after: &Pose) -> f32 {
    let turns = Joint::ALL
        .into_iter()
        .map(|joint| before.rotation(joint).angle_between(after.rotation(joint)));
    turns.fold(0.0, f32::max) / (APART as f32 * DT_SECS)
}

/// A shaken sensor, without the rhythm of legs.
fn shaken(time_secs: f64, seed: f32) -> ImuSample {
    let time = time_secs as f32;
    let wave = |n: f32| {
        let hertz = 1.7 + (n * 1.37 + seed).sin().abs() * 3.0;
        (TAU * hertz * time + n * 2.1 + seed).sin() + (TAU * 1.6 * hertz * time + n).cos()
    };
    ImuSample {
        time_secs,
        force: Vec3::Y * GRAVITY_MPS2 + 7.0 * Vec3::new(wave(0.0), wave(1.0), wave(2.0)),
        rate: 5.0 * Vec3::new(wave(3.0), wave(4.0), wave(5.0)),
    }
}

#[test]
fn a_walk_is_explained() {
    let mut body = reconstructor();
    assert!(body.confidence() <= 0.0, "nothing is heard yet");
    let recording = csv::read(&repository().join("tests/data/walker_1_slow.right_foot.csv"));
    let mut pose = Pose::default();
    for sample in &recording.unwrap().samples {
        body.push(0, *sample);
        body.step(DT_SECS, &mut pose);
    }
    assert!(body.confidence() > 0.6, "{}", body.confidence());
    // No more samples come.
    for _ in 0..100 {
        body.step(DT_SECS, &mut pose);
    }
    assert!(body.confidence() <= 0.0);
}

#[test]
fn a_shaken_sensor_is_not_explained_and_the_body_stands() {
    for seed in [0.0, 1.0, 2.0, 3.0] {
        let mut body = reconstructor();
        let (mut before, mut pose) = (Pose::default(), Pose::default());
        for n in 0..1000 {
            body.push(0, shaken(f64::from(n) * f64::from(DT_SECS), seed));
            body.step(DT_SECS, &mut pose);
            let (_, heading) = body.split(&mut pose);
            assert!(heading.is_finite());
            // A second is enough to find it out.
            if n > 150 {
                assert!(body.confidence() < 0.1, "{seed}: {}", body.confidence());
                assert_eq!(body.behaviour(), Behaviour::Stand, "{seed}");
            }
            if n % APART == 0 {
                // Knees of people who walk turn by up to 7 rad/s.
                let fastest = fastest_radps(&before, &pose);
                assert!(n < 150 || fastest < 3.0, "{seed}, {n}: {fastest} rad/s");
                before.clone_from(&pose);
            }
        }
    }
}
