//! Walkers that are worked out less finely: the same walk, for less.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::GaitModel;
use footfall_synth::{Controls, Detail, GaitGenerator, GeneratorConfig, StyleSpace};
use glam::Vec3;
use std::sync::{Arc, OnceLock};

const DT: f32 = 1.0 / 60.0;

const WALKING: Controls = Controls {
    speed_mps: 1.3,
    turn_rate_radps: 0.2,
    ..Controls::STAND
};

fn space() -> Arc<StyleSpace> {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    let make = || {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../../addons/footfall/models/locomotion.footfall"
        );
        let model = GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
        Arc::new(StyleSpace::new(&Arc::new(model), &[]).unwrap())
    };
    Arc::clone(SPACE.get_or_init(make))
}

fn walker(detail: Detail) -> GaitGenerator {
    let config = GeneratorConfig {
        seed: 3,
        phase: 0.0,
        variation: 1.0,
    };
    let mut walker = GaitGenerator::new(&space(), &[], &Skeleton::standard(), &config).unwrap();
    walker.set_detail(detail);
    walker
}

/// Positions of all joints, from where the walk began.
fn joints(walker: &GaitGenerator, pose: &Pose) -> Vec<Vec3> {
    let mut model = ModelPose::default();
    forward_kinematics(&Skeleton::standard(), pose, &mut model);
    let place = walker.start_from_character();
    let turn = footfall_core::rotation::from_heading(place.heading);
    let at = |joint: &Joint| place.position + turn * model.position(*joint);
    Joint::ALL.iter().map(at).collect()
}

#[test]
fn less_detail_is_the_same_walk() {
    let mut walkers = Detail::ALL.map(walker);
    let mut pose = Pose::default();
    let mut footsteps = [0; 3];
    let mut speeds = [0.0_f32; 3];
    for _ in 0..1200 {
        for (index, walker) in walkers.iter_mut().enumerate() {
            walker.step(DT, &WALKING, &mut pose);
            footsteps[index] += walker.footsteps().len();
            let hips = joints(walker, &pose)[0];
            assert!((0.8..1.05).contains(&hips.y), "hips at {} m", hips.y);
        }
    }
    for (index, walker) in walkers.iter().enumerate() {
        // The walk turns: its length is its radius times the angle.
        let place = walker.start_from_character();
        let angle = 20.0 * WALKING.turn_rate_radps;
        speeds[index] = place.position.length() / (2.0 * (0.5 * angle).sin().abs()) * angle / 20.0;
    }
    for index in 1..3 {
        assert!(
            footsteps[index].abs_diff(footsteps[0]) <= 2,
            "{footsteps:?}"
        );
        let ratio = speeds[index] / speeds[0];
        assert!((ratio - 1.0).abs() < 0.06, "{ratio} times as fast");
    }
}

/// Feet stand where they were put, and joints do not jump, at every detail and when it changes.
#[test]
fn feet_stand_and_nothing_jumps_at_any_detail() {
    for (detail, slip_limit) in [
        (Detail::Full, 0.005),
        (Detail::Half, 0.01),
        (Detail::Quarter, 0.04),
    ] {
        let mut walker = walker(Detail::Full);
        let mut pose = Pose::default();
        let mut before: Vec<(Vec<Vec3>, [bool; 2])> = Vec::new();
        let mut slips: Vec<f32> = Vec::new();
        for frame in 0..900 {
            if frame % 200 == 100 {
                walker.set_detail(detail);
            } else if frame % 200 == 0 {
                walker.set_detail(Detail::Full);
            }
            walker.step(DT, &WALKING, &mut pose);
            before.push((joints(&walker, &pose), walker.feet_in_contact()));
        }
        for triple in before.windows(3) {
            for joint in Joint::ALL {
                let at = |frame: usize| triple[frame].0[joint.index()];
                let jump = (at(0) - 2.0 * at(1) + at(2)).length();
                assert!(jump < 0.06, "{joint:?} jumps by {jump} m at {detail:?}");
            }
            for side in footfall_core::Side::BOTH {
                if triple.iter().all(|frame| frame.1[side.index()]) {
                    let ankle = |frame: usize| triple[frame].0[side.toes().index()];
                    slips.push(ankle(2).distance(ankle(0)) / (2.0 * DT));
                }
            }
        }
        slips.sort_by(f32::total_cmp);
        let median = slips[slips.len() / 2];
        assert!(median < slip_limit, "{detail:?}: {median} m/s");
    }
}
