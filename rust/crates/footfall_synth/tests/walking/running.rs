//! Runs: planted feet, ballistic flights, and the way into them and out of them.

use crate::world::{
    DT, Frame, Kind, assert_planted_within, config, generator, model, run, space, walking,
};
use footfall_core::{Joint, Pose, Skeleton};
use footfall_synth::{Controls, Gait, GaitChoice, GaitGenerator, StyleSpace};
use glam::Vec3;
use std::sync::Arc;

const GRAVITY_MPS2: f32 = 9.81;

/// Runners' feet roll in a third of the time of walkers'.
pub(crate) const ROLLING_MPS: f32 = 0.05;

#[test]
fn standing_feet_of_runners_do_not_move() {
    let skeleton = Skeleton::standard();
    for (seed, speed, turn_rate_radps) in
        [(1, 2.4, 0.0), (2, 3.0, 0.5), (3, 3.6, -0.4), (4, 4.5, 0.0)]
    {
        let controls = Controls {
            turn_rate_radps,
            ..walking(speed)
        };
        let (frames, _) = run(
            &mut generator(Kind::Styled, seed),
            &skeleton,
            &controls,
            900,
        );
        assert_planted_within(&skeleton, &frames, ROLLING_MPS);
    }
}

#[test]
fn the_wanted_speed_is_run() {
    let skeleton = Skeleton::standard();
    for (seed, speed) in [(1, 2.3), (2, 2.8), (3, 3.3), (4, 4.0)] {
        let mut generator = generator(Kind::Styled, seed);
        run(&mut generator, &skeleton, &walking(speed), 180);
        let from = generator.start_from_character().position;
        let (frames, footsteps) = run(&mut generator, &skeleton, &walking(speed), 1800);
        let realised = (frames.last().unwrap().place - from).length() / 30.0;
        assert!(
            (realised / speed - 1.0).abs() < 0.05,
            "{realised} for {speed} m/s"
        );
        let cadence = footsteps.len() as f32 / 30.0;
        // The actor's own, 2.5 to 3.7 a second, and a little beyond them as the walker is another one.
        assert!(
            (2.4..=4.2).contains(&cadence),
            "{cadence} steps a second at {speed} m/s"
        );
        let aloft = frames
            .iter()
            .filter(|frame| frame.contact == [false; 2])
            .count();
        let share = aloft as f32 / frames.len() as f32;
        assert!(
            (0.12..=0.5).contains(&share),
            "in the air {share} of the time at {speed} m/s"
        );
    }
}

#[test]
fn hips_fly_on_a_parabola() {
    let skeleton = Skeleton::standard();
    let mut generator = generator(Kind::Styled, 7);
    let (frames, _) = run(&mut generator, &skeleton, &walking(3.2), 900);
    let mut flights = 0;
    for window in frames[240..].windows(3) {
        if window.iter().any(|frame| frame.contact != [false; 2]) {
            continue;
        }
        let [before, now, next] =
            [0, 1, 2].map(|index: usize| window[index].model.position(Joint::Hips).y);
        let acceleration = (next - 2.0 * now + before) / (DT * DT);
        assert!(
            (acceleration + GRAVITY_MPS2).abs() < 1.0,
            "{acceleration} m/s² in the air"
        );
        flights += 1;
    }
    assert!(flights > 60, "only {flights} frames in the air");
}

/// A foot that bears catches the hips, which are lowest in the middle of its stance and not at its end.
#[test]
fn hips_do_not_fall_over_a_foot_that_bears() {
    let skeleton = Skeleton::standard();
    for (seed, speed) in [(1, 2.4), (2, 3.0), (3, 3.6)] {
        let mut generator = generator(Kind::Styled, seed);
        let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 1200);
        let (mut falling, mut bearing) = (0, 0);
        for window in frames[240..].windows(3) {
            if window.iter().any(|frame| frame.contact == [false; 2]) {
                continue;
            }
            let [before, now, next] =
                [0, 1, 2].map(|index: usize| window[index].model.position(Joint::Hips).y);
            bearing += 1;
            falling += usize::from((next - 2.0 * now + before) / (DT * DT) < -0.7 * GRAVITY_MPS2);
        }
        let share = falling as f32 / bearing as f32;
        assert!(
            share < 0.1,
            "falls for {share} of the stance at {speed} m/s"
        );
    }
}

/// Hips that followed the generated legs flew off up to 0.14 rad to the side, another way with every step.
#[test]
fn runs_go_where_they_are_sent() {
    let skeleton = Skeleton::standard();
    for (seed, speed) in [(1, 2.4), (2, 3.2), (3, 3.8)] {
        for direction_rad in [0.0, 0.4] {
            let controls = Controls {
                direction_rad,
                ..walking(speed)
            };
            let mut generator = generator(Kind::Styled, seed);
            let (frames, _) = run(&mut generator, &skeleton, &controls, 900);
            let way = frames[frames.len() - 1].place - frames[240].place;
            let off = way.x.atan2(way.z) - direction_rad;
            assert!(off.abs() < 0.03, "{off} rad off at {speed} m/s");
            let across = Vec3::new(way.z, 0.0, -way.x).normalize();
            let hips = frames[240..]
                .iter()
                .map(|frame| frame.model.position(Joint::Hips));
            let sway: Vec<f32> = hips.map(|hips| across.dot(hips) / DT).collect();
            let speeds = sway.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let most = speeds.fold(0.0, f32::max);
            // Captured hips sway by 0.1 to 0.2 m/s in a run of 3.2 m/s (CMU 9 and 35).
            assert!(most < 0.2, "sways by {most} m/s at {speed} m/s");
        }
    }
}

/// Only the steps into a run are shorter than those of a walk.
#[test]
fn who_is_to_walk_fast_takes_long_steps() {
    let controls = Controls {
        gait: GaitChoice::Walk,
        ..walking(2.7)
    };
    let mut generator = generator(Kind::Styled, 3);
    let (frames, steps) = run(&mut generator, &Skeleton::standard(), &controls, 600);
    let way = frames[frames.len() - 1].place - frames[0].place;
    let length = way.length() / steps.len() as f32;
    assert!(length > 0.85, "steps of {length} m");
}

/// A trunk that bends forwards in a run goes back with the first steps of a walk, and not within a frame; a leg that takes off does not snap straight.
#[test]
fn heads_and_knees_go_smoothly_through_changes_of_gait() {
    let skeleton = Skeleton::standard();
    for seed in 1..20 {
        let mut generator = generator(Kind::Styled, seed);
        run(&mut generator, &skeleton, &walking(1.3), 180);
        let mut frames = Vec::new();
        for speed in [3.2, 1.3, 3.2, 1.3] {
            frames.extend(run(&mut generator, &skeleton, &walking(speed), 180).0);
        }
        for (joint, most_mps2) in [
            (Joint::Head, 75.0),
            (Joint::LeftLowerLeg, 160.0),
            (Joint::RightLowerLeg, 160.0),
        ] {
            for (index, triple) in frames.windows(3).enumerate() {
                let [a, b, c] = [0, 1, 2].map(|at: usize| triple[at].model.position(joint));
                let mps2 = (a - 2.0 * b + c).length() / (DT * DT);
                assert!(
                    mps2 < most_mps2,
                    "{joint:?} by {mps2} m/s² in frame {index}, seed {seed}"
                );
            }
        }
    }
}

/// Steps that go on to the side are lengthened; those of a run that follows are not, nor is a walk that hardly turns aside.
#[test]
fn who_walked_aside_runs_and_walks_no_faster_for_it() {
    let skeleton = Skeleton::standard();
    for (seed, speed, direction_rad) in [(1, 2.2, 0.0), (2, 2.6, 0.0), (3, 1.7, 0.005)] {
        let speed_after = |aside_rad: f32| {
            let mut generator = generator(Kind::Styled, seed);
            let aside = Controls {
                direction_rad: aside_rad,
                ..walking(1.6)
            };
            run(&mut generator, &skeleton, &aside, 300);
            let ahead = Controls {
                direction_rad,
                ..walking(speed)
            };
            let (frames, _) = run(&mut generator, &skeleton, &ahead, 600);
            let way = frames[599].place - frames[120].place;
            way.length() / (479.0 * DT)
        };
        let (straight, aside) = (speed_after(0.0), speed_after(0.5));
        assert!(
            (aside / straight - 1.0).abs() < 0.03 && (aside / speed - 1.0).abs() < 0.06,
            "{aside} m/s after steps aside, {straight} after none, {speed} asked"
        );
    }
}

/// The foot that lands brakes the hips, and pushes them on before it leaves.
#[test]
fn hips_are_slowest_in_the_first_half_of_a_stance() {
    let skeleton = Skeleton::standard();
    let mut generator = generator(Kind::Styled, 4);
    let (frames, _) = run(&mut generator, &skeleton, &walking(3.2), 900);
    let bears = |frame: &Frame| frame.contact != [false; 2];
    let speeds = frames.windows(2).map(|pair| {
        let [before, now] = [0, 1].map(|index: usize| pair[index].model.position(Joint::Hips));
        (bears(&pair[1]), (now.z - before.z) / DT)
    });
    let speeds: Vec<(bool, f32)> = speeds.skip(240).collect();
    let stances: Vec<&[(bool, f32)]> = speeds
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|part| part[0].0 && part.len() >= 6)
        .collect();
    assert!(stances.len() > 20, "{} stances", stances.len());
    let gains = stances.iter().map(|stance| {
        let mean =
            |part: &[(bool, f32)]| part.iter().map(|(_, mps)| mps).sum::<f32>() / part.len() as f32;
        let (first, second) = stance.split_at(stance.len() / 2);
        mean(second) - mean(first)
    });
    let gain = gains.sum::<f32>() / stances.len() as f32;
    assert!(
        gain > 0.05,
        "{gain} m/s are gained from the first half to the second"
    );
}

#[test]
fn walkers_become_runners_and_come_to_a_stand_again() {
    let skeleton = Skeleton::standard();
    for seed in 1..6 {
        let mut generator = generator(Kind::Styled, seed);
        generator.stand();
        let mut frames = Vec::new();
        let mut gaits = Vec::new();
        for (speed, secs) in [(0.0, 1), (1.3, 3), (3.2, 3), (1.2, 3), (3.4, 3), (0.0, 4)] {
            frames.extend(run(&mut generator, &skeleton, &walking(speed), 60 * secs).0);
            gaits.push(generator.gait());
        }
        let expected = [0, 0, 1, 0, 1, 0].map(|gait: usize| [Gait::Walk, Gait::Run][gait]);
        assert_eq!(gaits, expected, "seed {seed}");
        assert!(
            generator.is_standing(),
            "seed {seed} does not come to a stand"
        );
        assert_planted_within(&skeleton, &frames, ROLLING_MPS);
        let mut most: f32 = 0.0;
        for window in frames.windows(3) {
            for joint in [Joint::Hips, Joint::Head, Joint::LeftHand, Joint::RightHand] {
                let [a, b, c] = [0, 1, 2].map(|index: usize| window[index].model.position(joint));
                most = most.max((c - 2.0 * b + a).length() / (DT * DT));
            }
        }
        // Captured runs and starts reach 83 (99.9th percentile of the hands); a pop of a centimetre would be 36 on its own.
        assert!(most < 110.0, "seed {seed}: {most} m/s²");
    }
}

#[test]
fn a_gait_that_is_asked_for_is_kept() {
    let skeleton = Skeleton::standard();
    for (gait, speed, expected) in [
        (GaitChoice::Walk, 2.6, Gait::Walk),
        (GaitChoice::Run, 1.6, Gait::Run),
        (GaitChoice::Auto, 1.6, Gait::Walk),
        (GaitChoice::Auto, 2.6, Gait::Run),
    ] {
        let mut generator = generator(Kind::Styled, 3);
        let controls = Controls {
            gait,
            ..walking(speed)
        };
        run(&mut generator, &skeleton, &controls, 240);
        assert_eq!(generator.gait(), expected, "{gait:?} at {speed} m/s");
    }
}

#[test]
fn a_model_that_only_walks_walks() {
    let walker = footfall_model::GaitModel {
        running: None,
        ..(*model()).clone()
    };
    let space = Arc::new(StyleSpace::new(&Arc::new(walker), &[]).unwrap());
    let skeleton = Skeleton::standard();
    let mut generator = GaitGenerator::new(&space, &[], &skeleton, &config(1)).unwrap();
    let controls = Controls {
        gait: GaitChoice::Run,
        ..walking(5.0)
    };
    let (frames, _) = run(&mut generator, &skeleton, &controls, 300);
    assert_eq!(generator.gait(), Gait::Walk);
    assert!(frames.iter().all(|frame| frame.contact != [false; 2]));
}

#[test]
fn a_runner_goes_on_from_a_saved_state_bit_for_bit() {
    let skeleton = Skeleton::standard();
    let controls = walking(3.0);
    for frames in [95, 150, 163, 171, 400] {
        let mut first = generator(Kind::Styled, 11);
        run(&mut first, &skeleton, &controls, frames);
        let state = first.state();
        let mut second = GaitGenerator::new(&space(), &[], &skeleton, &config(2)).unwrap();
        second.restore(&state).unwrap();
        let (mut a, mut b) = (Pose::default(), Pose::default());
        for frame in 0..200 {
            first.step(DT, &controls, &mut a);
            second.step(DT, &controls, &mut b);
            assert_eq!(a, b, "{frame} frames after {frames}");
        }
    }
}

/// Rests that a stride leaves over would add up: heads once sank by up to 5° a second, to 30°.
#[test]
fn heads_of_runners_stay_up() {
    let skeleton = Skeleton::standard();
    for speed in [2.4, 3.5, 4.5] {
        for seed in 1..9 {
            let mut generator = generator(Kind::Styled, seed);
            let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 1200);
            let down = |joint: Joint, frames: &[Frame]| {
                let forward = |frame: &Frame| (frame.model.rotation(joint) * Vec3::Z).y;
                let sum: f32 = frames.iter().map(|frame| -forward(frame).asin()).sum();
                (sum / frames.len() as f32).to_degrees()
            };
            let [early, late] =
                [&frames[180..360], &frames[1020..]].map(|frames| down(Joint::Head, frames));
            assert!(
                (late - early).abs() < 4.0 && late < 18.0,
                "{speed} m/s, seed {seed}: heads {early}°, later {late}° down"
            );
            let trunk = down(Joint::UpperChest, &frames[180..]);
            assert!(
                (-8.0..16.0).contains(&trunk),
                "{speed} m/s, seed {seed}: the trunk leans by {trunk}°"
            );
        }
    }
}
