//! Comparison of the pipeline's output with that from when the goldens were made.

use footfall_core::{Joint, Pose, Side};
use footfall_model::GaitModel;
use footfall_motion::bvh;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_synth::{
    Controls, GaitGenerator, GeneratorConfig, StyleSpace, WalkConfig, synthesize,
};
use footfall_tests::data::{own_file, own_recordings, repository};
use footfall_tests::golden::assert_golden;
use std::sync::Arc;

fn model() -> Arc<GaitModel> {
    let bytes = std::fs::read(repository().join("tests/model_versions/v1.footfall"))
        .expect("the kept model");
    Arc::new(GaitModel::from_bytes(&bytes).expect("the kept model loads"))
}

/// Root position, then the quaternions of hips, one leg and one arm.
fn row(label: String, pose: &Pose) -> (String, Vec<f64>) {
    let mut values = pose.root_position.as_dvec3().to_array().to_vec();
    for joint in [
        Joint::Hips,
        Joint::LeftUpperLeg,
        Joint::LeftLowerLeg,
        Joint::LeftFoot,
        Joint::RightUpperArm,
    ] {
        let rotation = pose.rotation(joint);
        // q and -q are the same rotation.
        let shortest = if rotation.w < 0.0 {
            -rotation
        } else {
            rotation
        };
        values.extend(shortest.as_dquat().to_array());
    }
    (label, values)
}

/// Tolerance: 1 mm and about 0.1 degrees, far above what compilers differ by, far below what one sees.
const TOLERANCE: f64 = 1e-3;

#[test]
fn a_synthesised_walk() {
    let model = model();
    let config = WalkConfig {
        steps: 8,
        seed: 7,
        variation: 1.0,
        speed_mps: Some(1.3),
        turn_rate_radps: 0.2,
        direction_rad: 0.0,
        frame_rate_hz: None,
        from_standing: false,
        gait: footfall_synth::GaitChoice::Auto,
    };
    let walk = synthesize(&model, &model.skeleton, &config).unwrap();
    let rows: Vec<_> = walk
        .clip
        .poses
        .iter()
        .enumerate()
        .step_by(20)
        .map(|(frame, pose)| row(format!("frame {frame}"), pose))
        .collect();
    assert_golden("synthesised_walk", TOLERANCE, &rows);
}

#[test]
fn a_generated_walk() {
    let model = model();
    let config = GeneratorConfig {
        seed: 7,
        phase: 0.0,
        variation: 1.0,
    };
    let space = Arc::new(StyleSpace::new(&model, &[]).unwrap());
    let mut generator = GaitGenerator::new(&space, &[], &model.skeleton, &config).unwrap();
    let controls = Controls {
        speed_mps: 1.3,
        turn_rate_radps: 0.2,
        ..Controls::STAND
    };
    let mut pose = Pose::default();
    let mut rows = Vec::new();
    for frame in 0..240 {
        generator.step(1.0 / 60.0, &controls, &mut pose);
        if frame % 20 == 0 {
            let (label, mut values) = row(format!("frame {frame}"), &pose);
            let place = generator.start_from_character();
            values.extend(place.position.as_dvec3().to_array());
            values.push(f64::from(place.heading));
            rows.push((label, values));
        }
    }
    assert_golden("generated_walk", TOLERANCE, &rows);
}

#[test]
fn contacts_of_our_own_recordings() {
    let mut rows = Vec::new();
    for name in own_recordings() {
        let file = bvh::read(own_file(name)).unwrap();
        let retargeted = retarget(&file, &RetargetOptions::default()).unwrap();
        let config = ContactConfig::from_frame(retargeted.first_frame);
        let contacts = detect_contacts(&retargeted.clip, &config);
        for side in Side::BOTH {
            let frames = contacts
                .foot(side)
                .stances
                .iter()
                .flat_map(|stance| [stance.first as f64, stance.last as f64])
                .collect();
            rows.push((format!("{name} {}", side.name()), frames));
        }
    }
    // Whole frames: one off is a change.
    assert_golden("contacts", 0.5, &rows);
}
