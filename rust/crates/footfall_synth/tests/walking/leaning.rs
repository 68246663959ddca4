//! Leaning: into turns, and against changes of speed.

use crate::running::ROLLING_MPS;
use crate::world::{DT, Frame, Kind, assert_planted_within, generator, run, walking};
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;
use glam::{Quat, Vec3};

/// Means over ten seconds of a turn to the left (1) or to the right (-1).
struct Turn {
    /// Inward lean of pelvis and chest, radians.
    pelvis: f32,
    chest: f32,
    /// Distance of the feet outside the hips, metres.
    outside_m: f32,
    /// Speed of the walker, m/s.
    speed_mps: f32,
}

fn turn(side: f32, speed_mps: f32, pull_mps2: f32) -> Turn {
    let skeleton = Skeleton::standard();
    let controls = Controls {
        turn_rate_radps: side * pull_mps2 / speed_mps,
        ..walking(speed_mps)
    };
    let mut walker = generator(Kind::Styled, 2);
    let (mut frames, _) = run(&mut walker, &skeleton, &controls, 180);
    let mut way = 0.0;
    for _ in 0..60 {
        let before = walker.start_from_character().position;
        frames.extend(run(&mut walker, &skeleton, &controls, 10).0);
        way += walker.start_from_character().position.distance(before);
    }
    assert_planted_within(&skeleton, &frames, ROLLING_MPS);
    let frames = &frames[180..];
    let inwards = |of: &dyn Fn(&Frame) -> Vec3| {
        let left = |frame: &Frame| (Quat::from_rotation_y(-frame.heading) * of(frame)).x;
        side * frames.iter().map(left).sum::<f32>() / frames.len() as f32
    };
    let lean = |joint: Joint| inwards(&|frame| frame.model.rotation(joint) * Vec3::Y).asin();
    let hips = |frame: &Frame| frame.model.position(Joint::Hips);
    let feet = Side::BOTH
        .map(|side| inwards(&|frame: &Frame| hips(frame) - frame.model.position(side.foot())));
    Turn {
        pelvis: lean(Joint::Hips),
        chest: lean(Joint::Chest),
        outside_m: 0.5 * (feet[0] + feet[1]),
        speed_mps: way / (600.0 * DT),
    }
}

/// Pelvis and chest of O3DE's actor lean by 6°, 10° and 14° in turns at 1.5, 2.5 and 3.5 m/s², walking and running, and his feet are 13, 20 and 26 cm outside his hips.
#[test]
fn bodies_lean_into_turns_as_those_of_people() {
    for (speed_mps, pull_mps2, lean_deg, outside_m) in [
        (1.3, 1.5, 6.0, 0.13),
        (1.8, 2.5, 10.0, 0.2),
        (2.6, 1.5, 6.0, 0.13),
        (2.6, 2.5, 10.0, 0.2),
        (2.6, 3.5, 14.0, 0.26),
    ] {
        let turns = [1.0, -1.0].map(|side| turn(side, speed_mps, pull_mps2));
        let mean = |of: fn(&Turn) -> f32| 0.5 * (of(&turns[0]) + of(&turns[1]));
        let what = format!("{speed_mps} m/s, {pull_mps2} m/s²");
        for lean in [mean(|turn| turn.pelvis), mean(|turn| turn.chest)] {
            let lean = lean.to_degrees();
            assert!((lean - lean_deg).abs() < 1.0, "{what}: {lean}°");
        }
        let outside = mean(|turn| turn.outside_m);
        assert!((outside - outside_m).abs() < 0.05, "{what}: {outside} m");
        let speed = mean(|turn| turn.speed_mps);
        assert!(
            (speed - speed_mps).abs() < 0.06 * speed_mps,
            "{what}: {speed} m/s"
        );
    }
}

/// Hips of O3DE's actor are 7 cm lower in turns at 3 to 4 m/s², walking and running.
#[test]
fn hips_sink_in_turns_as_those_of_people() {
    let skeleton = Skeleton::standard();
    let height = |speed_mps: f32, turn_rate_radps: f32| {
        let controls = Controls {
            turn_rate_radps,
            ..walking(speed_mps)
        };
        let mut walker = generator(Kind::Styled, 2);
        let (frames, _) = run(&mut walker, &skeleton, &controls, 600);
        assert_planted_within(&skeleton, &frames, ROLLING_MPS);
        let heights = frames[180..].iter();
        heights
            .map(|frame| frame.model.position(Joint::Hips).y)
            .sum::<f32>()
            / 420.0
    };
    for (speed_mps, pull_mps2, depths) in [
        (1.3, 1.0, -0.005..0.015),
        (1.3, 3.5, 0.05..0.09),
        (3.0, 3.5, 0.05..0.09),
    ] {
        let sunk = height(speed_mps, 0.0) - height(speed_mps, pull_mps2 / speed_mps);
        assert!(
            depths.contains(&sunk),
            "{speed_mps} m/s, {pull_mps2} m/s²: {sunk} m"
        );
    }
}

/// Pelvis and chest of O3DE's actor lean by 5 to 9° beyond an even walk or run as he gains 2 m/s², and back by 11 to 18° as he loses 3 m/s². His even run is as upright as he stands;
/// other runners lean.
#[test]
fn trunks_lean_against_changes_of_speed() {
    let skeleton = Skeleton::standard();
    let forwards = |frame: &Frame, joint: Joint| {
        let up = frame.model.rotation(joint) * Vec3::Y;
        (Quat::from_rotation_y(-frame.heading) * up).z.asin()
    };
    for (speed_mps, ahead_deg) in [(1.5, 5.0..9.0), (3.0, 7.0..12.0)] {
        let (mut most, mut bowed) = ([[0.0; 2]; 2], 0.0);
        for seed in 1..9 {
            let mut walker = generator(Kind::Styled, seed);
            walker.stand();
            let mut go = |controls: &Controls, frames| {
                let (frames, _) = run(&mut walker, &skeleton, controls, frames);
                [Joint::Hips, Joint::Chest].map(|joint| {
                    let leans: Vec<f32> = frames.iter().map(|at| forwards(at, joint)).collect();
                    leans
                })
            };
            let stood = go(&Controls::STAND, 30);
            let begun = go(&walking(speed_mps), 60);
            let walked = go(&walking(speed_mps), 120);
            let stopped = go(&Controls::STAND, 90);
            for (index, [ahead, back]) in most.iter_mut().enumerate() {
                let steady = walked[index].iter().sum::<f32>() / 120.0;
                let upright = stood[index][29];
                bowed += (steady - upright).to_degrees() / 16.0;
                let beyond = |leans: &[f32], way: f32, even: f32| {
                    let leans = leans.iter().map(|lean| way * (lean - even));
                    leans.fold(0.0, f32::max).to_degrees()
                };
                *ahead += beyond(&begun[index], 1.0, steady) / 8.0;
                *back += beyond(&stopped[index], -1.0, upright) / 8.0;
                // Upright again.
                let rests = stopped[index][89] - upright;
                assert!(rests.abs() < 0.05, "seed {seed}: {rests} rad");
            }
        }
        // People are as upright walking as standing, and lean as they run.
        let even_deg = if speed_mps < 2.0 { -3.0..3.0 } else { 4.0..9.0 };
        assert!(even_deg.contains(&bowed), "{speed_mps} m/s: {bowed}°");
        for [ahead, back] in most {
            assert!(
                ahead_deg.contains(&ahead) && (10.0..18.0).contains(&back),
                "{speed_mps} m/s: {ahead}° ahead, {back}° back"
            );
        }
    }
}

/// Feet of O3DE's actor, running, land 0.10 m ahead of his hips, 0.40 where he loses 4.5 m/s², and behind them where he gains 3.
#[test]
fn feet_land_far_ahead_of_hips_that_brake_and_less_far_of_those_that_gain_speed() {
    let skeleton = Skeleton::standard();
    let [mut starts, mut runs, mut stops] = [const { Vec::new() }; 3];
    for seed in 1..9 {
        let mut walker = generator(Kind::Styled, seed);
        walker.stand();
        run(&mut walker, &skeleton, &Controls::STAND, 30);
        let mut landings = |controls: &Controls, frames: usize| {
            let (frames, _) = run(&mut walker, &skeleton, controls, frames);
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            let lands =
                |pair: &[Frame], side: usize| !pair[0].contact[side] && pair[1].contact[side];
            let mut ahead = Vec::new();
            for pair in frames.windows(2) {
                let place = |joint: Joint| pair[1].model.position(joint);
                let landed = Side::BOTH
                    .into_iter()
                    .filter(|side| lands(pair, side.index()));
                ahead.extend(landed.map(|side| {
                    let reach = place(side.foot()) - place(Joint::Hips);
                    (Quat::from_rotation_y(-pair[1].heading) * reach).z
                }));
            }
            ahead
        };
        starts.push(landings(&walking(3.0), 60)[0]);
        runs.extend(landings(&walking(3.0), 160));
        // A step may have begun.
        let stop = landings(&Controls::STAND, 60);
        stops.push(stop.into_iter().fold(0.0, f32::max));
    }
    let mean = |ahead: &[f32]| ahead.iter().sum::<f32>() / ahead.len() as f32;
    let [start, even, stop] = [starts, runs, stops].map(|ahead| mean(&ahead));
    assert!(
        start < even + 0.05,
        "{start} m ahead at a start, {even} m in a run"
    );
    assert!((stop - 0.4).abs() < 0.04, "{stop} m ahead at a stop");
}

/// Format 14 had no turn of the head, format 13 ended before the spread of the feet in a replanned step, format 12 before the part of a push that is still to come, format 11 before the lean of the standing leg.
#[test]
fn a_state_of_an_earlier_format_goes_on_as_it_did() {
    let skeleton = Skeleton::standard();
    for (format, missing) in [(14, 0), (13, 1), (12, 2), (11, 2 + size_of::<f32>())] {
        let mut walker = generator(Kind::Styled, 3);
        run(&mut walker, &skeleton, &walking(1.3), 200);
        let mut state = walker.state();
        assert_eq!(state[0], 15);
        state[0] = format;
        state.truncate(state.len() - missing);
        let mut other = generator(Kind::Styled, 4);
        other.restore(&state).unwrap();
        let [ours, others] =
            [walker, other].map(|mut walker| run(&mut walker, &skeleton, &walking(1.3), 100).0);
        for (ours, other) in ours.iter().zip(&others) {
            assert_eq!(ours.model, other.model, "format {format}");
        }
    }
}

/// Format 14 ends with the spread of the feet in a replanned step, format 15 with the turn of the head, which follows it.
#[test]
fn a_replanned_step_of_the_format_before_stands_on_the_same_feet() {
    let skeleton = Skeleton::standard();
    let turning = Controls {
        turn_rate_radps: 1.2,
        ..walking(1.3)
    };
    let mut replanned = 0;
    for frames in 1..40 {
        let mut walker = generator(Kind::Styled, 3);
        run(&mut walker, &skeleton, &walking(1.3), 200);
        for frame in 0..frames {
            let turn_rate_radps = if frame < 10 { -1.2 } else { 1.2 };
            let controls = Controls {
                turn_rate_radps,
                ..turning
            };
            run(&mut walker, &skeleton, &controls, 1);
        }
        let mut state = walker.state();
        state[0] = 14;
        state.truncate(state.len() - 2 * size_of::<f32>());
        let mut other = generator(Kind::Styled, 4);
        // Steps that were not replanned end without both.
        if other.restore(&state).is_err() {
            continue;
        }
        replanned += 1;
        let [ours, others] = [walker, other].map(|mut w| run(&mut w, &skeleton, &turning, 60).0);
        for (ours, other) in ours.iter().zip(&others) {
            for foot in Side::BOTH.map(Side::foot) {
                assert_eq!(ours.model.position(foot), other.model.position(foot));
            }
        }
    }
    assert!(replanned > 5, "{replanned}");
}
