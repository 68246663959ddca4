//! Sensors worn on the other side, upside down, turned, or exchanged.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use footfall_core::{Pose, Site};
use footfall_imu::ImuRecording;
use footfall_model::ImuModel;
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{Prepared, ReconConfig, Reconstructor, SensorProblem, TrackerConfig, examine};
use footfall_tests::data::{recordings, repository};
use footfall_tests::{real_feet, walkers};
use glam::Quat;
use std::sync::Arc;

fn shipped(site: &str) -> Arc<Prepared> {
    let path = repository().join(format!("addons/footfall/models/{site}.footimu"));
    let model = ImuModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    Arc::new(Prepared::new(Arc::new(model)).unwrap())
}

/// A walk measured at a site by an ideal sensor, mounted so.
fn walk(site: Site, seed: u64, mounting: Quat) -> ImuRecording {
    let gait = walkers::model("addons/footfall/models/locomotion.footfall");
    let clip = walkers::recorded(&gait, &gait.skeleton, seed, 1.2);
    let config = VirtualImuConfig {
        mounting,
        ..VirtualImuConfig::ideal(100.0)
    };
    simulate(&clip, 0, site, &config)
}

fn finding(
    prepared: &Arc<Prepared>,
    recording: &ImuRecording,
    believed: Option<Quat>,
) -> Option<SensorProblem> {
    let config = TrackerConfig::default();
    examine(prepared, 0, recording, believed, &config)
        .unwrap()
        .finding
}

const OTHER_FOOT: SensorProblem = SensorProblem::OtherSide {
    site: Site::RightFoot,
    worn: Site::LeftFoot,
};

#[test]
fn the_other_foot_and_the_other_pocket_are_told() {
    let anyhow = Quat::from_rotation_z(2.0) * Quat::from_rotation_x(1.0);
    let foot = shipped("right_foot");
    let thigh = shipped("right_thigh");
    let of = |prepared: &Arc<Prepared>, site: Site, seed: u64| {
        finding(prepared, &walk(site, seed, anyhow), None)
    };
    for seed in 1..5 {
        assert_eq!(of(&foot, Site::RightFoot, seed), None, "{seed}");
        assert_eq!(of(&thigh, Site::RightThigh, seed), None, "{seed}");
        let other = of(&thigh, Site::LeftThigh, seed).unwrap();
        assert!(other.to_string().contains("left thigh"), "{seed}: {other}");
    }
    let found: Vec<SensorProblem> = (1..13)
        .filter_map(|seed| of(&foot, Site::LeftFoot, seed))
        .collect();
    assert!(
        found.iter().all(|problem| *problem == OTHER_FOOT),
        "{found:?}"
    );
    // Two of them walk so nearly alike with both feet that the sensor's foot is left open.
    assert!(found.len() >= 10, "{} of 12", found.len());
}

/// Subject 4 is not among them: both recordings of that person seem to have left and right exchanged.
#[test]
fn real_feet_are_told_from_each_other() {
    let Some(data) = recordings("worn") else {
        return;
    };
    let prepared = shipped("right_foot");
    for person in [1, 2, 3, 5, 6, 7, 8] {
        let of = |foot: &str| finding(&prepared, &real_feet::ipol(&data, person, 1, foot), None);
        assert_eq!(of("rf"), None, "{person}");
        assert_eq!(of("lf"), Some(OTHER_FOOT), "{person}");
    }
}

#[test]
fn a_sensor_that_is_not_as_it_was_calibrated_is_told_by_its_angle() {
    let prepared = shipped("right_foot");
    let recording = walk(Site::RightFoot, 2, Quat::IDENTITY);
    assert_eq!(finding(&prepared, &recording, Some(Quat::IDENTITY)), None);
    let slipped = Quat::from_rotation_y(0.3);
    assert_eq!(
        finding(&prepared, &recording, Some(slipped)),
        None,
        "a little"
    );
    let upside_down = Quat::from_rotation_z(core::f32::consts::PI);
    match finding(&prepared, &recording, Some(upside_down)) {
        Some(SensorProblem::Turned { degrees }) => assert!(degrees > 165.0, "{degrees}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn upside_down_is_a_mounting_like_any_other() {
    let prepared = shipped("right_foot");
    for worn in [
        Quat::from_rotation_z(core::f32::consts::PI),
        Quat::from_rotation_x(core::f32::consts::PI),
    ] {
        let recording = walk(Site::RightFoot, 3, worn);
        let config = TrackerConfig::default();
        let found = examine(&prepared, 0, &recording, None, &config).unwrap();
        let error =
            (found.mounting.site_from_sensor * worn.inverse()).angle_between(Quat::IDENTITY);
        assert!(error < 0.35, "{error}");
        assert!(found.mounting.certainty > 0.9);
    }
}

#[test]
fn a_finding_is_told_until_the_mounting_is_set() {
    let prepared = shipped("right_foot");
    let skeleton = prepared.model().skeleton.clone();
    let mut body = Reconstructor::new(&prepared, &skeleton, &ReconConfig::default()).unwrap();
    body.set_finding(0, Some(OTHER_FOOT));
    assert_eq!(body.problem(0), Some(OTHER_FOOT));
    body.set_mounting(0, Quat::IDENTITY);
    assert_eq!(body.problem(0), None);
    // Until a mounting is known, the wearer stands, whatever is measured.
    body.forget_mounting(0);
    let mut pose = Pose::default();
    for sample in &walk(Site::RightFoot, 2, Quat::IDENTITY).samples {
        body.push(0, *sample);
        body.step(0.01, &mut pose);
    }
    let (place, _) = body.split(&mut pose);
    assert!(place.length() < 0.2, "{place}");
}
