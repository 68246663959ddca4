//! Promises of the generator, on the model that the add-on ships.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

mod arms;
mod climbing;
mod jumping;
mod leaning;
mod leaping;
mod looking;
mod pushed;
mod quick;
mod run_response;
mod run_up;
mod running;
mod setting_out;
mod slow;
mod standing;
mod stopping;
mod strafing;
mod turning;
mod turning_back;
mod world;

use footfall_core::rotation::heading;
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_synth::{
    Controls, GaitGenerator, GeneratorConfig, SynthError, WalkConfig, synthesize,
};
use glam::Vec3;
use world::{
    Frame, KINDS, Kind, assert_continuous, assert_planted, config, generator, landing_knees,
    lowest, model, run, sole, walker, walking,
};

#[test]
fn standing_feet_do_not_move() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        for (seed, speed, turn_rate_radps) in
            [(1, 1.2, 0.0), (2, 0.8, 0.3), (3, 1.7, -0.4), (4, 1.3, 0.0)]
        {
            let controls = Controls {
                speed_mps: speed,
                turn_rate_radps,
                ..Controls::STAND
            };
            let (frames, _) = run(&mut generator(kind, seed), &skeleton, &controls, 900);
            assert_planted(&skeleton, &frames);
        }
    }
}

#[test]
fn other_bodies_stand_as_well() {
    for kind in KINDS {
        let mut long_shanks = Skeleton::standard().scaled(1.3);
        for side in Side::BOTH {
            long_shanks.offsets[side.lower_leg().index()] *= 0.85;
            long_shanks.offsets[side.foot().index()] *= 1.1;
        }
        for skeleton in [Skeleton::standard().scaled(0.5), long_shanks] {
            let mut generator = walker(kind, &skeleton, &config(5)).unwrap();
            let (frames, _) = run(&mut generator, &skeleton, &walking(1.0), 600);
            assert_planted(&skeleton, &frames);
        }
    }
}

#[test]
fn the_wanted_speed_is_walked_straight_ahead() {
    for kind in KINDS {
        for (seed, speed) in [(1, 0.4), (2, 0.7), (3, 1.0), (4, 1.3), (5, 1.6), (6, 2.0)] {
            // Two systems know one way of walking, which can only be hurried so much.
            if kind == Kind::Switching && speed > 1.5 {
                continue;
            }
            let mut generator = generator(kind, seed);
            let skeleton = Skeleton::standard();
            run(&mut generator, &skeleton, &walking(speed), 120);
            let from = generator.start_from_character().position;
            let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 3600);
            let travel = frames.last().unwrap().place - from;
            let realised = travel.length() / 60.0;
            assert!(
                (realised / speed - 1.0).abs() < 0.05,
                "{realised} for {speed} m/s"
            );
            assert!(travel.x.abs() < 0.04 * travel.z, "strays by {travel}");
        }
    }
}

#[test]
fn turning_turns_by_the_wanted_angle() {
    for kind in KINDS {
        let controls = Controls {
            speed_mps: 1.1,
            turn_rate_radps: 0.3,
            ..Controls::STAND
        };
        let mut generator = generator(kind, 3);
        let skeleton = Skeleton::standard();
        run(&mut generator, &skeleton, &controls, 60);
        let before = generator.start_from_character().heading;
        let (frames, _) = run(&mut generator, &skeleton, &controls, 300);
        let turned = frames.last().unwrap().heading - before;
        assert!((turned - 1.5).abs() < 0.02, "{turned}");
        for frame in &frames {
            let hips = heading(frame.model.rotation(Joint::Hips));
            assert!(
                (hips - frame.heading).abs() < 0.35,
                "hips face {hips}, walker {}",
                frame.heading
            );
        }
    }
}

#[test]
fn every_contact_is_told_once_and_feet_alternate() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let (frames, footsteps) = run(&mut generator(kind, 7), &skeleton, &walking(1.2), 1200);
        let begun: usize = frames
            .windows(2)
            .map(|pair| {
                let begins = |side: usize| !pair[0].contact[side] && pair[1].contact[side];
                usize::from(begins(0)) + usize::from(begins(1))
            })
            .sum();
        assert_eq!(footsteps.len(), begun);
        assert!(
            footsteps
                .windows(2)
                .all(|pair| pair[0].side != pair[1].side)
        );
        for pair in footsteps.windows(2) {
            let step = (pair[1].position - pair[0].position).z;
            assert!((0.3..1.1).contains(&step), "a step of {step} m");
            assert!(pair[0].position.y.abs() < 1e-6);
        }
    }
}

#[test]
fn equal_seeds_walk_equally_and_others_do_not() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let positions = |seed: u64| -> Vec<Vec3> {
            let (frames, _) = run(&mut generator(kind, seed), &skeleton, &walking(1.2), 300);
            frames
                .iter()
                .map(|f| f.model.position(Joint::LeftHand))
                .collect()
        };
        assert_eq!(positions(11), positions(11));
        let (first, other) = (positions(11), positions(12));
        let apart: f32 = first.iter().zip(&other).map(|(a, b)| a.distance(*b)).sum();
        assert!(apart / 300.0 > 0.02, "two walkers keep step");
    }
}

#[test]
fn motion_is_continuous_through_changes_of_control() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let mut generator = generator(kind, 23);
        let mut all = Vec::new();
        for (speed, turn) in [(1.2, 0.0), (1.8, 0.5), (0.6, -0.5), (1.4, 0.0)] {
            let controls = Controls {
                speed_mps: speed,
                turn_rate_radps: turn,
                ..Controls::STAND
            };
            all.extend(run(&mut generator, &skeleton, &controls, 180).0);
        }
        assert_continuous(kind, &all);
    }
}

/// People land on a nearly straight leg, whatever their speed, and their hips rise and fall by a few centimetres. Captured with corrected hip joints: knees of 6°,
/// hips that rise and fall by 2.9 cm.
#[test]
fn walkers_land_on_straight_legs() {
    let skeleton = Skeleton::standard();
    for speed in [0.9, 1.3, 1.7] {
        let (mut knees, mut bobs) = (vec![], vec![]);
        for seed in 1..9 {
            let mut generator = generator(Kind::Styled, seed);
            run(&mut generator, &skeleton, &walking(speed), 200);
            let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 400);
            knees.extend(landing_knees(&frames));
            let heights = frames
                .iter()
                .map(|frame| frame.model.position(Joint::Hips).y);
            bobs.push(heights.clone().fold(0.0, f32::max) - heights.fold(2.0, f32::min));
        }
        let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
        let (knee, bob) = (mean(&knees), mean(&bobs));
        assert!(knee < 18.0, "{speed} m/s: knees of {knee}° where feet land");
        assert!(
            (0.015..0.055).contains(&bob),
            "{speed} m/s: hips bob by {bob} m"
        );
    }
}

#[test]
fn a_pose_is_given_again_when_no_time_passes() {
    for kind in KINDS {
        let mut generator = generator(kind, 1);
        let (mut first, mut again) = (Pose::default(), Pose::default());
        generator.step(0.7, &walking(1.2), &mut first);
        generator.step(0.0, &walking(1.2), &mut again);
        assert_eq!(first, again);
        assert!(generator.footsteps().is_empty());
    }
}

#[test]
fn senseless_controls_still_give_a_human_pose() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        for speed in [f32::NAN, f32::INFINITY, -3.0, 0.0, 50.0] {
            for turn_rate_radps in [f32::NAN, 100.0, 0.0] {
                let controls = Controls {
                    speed_mps: speed,
                    turn_rate_radps,
                    ..Controls::STAND
                };
                let mut generator = generator(kind, 1);
                let (frames, _) = run(&mut generator, &skeleton, &controls, 200);
                for frame in frames {
                    let height = frame.model.position(Joint::Hips).y;
                    assert!(
                        (0.4..1.1).contains(&height),
                        "hips at {height} for {controls:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_phase_is_where_the_stride_begins() {
    for kind in KINDS {
        for (phase, leading) in [(0.0, Side::Left), (0.5, Side::Right)] {
            let settings = GeneratorConfig { phase, ..config(1) };
            let skeleton = Skeleton::standard();
            let mut generator = walker(kind, &skeleton, &settings).unwrap();
            let (frames, footsteps) = run(&mut generator, &skeleton, &walking(1.2), 60);
            let ahead = frames[0].model.position(leading.foot()).z;
            assert!(ahead > frames[0].model.position(leading.other().foot()).z + 0.3);
            assert_eq!(footsteps[0].side, leading.other());
        }
    }
}

#[test]
fn an_hour_of_switching_goes_nowhere_else() {
    let skeleton = Skeleton::standard();
    let mut generator = generator(Kind::Switching, 8);
    let minute = |generator: &mut GaitGenerator| {
        let from = generator.start_from_character().position;
        let (frames, footsteps) = run(generator, &skeleton, &walking(1.1), 3600);
        let hips = frames.iter().map(|f| f.model.position(Joint::Hips).y);
        let (low, high) = hips.fold((f32::INFINITY, 0.0_f32), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        assert!(0.8 < low && high < 1.1, "hips from {low} to {high} m");
        let travel = frames.last().unwrap().place - from;
        (travel, footsteps.len())
    };
    let (first, _) = minute(&mut generator);
    let mut last = (first, 0);
    for _ in 1..60 {
        last = minute(&mut generator);
    }
    let way = last.0;
    assert!((way.length() / first.length() - 1.0).abs() < 0.05, "{way}");
    assert!(way.x.abs() < 0.04 * way.z, "strays by {way}");
    assert!((90..130).contains(&last.1), "{} steps", last.1);
}

#[test]
fn bad_settings_are_refused() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let settings = GeneratorConfig {
            phase: f32::NAN,
            ..config(1)
        };
        let error = walker(kind, &skeleton, &settings).unwrap_err();
        assert!(matches!(
            error,
            SynthError::Setting {
                setting: "phase",
                ..
            }
        ));
        let mut legless = Skeleton::standard();
        legless.offsets[Joint::LeftFoot.index()] = Vec3::ZERO;
        let error = walker(kind, &legless, &config(1)).unwrap_err();
        assert!(error.to_string().contains("LeftFoot"), "{error}");
    }
}

#[test]
fn a_whole_walk_has_its_steps_its_speed_and_its_contacts() {
    let walk = |speed_mps: Option<f32>, frame_rate_hz: Option<f64>| {
        let settings = WalkConfig {
            steps: 20,
            seed: 4,
            variation: 1.0,
            speed_mps,
            turn_rate_radps: 0.0,
            direction_rad: 0.0,
            frame_rate_hz,
            from_standing: false,
            gait: footfall_synth::GaitChoice::Auto,
        };
        synthesize(&model(), &Skeleton::standard(), &settings).unwrap()
    };
    let usual = walk(None, None);
    let travel = usual.clip.poses.last().unwrap().root_position.z;
    let speed = f64::from(travel) / usual.clip.duration_secs();
    let [slowest, fastest] = model().speed_range();
    assert!((slowest..fastest).contains(&speed), "{speed} m/s");
    assert!(usual.clip.poses[0].root_position.x.abs() < 1e-6);
    // 20 steps: the last frame is the 21st initial contact, the first that of the left foot.
    assert_eq!(usual.contacts[0].len() + usual.contacts[1].len(), 22);

    let doubled = walk(Some(1.5), Some(120.0));
    let speed = f64::from(doubled.clip.poses.last().unwrap().root_position.z)
        / doubled.clip.duration_secs();
    assert!((speed / 1.5 - 1.0).abs() < 0.05, "{speed} m/s");
    for (frame, pose) in doubled.clip.poses.iter().enumerate() {
        let mut model = ModelPose::default();
        forward_kinematics(&doubled.clip.skeleton, pose, &mut model);
        for side in Side::BOTH {
            let stands = doubled.contacts[side.index()]
                .iter()
                .any(|span| span.contains(frame));
            let frame = Frame {
                model: model.clone(),
                contact: [true; 2],
                heading: 0.0,
                place: Vec3::ZERO,
            };
            let points = sole(&doubled.clip.skeleton, &frame, side);
            let lowest = lowest(&points);
            assert!(lowest > -0.002, "sole at {lowest}");
            assert!(!stands || lowest < 0.005, "standing foot at {lowest}");
        }
    }
}
