//! Styles that change while a walker walks, and walkers that are saved and go on elsewhere.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::layout::feature_offset;
use footfall_model::{
    DynamicsModel, GaitModel, GaitStyle, OBSERVATION_COUNT, StepSpread, StyleError,
};
use footfall_synth::{
    Controls, Detail, GaitGenerator, GeneratorConfig, StateError, StyleSpace, SynthError,
};
use glam::{Quat, Vec3};
use proptest::prelude::*;
use std::sync::{Arc, OnceLock};

const DT: f32 = 1.0 / 60.0;

fn model() -> Arc<GaitModel> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../addons/footfall/models/locomotion.footfall"
    );
    Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap())
}

/// A style made by bending joints of the average walk and changing its durations.
fn style(model: &GaitModel, name: &str, bends: &[(Joint, f64)], tempo: f64) -> Arc<GaitStyle> {
    let mut steps = model.steps.clone();
    for state in steps.iter_mut().flat_map(|step| &mut step.states) {
        assert_eq!(state.mean.len(), OBSERVATION_COUNT);
        for (joint, radians) in bends {
            state.mean[feature_offset(*joint)] += radians;
        }
        state.duration_mean /= tempo;
    }
    Arc::new(GaitStyle {
        name: name.to_owned(),
        base_fingerprint: model.fingerprint().unwrap(),
        steps,
        global_variance: model.global_variance.clone(),
        speed_mps: model.speed.reference_mps * tempo,
        cadence_hz: model.cadence_hz() * tempo,
        step_spread: StepSpread::default(),
        provenance: model.provenance.clone(),
    })
}

fn space() -> Arc<StyleSpace> {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    let make = || {
        let model = model();
        let stooped = [(Joint::Chest, 0.3), (Joint::Spine, 0.2), (Joint::Head, 0.2)];
        let crouched = [
            (Joint::LeftUpperLeg, -0.25),
            (Joint::RightUpperLeg, -0.25),
            (Joint::LeftLowerLeg, 0.4),
            (Joint::RightLowerLeg, 0.4),
        ];
        let styles = [
            style(&model, "stooped", &stooped, 0.7),
            style(&model, "crouched", &crouched, 1.2),
        ];
        Arc::new(StyleSpace::new(&model, &styles).unwrap())
    };
    Arc::clone(SPACE.get_or_init(make))
}

fn generator(seed: u64) -> GaitGenerator {
    let config = GeneratorConfig {
        seed,
        phase: 0.2,
        variation: 1.0,
    };
    GaitGenerator::new(&space(), &[], &Skeleton::standard(), &config).unwrap()
}

fn walking(speed_mps: f32) -> Controls {
    Controls {
        speed_mps,
        ..Controls::STAND
    }
}

/// The next frame in the space where the walk began.
fn next(generator: &mut GaitGenerator, controls: Controls) -> ModelPose {
    let mut pose = Pose::default();
    generator.step(DT, &controls, &mut pose);
    let place = generator.start_from_character();
    let level = Quat::from_rotation_y(place.heading);
    pose.root_position = place.position + level * pose.root_position;
    pose.rotations[0] = level * pose.rotations[0];
    let mut model = ModelPose::default();
    forward_kinematics(&Skeleton::standard(), &pose, &mut model);
    model
}

/// Forward lean of the chest, radians.
fn lean(pose: &ModelPose) -> f32 {
    let up = pose.rotation(Joint::UpperChest) * Vec3::Y;
    up.z.atan2(up.y)
}

#[test]
fn a_style_is_worn_within_a_step_and_without_a_pop() {
    let mut walker = generator(3);
    let mut frames = Vec::new();
    let mut lean_before = 0.0;
    for (index, weights) in [[0.0, 0.0], [1.0, 0.0], [0.3, 1.0], [-0.5, 0.4], [0.0, 0.0]]
        .iter()
        .enumerate()
    {
        walker.set_style_weights(weights);
        assert_eq!(walker.style_weights(), weights);
        let mut steps = 0;
        let from = frames.len();
        for _ in 0..200 {
            frames.push(next(&mut walker, walking(1.1)));
            steps += walker.footsteps().len();
            if index == 1 && steps == 2 {
                // One whole step after the change.
                let now = frames[from + 40..].iter().map(lean).sum::<f32>();
                let now = now / (frames.len() - from - 40) as f32;
                assert!(now > lean_before + 0.25, "leans {now} after {lean_before}");
            }
        }
        if index == 0 {
            lean_before = frames.iter().map(lean).sum::<f32>() / frames.len() as f32;
        }
    }
    for (index, triple) in frames.windows(3).enumerate() {
        for joint in Joint::ALL {
            let [a, b, c] = [0, 1, 2].map(|frame: usize| triple[frame].position(joint));
            let jump = (a - 2.0 * b + c).length();
            assert!(jump < 0.034, "{joint:?} jumps by {jump} m in frame {index}");
        }
    }
}

#[test]
fn a_changed_style_still_walks_straight_ahead_at_the_wanted_speed() {
    let mut walker = generator(8);
    for weights in [[0.6, 0.0], [0.0, 1.0], [0.5, 0.5]] {
        walker.set_style_weights(&weights);
        for _ in 0..120 {
            next(&mut walker, walking(1.0));
        }
        let from = walker.start_from_character();
        for _ in 0..1800 {
            next(&mut walker, walking(1.0));
        }
        let to = walker.start_from_character();
        let way = Quat::from_rotation_y(-from.heading) * (to.position - from.position);
        assert!(
            (way.length() / 30.0 - 1.0).abs() < 0.05,
            "{weights:?}: {way}"
        );
        assert!(way.x.abs() < 0.05 * way.z, "{weights:?} strays by {way}");
    }
}

#[test]
fn senseless_weights_give_human_poses() {
    let mut walker = generator(5);
    for weights in [
        vec![f32::NAN, f32::INFINITY],
        vec![1e9, -1e9],
        vec![],
        vec![0.5; 9],
    ] {
        walker.set_style_weights(&weights);
        for _ in 0..150 {
            let pose = next(&mut walker, walking(1.2));
            let hips = pose.position(Joint::Hips).y;
            assert!((0.4..1.1).contains(&hips), "hips at {hips} for {weights:?}");
        }
    }
}

#[test]
fn a_foreign_style_is_refused() {
    let model = model();
    let mut foreign = style(&model, "foreign", &[], 1.0).as_ref().clone();
    foreign.base_fingerprint ^= 1;
    let error = StyleSpace::new(&model, &[Arc::new(foreign)]).unwrap_err();
    assert!(matches!(
        error,
        SynthError::Style(StyleError::OtherBase { .. })
    ));
}

/// Plays frame `frame` as a player might.
fn play(walker: &mut GaitGenerator, frame: u32) -> Pose {
    let wave = (frame as f32 * 0.013).sin();
    match frame % 310 {
        120 => walker.set_style_weights(&[0.5 * wave, 0.8]),
        121 => walker.set_style_weights(&[wave, 0.1]),
        250 => walker.set_style_weights(&[0.0, 0.0]),
        60 => walker.set_detail(Detail::Half),
        150 => walker.set_detail(Detail::Quarter),
        290 => walker.set_detail(Detail::Full),
        _ => {}
    }
    let controls = if frame % 400 > 330 {
        walking(0.0)
    } else {
        Controls {
            speed_mps: 1.2 + 0.6 * wave,
            turn_rate_radps: 0.5 * wave,
            ..Controls::STAND
        }
    };
    let mut pose = Pose::default();
    walker.step(DT, &controls, &mut pose);
    pose
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn a_restored_walker_goes_on_bit_for_bit(seed in any::<u64>(), saved_at in 0_u32..700, stands: bool) {
        let mut walker = generator(seed);
        if stands {
            walker.stand();
        }
        for frame in 0..saved_at {
            play(&mut walker, frame);
        }
        let state = walker.state();
        prop_assert!(state.len() < 2000, "{} bytes", state.len());
        let mut other = generator(seed.wrapping_add(1));
        for frame in 0..seed as u32 % 100 {
            play(&mut other, frame);
        }
        other.restore(&state).unwrap();
        prop_assert_eq!(other.state(), state);
        for frame in saved_at..saved_at + 400 {
            let (one, two) = (play(&mut walker, frame), play(&mut other, frame));
            prop_assert_eq!(one, two, "frame {}", frame);
            prop_assert_eq!(walker.start_from_character(), other.start_from_character());
            prop_assert_eq!(walker.footsteps(), other.footsteps());
            prop_assert_eq!(walker.feet_in_contact(), other.feet_in_contact());
        }
    }

    #[test]
    fn damaged_states_are_refused_or_walk(at in 0_usize..1400, value: u8, cut in 0_usize..1500) {
        let mut walker = generator(1);
        for frame in 0..130 {
            play(&mut walker, frame);
        }
        let mut state = walker.state();
        let len = state.len();
        prop_assert!(walker.restore(&state[..cut.min(len - 1)]).is_err());
        state[at.min(len - 1)] = value;
        if walker.restore(&state).is_ok() {
            let pose = play(&mut walker, 131);
            prop_assert!(pose.root_position.is_finite());
        }
    }
}

/// Each number of a state in turn becomes one of hundreds or millions, within the limits of a state, alone and with a later one.
#[test]
fn a_state_far_from_any_walk_is_walked_from_or_changes_nothing() {
    let mut walker = generator(1);
    for frame in 0..130 {
        play(&mut walker, frame);
    }
    let state = walker.state();
    let mut other = generator(2);
    play(&mut other, 0);
    let unchanged = other.state();
    let [mut walked, mut refused] = [0, 0];
    for at in 0..250 {
        for (high_byte, later) in [67, 75, 195, 203, 201].into_iter().zip([0, 0, 0, 0, 12]) {
            let mut damaged = state.clone();
            damaged[at + later] = 71;
            damaged[at] = high_byte;
            if other.restore(&damaged).is_ok() {
                walked += 1;
                let pose = play(&mut other, 131);
                assert!(pose.root_position.is_finite(), "{high_byte} at {at}");
            } else {
                refused += 1;
                assert_eq!(other.state(), unchanged, "{high_byte} at {at}");
                let mut same = generator(2);
                same.restore(&unchanged).unwrap();
                assert_eq!(play(&mut other, 1), play(&mut same, 1));
            }
            other.restore(&unchanged).unwrap();
        }
    }
    assert!(walked > 100 && refused > 100, "{walked} {refused}");
}

fn switching(seed: u64) -> GaitGenerator {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../addons/footfall/models/walk.footdyn"
    );
    let model = DynamicsModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    let config = GeneratorConfig {
        seed,
        phase: 0.0,
        variation: 1.0,
    };
    GaitGenerator::switching(&Arc::new(model), &Skeleton::standard(), &config).unwrap()
}

#[test]
fn a_restored_switching_walker_goes_on_bit_for_bit() {
    for (seed, saved_at, stands) in [(1, 0, false), (2, 1, true), (3, 150, false), (4, 333, true)] {
        let mut walker = switching(seed);
        if stands {
            walker.stand();
        }
        for frame in 0..saved_at {
            play(&mut walker, frame);
        }
        let state = walker.state();
        assert!(state.len() < 360, "{} bytes", state.len());
        let mut other = switching(seed + 1);
        play(&mut other, 40);
        other.restore(&state).unwrap();
        assert_eq!(other.state(), state);
        for frame in saved_at..saved_at + 400 {
            assert_eq!(
                play(&mut walker, frame),
                play(&mut other, frame),
                "frame {frame}"
            );
            assert_eq!(walker.start_from_character(), other.start_from_character());
        }
        for at in 0..state.len() {
            let mut damaged = state.clone();
            damaged[at] ^= 0x55;
            if other.restore(&damaged).is_ok() {
                assert!(play(&mut other, 1).root_position.is_finite());
            }
        }
    }
}

#[test]
fn a_state_of_another_model_or_other_styles_is_refused() {
    let walker = generator(1);
    let plain = Arc::new(StyleSpace::new(&model(), &[]).unwrap());
    let config = GeneratorConfig {
        seed: 1,
        phase: 0.0,
        variation: 1.0,
    };
    let skeleton = Skeleton::standard();
    let mut switching = switching(1);
    let refused = switching.restore(&walker.state());
    assert!(
        matches!(refused, Err(StateError::OtherModel)),
        "{refused:?}"
    );
    let mut other = GaitGenerator::new(&plain, &[], &skeleton, &config).unwrap();
    let refused = other.restore(&switching.state());
    assert!(
        matches!(refused, Err(StateError::OtherModel)),
        "{refused:?}"
    );
    let refused = other.restore(&walker.state());
    assert!(matches!(
        refused,
        Err(StateError::OtherStyles {
            expected: 2,
            found: 0
        })
    ));
}
