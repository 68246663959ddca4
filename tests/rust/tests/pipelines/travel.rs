//! A body goes as far as the wearer of a foot's sensor.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use footfall_core::{Clip, ModelPose, Pose, Side, Site, forward_kinematics};
use footfall_imu::ImuRecording;
use footfall_model::GaitModel;
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{Prepared, ReconConfig, Reconstructor, reconstruct_recording};
use footfall_tests::walkers::{self, recorded};
use glam::Vec3;
use std::sync::Arc;

const RATE_HZ: f64 = 100.0;

fn gait() -> Arc<GaitModel> {
    walkers::model("tests/model_versions/v1.footfall")
}

/// A model of one walker's body, made from walks of these speeds.
fn prepare(gait: &Arc<GaitModel>, site: Site) -> Arc<Prepared> {
    let walks: Vec<Clip> = (0..8)
        .map(|seed| recorded(gait, &gait.skeleton, seed, 0.9 + 0.05 * seed as f32))
        .collect();
    walkers::sensor_model(&walks, &[site])
}

/// Measurements of a wearer who takes longer steps than anybody in the model, and the distance that this one has gone after four seconds, metres.
fn wearer(gait: &Arc<GaitModel>, site: Site) -> (ImuRecording, f32) {
    let tall = gait.skeleton.scaled(1.2);
    let clip = recorded(gait, &tall, 99, 1.5);
    let recording = simulate(&clip, 0, site, &VirtualImuConfig::ideal(RATE_HZ));
    (recording, way_m(clip.poses.iter(), 60))
}

fn way_m<'a>(mut poses: impl DoubleEndedIterator<Item = &'a Pose>, rate: usize) -> f32 {
    let first = poses.nth(4 * rate).unwrap().root_position;
    let last = poses.next_back().unwrap().root_position;
    (last - first).with_y(0.0).length()
}

#[test]
fn a_body_goes_as_far_as_the_wearer() {
    let gait = gait();
    let prepared = prepare(&gait, Site::RightFoot);
    let (recording, true_m) = wearer(&gait, Site::RightFoot);
    let skeleton = prepared.model().skeleton.clone();
    let config = ReconConfig::default();
    for live in [true, false] {
        let recordings = [recording.clone()];
        let made = reconstruct_recording(&prepared, &recordings, &skeleton, &config, live).unwrap();
        let own_m = way_m(made.clip.poses.iter(), 30);
        let off = own_m / true_m - 1.0;
        assert!(
            off.abs() < 0.05,
            "{own_m:.2} m of {true_m:.2} m, live {live}"
        );
    }
}

#[test]
fn a_thigh_knows_no_strides() {
    let gait = gait();
    let prepared = prepare(&gait, Site::RightThigh);
    let (recording, true_m) = wearer(&gait, Site::RightThigh);
    let skeleton = prepared.model().skeleton.clone();
    let made = reconstruct_recording(
        &prepared,
        &[recording],
        &skeleton,
        &ReconConfig::default(),
        true,
    )
    .unwrap();
    let own_m = way_m(made.clip.poses.iter(), 30);
    // The steps are those of the people in the model, who are smaller and slower: the test above can fail.
    assert!(own_m < 0.9 * true_m, "{own_m:.2} m of {true_m:.2} m");
}

#[test]
fn longer_steps_do_not_slide() {
    let gait = gait();
    let prepared = prepare(&gait, Site::RightFoot);
    let (recording, _) = wearer(&gait, Site::RightFoot);
    let skeleton = prepared.model().skeleton.clone();
    let mut body = Reconstructor::new(&prepared, &skeleton, &ReconConfig::default()).unwrap();
    let (mut pose, mut model) = (Pose::default(), ModelPose::default());
    let mut before: [Option<Vec3>; 2] = [None; 2];
    let (mut slid_m, mut stood) = (0.0_f32, 0);
    for (n, sample) in recording.samples.iter().enumerate() {
        body.push(0, *sample);
        body.step((1.0 / RATE_HZ) as f32, &mut pose);
        forward_kinematics(&skeleton, &pose, &mut model);
        let stands = body.stands();
        for side in Side::BOTH {
            let toes = model.position(side.toes());
            let last = before[side.index()].replace(toes);
            // A foot that has stood for a while, not one that is just put down.
            if let Some(last) = last.filter(|_| n > 400 && stands[side.index()] && toes.y < 0.03) {
                slid_m += (toes - last).with_y(0.0).length();
                stood += 1;
            }
        }
    }
    let mps = f64::from(slid_m) * RATE_HZ / f64::from(stood);
    assert!(stood > 300 && mps < 0.1, "{mps:.3} m/s in {stood} frames");
}
