//! Two sensors drive one body, and need not begin together.

use footfall_core::{ModelPose, Pose, Site, forward_kinematics};
use footfall_imu::{ImuRecording, ImuSample};
use footfall_model::{GaitModel, Provenance};
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{Prepared, ReconConfig, Reconstructor};
use footfall_synth::{WalkConfig, synthesize};
use footfall_tests::data::repository;
use footfall_train::imu::{Chain, ImuClip, ImuTrainConfig, observe, train_imu};
use std::sync::Arc;

const SITES: [Site; 2] = [Site::RightFoot, Site::RightHand];
const RATE_HZ: f64 = 100.0;

fn clip(gait: &Arc<GaitModel>, seed: u64, speed: f32) -> footfall_core::Clip {
    let config = WalkConfig {
        steps: 24,
        seed,
        variation: 1.0,
        speed_mps: Some(speed),
        turn_rate_radps: 0.0,
        frame_rate_hz: Some(60.0),
        from_standing: false,
    };
    synthesize(gait, &gait.skeleton, &config).unwrap().clip
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
        let mut model = ModelPose::default();
        forward_kinematics(skeleton, &pose, &mut model);
        joints.push(model);
    }
    joints
}

#[test]
fn a_sensor_that_begins_later_catches_up_with_the_other() {
    let bytes = std::fs::read(repository().join("tests/model_versions/v1.footfall")).unwrap();
    let gait = Arc::new(GaitModel::from_bytes(&bytes).unwrap());
    let config = ImuTrainConfig::new(&SITES);
    let mut chains: Vec<Chain> = Vec::new();
    for seed in 0..8 {
        let clip = clip(&gait, seed, 0.9 + 0.08 * seed as f32);
        chains.extend(observe(
            &ImuClip {
                subject: &seed.to_string(),
                clip: &clip,
                first_frame: 0,
                recordings: &[],
            },
            &config,
        ));
    }
    let all: Vec<&Chain> = chains.iter().collect();
    let model = train_imu(&all, &config, Provenance::default()).unwrap();
    let prepared = Arc::new(Prepared::new(Arc::new(model)).unwrap());
    let unseen = clip(&gait, 99, 1.17);
    let recordings =
        SITES.map(|site| simulate(&unseen, 0, site, &VirtualImuConfig::ideal(RATE_HZ)));

    let together = driven(&prepared, &recordings, 0, 0.0);
    // 3.47 s later, not in the middle of frames; and again on a clock that is an hour ahead.
    for clock_secs in [0.0, 3600.0] {
        let apart = driven(&prepared, &recordings, 347, clock_secs);
        let from = 347 + 200;
        let mut worst = 0.0_f32;
        let mut sum = 0.0;
        for (together, apart) in together[from..].iter().zip(&apart[from..]) {
            for (a, b) in together.positions.iter().zip(&apart.positions) {
                worst = worst.max(a.distance(*b));
                sum += a.distance(*b);
            }
        }
        let count = (together.len() - from) * together[0].positions.len();
        let mean = sum / count as f32;
        let most = if clock_secs == 0.0 { 0.01 } else { 0.05 };
        assert!(
            mean < most,
            "{mean} m apart on average, {worst} m at worst, clock {clock_secs}"
        );
    }
}
