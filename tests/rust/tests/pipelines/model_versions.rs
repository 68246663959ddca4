//! A model of every released format version still loads, and says where it comes from.

use footfall_core::{Pose, Site};
use footfall_model::file::read_header;
use footfall_model::{
    CalibratedSensor, DynamicsModel, FORMAT_VERSION, GaitModel, GaitStyle, ImuModel,
    ModelFileError, SensorCalibration, StepSpread, WalkModel,
};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall_tests::data::repository;
use glam::{Quat, Vec3};
use std::fs;
use std::sync::Arc;

fn bytes_of(version: u32) -> Vec<u8> {
    let path = repository().join(format!("tests/model_versions/v{version}.footfall"));
    fs::read(&path).unwrap_or_else(|error| {
        panic!(
            "{}: {error}; every format version needs a model here",
            path.display()
        )
    })
}

#[test]
fn every_version_loads() {
    for version in 1..=FORMAT_VERSION {
        let bytes = bytes_of(version);
        assert_eq!(read_header(&bytes).unwrap().0, version);
        let model = GaitModel::from_bytes(&bytes).unwrap();
        assert!(model.provenance.steps > 20, "{:?}", model.provenance);
        assert!(model.speed_range()[0] < model.speed_range()[1]);
        // What was read is written again without loss.
        let again = GaitModel::from_bytes(&model.to_bytes().unwrap()).unwrap();
        assert_eq!(again, model);
    }
}

/// Fine motion and chance follow from the saved state.
#[test]
fn a_walker_of_every_version_goes_on_from_its_state() {
    let config = GeneratorConfig {
        seed: 11,
        phase: 0.0,
        variation: 1.0,
    };
    let controls = Controls {
        speed_mps: 1.2,
        ..Controls::STAND
    };
    for version in 1..=FORMAT_VERSION {
        let model = Arc::new(GaitModel::from_bytes(&bytes_of(version)).unwrap());
        assert_eq!(model.fine.is_some(), version >= 3);
        let space = Arc::new(StyleSpace::new(&model, &[]).unwrap());
        let new = || GaitGenerator::new(&space, &[], &model.skeleton, &config).unwrap();
        let (mut walker, mut other) = (new(), new());
        let (mut pose, mut again) = (Pose::default(), Pose::default());
        for _ in 0..150 {
            walker.step(1.0 / 60.0, &controls, &mut pose);
        }
        other.restore(&walker.state()).unwrap();
        for _ in 0..200 {
            walker.step(1.0 / 60.0, &controls, &mut pose);
            other.step(1.0 / 60.0, &controls, &mut again);
            assert_eq!(pose, again, "version {version}");
        }
    }
}

#[test]
fn every_version_of_a_style_loads() {
    for version in 1..=2 {
        let path = repository().join(format!("tests/model_versions/v{version}.footstyle"));
        let bytes = fs::read(&path).unwrap();
        assert_eq!(read_header(&bytes).unwrap().0, version);
        let style = GaitStyle::from_bytes(&bytes).unwrap();
        assert_eq!(style.name, "sad");
        // What version 1 did not know is as the base has it.
        let is_default = style.step_spread == StepSpread::default();
        assert_eq!(is_default, version == 1);
        let again = GaitStyle::from_bytes(&style.to_bytes().unwrap()).unwrap();
        assert_eq!(again, style);
    }
}

#[test]
fn the_version_of_a_switching_model_loads() {
    let path = repository().join("tests/model_versions/v1.footdyn");
    let bytes = fs::read(&path).unwrap();
    assert_eq!(read_header(&bytes).unwrap().0, 1);
    let model = DynamicsModel::from_bytes(&bytes).unwrap();
    assert!(model.provenance.steps > 20, "{:?}", model.provenance);
    let again = DynamicsModel::from_bytes(&model.to_bytes().unwrap()).unwrap();
    assert_eq!(again, model);
    assert_eq!(again.fingerprint().unwrap(), model.fingerprint().unwrap());
    // The header identifies any model that walks.
    let dynamics = WalkModel::from_bytes(&bytes).unwrap();
    assert_eq!(dynamics, WalkModel::Dynamics(Arc::new(model.clone())));
    let gait = WalkModel::from_bytes(&bytes_of(1)).unwrap();
    assert!(matches!(gait, WalkModel::Gait(_)));
    // Nothing is assumed about stability, but what runs away within a segment is no gait.
    let mut wild = model;
    wild.regimes[0].system.transition *= 3.0;
    let error = wild.to_bytes().unwrap_err();
    assert!(error.to_string().contains("left foot"), "{error}");
}

#[test]
fn the_version_of_a_sensor_model_loads() {
    let path = repository().join("tests/model_versions/v1.footimu");
    let bytes = fs::read(&path).unwrap();
    assert_eq!(read_header(&bytes).unwrap().0, 1);
    let model = ImuModel::from_bytes(&bytes).unwrap();
    assert!(model.frame_count() > 100 && model.sites == [Site::RightFoot]);
    // Frames are stored in 16 bits: written again they may differ by a step of these.
    let again = ImuModel::from_bytes(&model.to_bytes().unwrap()).unwrap();
    let apart = again
        .body
        .iter()
        .zip(&model.body)
        .map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f32::max) < 1e-3);
    assert_eq!(again.segments, model.segments);
    // Every cut and every flipped bit is an error, never a panic.
    for length in (0..bytes.len()).step_by(37) {
        assert!(ImuModel::from_bytes(&bytes[..length]).is_err());
    }
    for place in (16..bytes.len()).step_by(101) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x10;
        assert!(ImuModel::from_bytes(&damaged).is_err());
    }
    let error = GaitModel::from_bytes(&bytes).unwrap_err().to_string();
    assert!(
        error.contains("'imu'") && error.contains("'gait'"),
        "{error}"
    );
    // What does not fit together is named.
    let mut wild = model;
    wild.segments[0].phase = 999;
    let error = wild.to_bytes().unwrap_err().to_string();
    assert!(error.contains("segment"), "{error}");
}

#[test]
fn a_newer_model_names_its_writer() {
    let mut bytes = bytes_of(FORMAT_VERSION);
    bytes[8..12].copy_from_slice(&(FORMAT_VERSION + 1).to_le_bytes());
    let error = GaitModel::from_bytes(&bytes).unwrap_err();
    assert!(matches!(error, ModelFileError::Newer { .. }), "{error}");
    let said = error.to_string();
    assert!(
        said.contains(env!("CARGO_PKG_VERSION")) && said.contains("update"),
        "{said}"
    );
}

#[test]
fn no_damage_goes_unnoticed_and_none_panics() {
    let bytes = bytes_of(FORMAT_VERSION);
    for length in (0..bytes.len()).step_by(bytes.len() / 97) {
        assert!(
            GaitModel::from_bytes(&bytes[..length]).is_err(),
            "cut after {length} bytes"
        );
    }
    for at in (0..bytes.len()).step_by(bytes.len() / 197) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x40;
        assert!(
            GaitModel::from_bytes(&damaged).is_err(),
            "byte {at} changed"
        );
    }
}

#[test]
fn the_version_of_a_calibration_loads() {
    let path = repository().join("tests/model_versions/v1.footcal");
    let bytes = fs::read(&path).unwrap();
    assert_eq!(read_header(&bytes).unwrap().0, 1);
    let foot = CalibratedSensor {
        certainty: 1.0,
        rate_bias: Vec3::new(0.01, -0.02, 0.005),
        gravity_mps2: 9.71,
        device: "/dev/ttyUSB0".to_owned(),
        ..CalibratedSensor::mounted(Site::RightFoot, Quat::from_xyzw(0.5, -0.5, 0.5, 0.5))
    };
    let kept = SensorCalibration {
        sensors: vec![foot],
        stride: 1.125,
    };
    assert_eq!(SensorCalibration::from_bytes(&bytes), Ok(kept));
}
