//! Two sensors drive one body, and need not begin together.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use footfall_core::{Clip, ModelPose, Pose, Site};
use footfall_imu::{ImuRecording, ImuSample};
use footfall_model::GaitModel;
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{
    Prepared, ReconConfig, Reconstructor, SensorProblem, TrackerConfig, find_exchange,
    reconstruct_recording,
};
use footfall_tests::walkers;
use std::sync::Arc;

const SITES: [Site; 2] = [Site::RightFoot, Site::RightHand];
const RATE_HZ: f64 = 100.0;

fn clip(gait: &Arc<GaitModel>, seed: u64, speed: f32) -> Clip {
    walkers::recorded(gait, &gait.skeleton, seed, speed)
}

/// Joints above the hips' place, every hundredth of a second, while sensors are heard whose second begins later, on its own clock or not.
fn driven(
    prepared: &Arc<Prepared>,
    recordings: &[ImuRecording; 2],
    later: usize,
    clock_secs: f64,
) -> Vec<ModelPose> {
    let skeleton = &prepared.model().skeleton;
    let mut body = Reconstructor::new(prepared, skeleton, &ReconConfig::default()).unwrap();
    let mut pose = Pose::default();
    let mut joints = Vec::new();
    for n in 0..recordings[0].samples.len() {
        body.push(0, recordings[0].samples[n]);
        if n >= later {
            let sample = recordings[1].samples[n];
            body.push(
                1,
                ImuSample {
                    time_secs: sample.time_secs + clock_secs,
                    ..sample
                },
            );
        }
        body.step((1.0 / RATE_HZ) as f32, &mut pose);
        body.split(&mut pose);
        let model = ModelPose::of(skeleton, &pose);
        joints.push(model);
    }
    joints
}

/// A model of both sites, and what sensors measure of a walk that it has not seen.
fn prepare() -> (Arc<Prepared>, [ImuRecording; 2]) {
    let gait = walkers::model("tests/model_versions/v1.footfall");
    let walks: Vec<Clip> = (0..8)
        .map(|seed| clip(&gait, seed, 0.9 + 0.08 * seed as f32))
        .collect();
    let prepared = walkers::sensor_model(&walks, &SITES);
    let unseen = clip(&gait, 99, 1.17);
    let recordings =
        SITES.map(|site| simulate(&unseen, 0, site, &VirtualImuConfig::ideal(RATE_HZ)));
    (prepared, recordings)
}

/// Mean and longest distance between joints, metres.
fn apart_m(a: &[ModelPose], b: &[ModelPose]) -> (f32, f32) {
    let (mut sum, mut worst, mut count) = (0.0, 0.0_f32, 0);
    for (a, b) in a.iter().zip(b) {
        for (a, b) in a.positions.iter().zip(&b.positions) {
            sum += a.distance(*b);
            worst = worst.max(a.distance(*b));
            count += 1;
        }
    }
    (sum / count as f32, worst)
}

#[test]
fn a_sensor_that_begins_later_catches_up_with_the_other() {
    let (prepared, recordings) = prepare();
    let together = driven(&prepared, &recordings, 0, 0.0);
    // 3.47 s later, not in the middle of frames; and again on a clock that is an hour ahead, whose offset is known to half a frame: feet that are planted
    // half a frame earlier carry the body some centimetres farther.
    for (clock_secs, most) in [(0.0, 0.01), (3600.0, 0.07)] {
        let apart = driven(&prepared, &recordings, 347, clock_secs);
        let (mean, worst) = apart_m(&together[547..], &apart[547..]);
        assert!(
            mean < most,
            "{mean} m apart on average, {worst} m at worst, clock {clock_secs}"
        );
    }
}

#[test]
fn recordings_on_one_clock_are_laid_side_by_side() {
    let (prepared, recordings) = prepare();
    let joints = |recordings: &[ImuRecording; 2]| -> Vec<ModelPose> {
        let skeleton = &prepared.model().skeleton;
        let config = ReconConfig::default();
        let made = reconstruct_recording(&prepared, recordings, skeleton, &config, true).unwrap();
        assert!((made.start_secs - recordings[0].start_secs()).abs() < 1e-9);
        let above_hips = |pose: &Pose| {
            let mut pose = pose.clone();
            pose.root_position = glam::Vec3::ZERO;
            pose.rotations[0] = glam::Quat::IDENTITY;
            ModelPose::of(skeleton, &pose)
        };
        made.clip.poses.iter().map(above_hips).collect()
    };
    let together = joints(&recordings);
    let [foot, hand] = &recordings;
    let later = ImuRecording {
        samples: hand.samples[347..].to_vec(),
    };
    let apart = joints(&[foot.clone(), later]);
    assert_eq!(together.len(), apart.len());
    let from = 547 * 30 / 100;
    let (mean, worst) = apart_m(&together[from..], &apart[from..]);
    assert!(mean < 0.01, "{mean} m apart on average, {worst} m at worst");
}

#[test]
fn exchanged_sensors_are_exchange_and_ordered_ones_are_not() {
    let (prepared, [foot, hand]) = prepare();
    let exchange =
        |recordings| find_exchange(&prepared, recordings, &TrackerConfig::default()).unwrap();
    assert_eq!(exchange([&foot, &hand]), None);
    let [first, second] = SITES;
    assert_eq!(
        exchange([&hand, &foot]),
        Some(SensorProblem::Exchanged { first, second })
    );
}
