//! Standing that lives: on planted feet, in no loop, by seed, and gone without a pop as a step begins.

mod contexts;

use footfall_core::rotation::from_heading;
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton};
use footfall_model::{FORMAT_VERSION, GaitModel, GaitStyle};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall_tests::data::repository;
use glam::Vec3;
use std::fs;
use std::sync::Arc;

const DT: f32 = 1.0 / 60.0;

fn config(seed: u64) -> GeneratorConfig {
    GeneratorConfig {
        seed,
        phase: 0.0,
        variation: 1.0,
    }
}

/// The model of a format version.
fn model(version: u32) -> Arc<GaitModel> {
    let path = repository().join(format!("tests/model_versions/v{version}.footfall"));
    let bytes = fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let model = GaitModel::from_bytes(&bytes);
    Arc::new(model.unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

/// A model that learned how people stand.
fn alive() -> Arc<StyleSpace> {
    let model = model(FORMAT_VERSION);
    assert!(model.standing.is_some());
    let space = StyleSpace::new(&model, &[]);
    Arc::new(space.unwrap_or_else(|error| panic!("{error}")))
}

fn walker(space: &Arc<StyleSpace>, seed: u64) -> GaitGenerator {
    let skeleton = Skeleton::standard();
    let generator = GaitGenerator::new(space, &[], &skeleton, &config(seed));
    generator.unwrap_or_else(|error| panic!("{error}"))
}

fn standing(space: &Arc<StyleSpace>, seed: u64) -> GaitGenerator {
    let mut generator = walker(space, seed);
    generator.stand();
    generator
}

/// Joints in the space where the walk began, after one more frame.
fn frame(generator: &mut GaitGenerator, controls: &Controls) -> (Pose, ModelPose) {
    let mut pose = Pose::default();
    generator.step(DT, controls, &mut pose);
    let mut placed = pose.clone();
    let place = generator.start_from_character();
    let turn = from_heading(place.heading);
    placed.root_position = turn * placed.root_position + place.position;
    placed.rotations[0] = turn * placed.rotations[0];
    let body = ModelPose::of(&Skeleton::standard(), &placed);
    (pose, body)
}

fn knees_deg(pose: &Pose) -> [f32; 2] {
    Side::BOTH.map(|side| {
        pose.rotation(side.lower_leg())
            .to_scaled_axis()
            .length()
            .to_degrees()
    })
}

#[test]
fn older_models_stand_still() {
    // Format 4 brought standing.
    for version in 1..4 {
        let space = Arc::new(StyleSpace::new(&model(version), &[]).unwrap());
        let mut generator = standing(&space, 2);
        let (first, _) = frame(&mut generator, &Controls::STAND);
        for _ in 0..300 {
            assert_eq!(
                frame(&mut generator, &Controls::STAND).0,
                first,
                "version {version}"
            );
        }
    }
    // So does a newer one of which no motion is asked.
    let mut generator = standing(&alive(), 2);
    generator.set_standing_motion(0.0);
    let (first, _) = frame(&mut generator, &Controls::STAND);
    for _ in 0..300 {
        assert_eq!(frame(&mut generator, &Controls::STAND).0, first);
    }
}

#[test]
fn a_standing_body_sways_on_planted_feet_and_straight_knees() {
    let space = alive();
    for seed in 1..=6 {
        let mut generator = standing(&space, seed);
        let (_, first) = frame(&mut generator, &Controls::STAND);
        let mut before = first.clone();
        let mut knees = Vec::new();
        let (mut farthest, mut fastest) = (0.0_f32, 0.0_f32);
        for _ in 0..60 * 60 {
            let (pose, body) = frame(&mut generator, &Controls::STAND);
            for side in Side::BOTH {
                for joint in [side.foot(), side.toes()] {
                    let slip = body.position(joint).distance(before.position(joint)) / DT;
                    assert!(slip < 0.005, "seed {seed}: {joint:?} at {slip} m/s");
                    let gone = body.position(joint).distance(first.position(joint));
                    assert!(gone < 0.002, "seed {seed}: {joint:?} by {gone} m");
                }
            }
            let hips = body.position(Joint::Hips);
            farthest = farthest.max(hips.distance(first.position(Joint::Hips)));
            fastest = fastest.max(hips.distance(before.position(Joint::Hips)) / DT);
            knees.extend(knees_deg(&pose));
            before = body;
        }
        assert!(
            (0.008..0.25).contains(&farthest),
            "seed {seed}: hips by {farthest} m"
        );
        assert!(fastest < 0.15, "seed {seed}: hips at {fastest} m/s");
        knees.sort_by(f32::total_cmp);
        let [low, high] = [knees.len() / 10, knees.len() * 9 / 10].map(|at| knees[at]);
        assert!(
            low > 1.0 && high <= 10.0,
            "seed {seed}: knees {low} to {high}°"
        );
    }
}

#[test]
fn seeds_differ_and_each_repeats_itself_bit_for_bit() {
    let space = alive();
    let [mut one, mut same, mut other] = [3, 3, 4].map(|seed| standing(&space, seed));
    let mut apart = 0.0_f32;
    for _ in 0..1200 {
        let (pose, body) = frame(&mut one, &Controls::STAND);
        assert_eq!(frame(&mut same, &Controls::STAND).0, pose);
        let (_, elsewhere) = frame(&mut other, &Controls::STAND);
        let head = |body: &ModelPose| body.position(Joint::Head);
        apart = apart.max(head(&body).distance(head(&elsewhere)));
    }
    assert!(apart > 0.02, "{apart}");
}

#[test]
fn no_loop_shows() {
    let space = alive();
    let mut generator = standing(&space, 9);
    let path: Vec<Vec3> = (0..10 * 240)
        .map(|_| {
            // Ten frames a second are enough to know it by.
            for _ in 0..5 {
                frame(&mut generator, &Controls::STAND);
            }
            frame(&mut generator, &Controls::STAND)
                .1
                .position(Joint::Head)
        })
        .collect();
    let mean = path.iter().sum::<Vec3>() / path.len() as f32;
    let around: Vec<Vec3> = path.iter().map(|place| *place - mean).collect();
    let like = |lag: usize| {
        let pairs = || around.iter().zip(&around[lag..]);
        let together: f32 = pairs().map(|(a, b)| a.dot(*b)).sum();
        let [first, second]: [f32; 2] = [
            pairs().map(|(a, _)| a.length_squared()).sum(),
            pairs().map(|(_, b)| b.length_squared()).sum(),
        ];
        together / (first * second).sqrt()
    };
    assert!(like(1) > 0.9);
    let most = (200..1800).map(like).fold(0.0, f32::max);
    assert!(
        most < 0.75,
        "after 20 s and more it is like itself by {most}"
    );
}

#[test]
fn a_state_goes_on_from_any_moment_bit_for_bit() {
    let space = alive();
    let walking = Controls {
        speed_mps: 1.2,
        ..Controls::STAND
    };
    // As it comes to rest, at rest, and as the life dies away in a first step.
    for (stop, save) in [(60, 200), (60, 700), (0, 320)] {
        let mut generator = walker(&space, 5);
        let controls = |n: usize| {
            if (stop..300).contains(&n) || n > 500 {
                Controls::STAND
            } else {
                walking
            }
        };
        for n in 0..save {
            frame(&mut generator, &controls(n));
        }
        let mut other = walker(&space, 77);
        other.restore(&generator.state()).unwrap();
        for n in save..save + 400 {
            let (pose, _) = frame(&mut generator, &controls(n));
            assert_eq!(
                frame(&mut other, &controls(n)).0,
                pose,
                "frame {n} after {save}"
            );
        }
    }
}

#[test]
fn a_state_of_the_version_before_goes_on_from_a_still_pose() {
    let space = alive();
    let mut generator = standing(&space, 5);
    generator.set_standing_motion(0.0);
    let (still, _) = frame(&mut generator, &Controls::STAND);
    let mut bytes = generator.state();
    // That version had another number and no moment of life behind it: a double and two floats.
    bytes.truncate(bytes.len() - 16);
    bytes[0] = 4;
    let mut other = walker(&space, 8);
    other.restore(&bytes).unwrap();
    let mut pose = Pose::default();
    other.step(0.0, &Controls::STAND, &mut pose);
    assert_eq!(pose, still);
    for _ in 0..180 {
        other.step(DT, &Controls::STAND, &mut pose);
    }
    assert_ne!(pose, still);
}

/// Greatest accelerations of some joints over standing, starting, walking, stopping and standing again, m/s².
fn accelerations(generator: &mut GaitGenerator) -> [f32; 4] {
    let joints = [
        Joint::Hips,
        Joint::Head,
        Joint::LeftHand,
        Joint::RightLowerLeg,
    ];
    let mut last: Vec<[Vec3; 4]> = Vec::new();
    let mut most = [0.0_f32; 4];
    for n in 0..60 * 20 {
        let controls = Controls {
            speed_mps: if n % 400 > 150 && n % 400 < 290 {
                1.2
            } else {
                0.0
            },
            ..Controls::STAND
        };
        let (_, body) = frame(generator, &controls);
        last.push(joints.map(|joint| body.position(joint)));
        if let [.., a, b, c] = last.as_slice() {
            for joint in 0..joints.len() {
                let bend = c[joint] - 2.0 * b[joint] + a[joint];
                most[joint] = most[joint].max(bend.length() / (DT * DT));
            }
        }
    }
    most
}

#[test]
fn stands_starts_and_stops_do_not_pop() {
    let space = alive();
    for seed in 1..=5 {
        let alive = accelerations(&mut standing(&space, seed));
        let mut still = standing(&space, seed);
        still.set_standing_motion(0.0);
        let still = accelerations(&mut still);
        for (alive, still) in alive.iter().zip(still) {
            assert!(
                *alive < 1.25 * still + 1.5,
                "seed {seed}: {alive} for {still} m/s²"
            );
        }
    }
}

#[test]
fn a_style_stands_in_its_own_posture() {
    let base = model(FORMAT_VERSION);
    let mut bowed = GaitStyle {
        name: "bowed".to_owned(),
        base_fingerprint: base.fingerprint().unwrap(),
        steps: base.steps.clone(),
        global_variance: base.global_variance.clone(),
        step_spread: footfall_model::StepSpread::default(),
        speed_mps: base.speed.reference_mps,
        cadence_hz: base.cadence_hz(),
        provenance: base.provenance.clone(),
    };
    let chest = footfall_model::layout::feature_offset(Joint::Chest);
    for state in bowed.steps.iter_mut().flat_map(|step| &mut step.states) {
        state.mean[chest] += 0.25;
    }
    let space = Arc::new(StyleSpace::new(&base, &[Arc::new(bowed)]).unwrap());
    let skeleton = Skeleton::standard();
    let [mut plain, mut styled] = [0.0, 1.0].map(|weight| {
        let mut generator = GaitGenerator::new(&space, &[weight], &skeleton, &config(3)).unwrap();
        generator.stand();
        generator
    });
    for _ in 0..200 {
        let [plain, styled] = [&mut plain, &mut styled].map(|generator| {
            let (pose, _) = frame(generator, &Controls::STAND);
            pose.rotation(Joint::Chest).to_scaled_axis().x
        });
        assert!((styled - plain - 0.25).abs() < 0.03, "{styled} for {plain}");
    }
}
