//! Runners obey in the middle of a stance: turns, changes of speed, and steps in which the gait changes.

use crate::quick::{
    assert_no_pop, assert_restores, hardest, interrupted, secs_until, stood, turned_to,
};
use crate::running::ROLLING_MPS;
use crate::world::{DT, Frame, Kind, assert_planted_within, generator, run, walking};
use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;
use glam::Vec3;

/// Runs and then turns left by 90°, steered by what is left of the turn; returns all frames.
fn turned(seed: u64, speed_mps: f32, before: usize) -> Vec<Frame> {
    let skeleton = Skeleton::standard();
    let mut walker = generator(Kind::Styled, seed);
    let (mut frames, _) = run(&mut walker, &skeleton, &walking(speed_mps), before);
    frames.extend(turned_to(&mut walker, (FRAC_PI_2, speed_mps), 120));
    frames
}

#[test]
fn a_runner_turns_within_half_a_second_and_no_farther_than_asked() {
    const SPEED_MPS: f32 = 3.0;
    let skeleton = Skeleton::standard();
    let mut secs = Vec::new();
    for seed in 1..5 {
        for before in (200..222).step_by(3) {
            let frames = turned(seed, SPEED_MPS, before);
            secs.push(secs_until(&frames, before, |velocity| {
                velocity.x > 0.8 * SPEED_MPS
            }));
            let headings = frames.iter().map(|frame| frame.heading);
            let farthest = headings.fold(0.0, f32::max) - FRAC_PI_2;
            assert!(farthest < 0.25, "seed {seed}: {farthest} rad too far");
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            let hardest = hardest(&frames[100..], Joint::Hips);
            assert!(hardest < 30.0, "seed {seed}, {before}: hips {hardest} m/s²");
        }
    }
    let mean = secs.iter().sum::<f32>() / secs.len() as f32;
    assert!(mean < 0.55, "{mean} s");
}

/// Steps as long as those of a steady walk would be lunges, and hips were thrown aside over the first foot of a run that landed in a turn.
#[test]
fn who_sets_out_for_a_run_takes_short_steps_and_does_not_lurch() {
    const SPEED_MPS: f32 = 3.0;
    let skeleton = Skeleton::standard();
    let (mut secs, mut first_steps) = (Vec::new(), Vec::new());
    for seed in 1..20 {
        for turn in [0.0, FRAC_PI_2] {
            let (mut walker, standing) = stood(seed, 20);
            let frames = turned_to(&mut walker, (turn, SPEED_MPS), 150);
            let of_foot = |side: Side| move |frame: &Frame| frame.contact[side.index()];
            let landed = Side::BOTH.map(|side| {
                let leaves = frames.iter().position(|frame| !of_foot(side)(frame));
                let flown = frames.iter().skip(leaves.unwrap());
                leaves.unwrap() + flown.clone().position(of_foot(side)).unwrap()
            });
            if turn == 0.0 {
                first_steps.push(landed[0].min(landed[1]) as f32 * DT);
            }
            let way = |velocity: Vec3| velocity.x * turn.sin() + velocity.z * turn.cos();
            let frames: Vec<Frame> = standing.into_iter().chain(frames).collect();
            secs.push(secs_until(&frames, 20, |velocity| {
                way(velocity) > 0.8 * SPEED_MPS
            }));
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            let hardest = hardest(&frames, Joint::Hips);
            assert!(hardest < 40.0, "seed {seed}, {turn}: hips {hardest} m/s²");
        }
    }
    let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
    assert!(mean(&secs) < 0.58, "{} s", mean(&secs));
    assert!(mean(&first_steps) < 0.36, "first steps {first_steps:?} s");
}

/// O3DE's actor stops from 3.4 m/s in four to six steps of 0.18 to 0.28 s; one long step would brake over one deeply bent knee.
#[test]
fn who_stops_from_a_run_takes_quick_steps() {
    let skeleton = Skeleton::standard();
    let mut secs = Vec::new();
    for seed in 1..13 {
        let mut walker = generator(Kind::Styled, seed);
        let before = 150 + 7 * seed as usize;
        run(&mut walker, &skeleton, &walking(3.4), before);
        let (frames, _) = run(&mut walker, &skeleton, &Controls::STAND, 120);
        assert_planted_within(&skeleton, &frames, ROLLING_MPS);
        let lands = |pair: &[Frame]| {
            let [before, after] = [pair[0].contact, pair[1].contact];
            (0..2).any(|side| !before[side] && after[side])
        };
        let pairs = frames.windows(2).enumerate();
        let landings: Vec<usize> = pairs
            .filter_map(|(at, pair)| lands(pair).then_some(at))
            .collect();
        let steps = landings.windows(2).map(|pair| pair[1] - pair[0]);
        secs.extend(steps.map(|frames| frames as f32 * DT));
    }
    assert!(secs.len() >= 30, "twelve walkers take {} steps", secs.len());
    let mean = secs.iter().sum::<f32>() / secs.len() as f32;
    assert!(mean < 0.32, "{mean} s from landing to landing");
}

/// Hips that go as far in a step as the generated leg has them keep the speed of the run over a quick step, lose two thirds of it over the next foot, and gain
/// some back. O3DE's actor brakes by 2 to 5 m/s² as he stops.
#[test]
fn who_slows_down_from_a_run_brakes_evenly() {
    let skeleton = Skeleton::standard();
    for to_mps in [1.3, 0.0] {
        for seed in 1..13 {
            let mut walker = generator(Kind::Styled, seed);
            let before = 150 + 7 * seed as usize;
            run(&mut walker, &skeleton, &walking(3.2), before);
            let (frames, _) = run(&mut walker, &skeleton, &walking(to_mps), 75);
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            // Over a tenth of a second, in which no single frame counts.
            let secs = 6.0 * DT;
            let hips = |frame: &Frame| frame.model.position(Joint::Hips).with_y(0.0);
            let ways = frames
                .windows(7)
                .map(|all| hips(&all[0]).distance(hips(&all[6])));
            let speeds: Vec<f32> = ways.map(|way| way / secs).collect();
            if to_mps > 0.0 {
                let slowest = speeds.iter().copied().fold(f32::MAX, f32::min);
                assert!(slowest >= 0.95, "seed {seed}: {slowest} m/s");
            }
            let losses = speeds.windows(7).map(|all| (all[0] - all[6]) / secs);
            let braking = losses.fold(0.0, f32::max);
            assert!(
                braking < 8.0,
                "to {to_mps} m/s, seed {seed}: {braking} m/s²"
            );
        }
    }
}

#[test]
fn a_change_in_the_middle_of_a_stance_is_obeyed_without_a_pop() {
    let skeleton = Skeleton::standard();
    let turning = Controls {
        turn_rate_radps: 2.0,
        ..walking(3.2)
    };
    for (index, controls) in [turning, walking(2.4), walking(4.0)].iter().enumerate() {
        let mut sooner = 0;
        // Two steps and more: how many moments of one step can obey depends on its stance.
        for moment in 0..48 {
            let (frames, obeyed) = interrupted(3.2, 151 + moment, controls, 0.05);
            sooner += usize::from(obeyed);
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            assert_no_pop(&frames[100..], [30.0, 55.0], &format!("{index}, {moment}"));
        }
        assert!(
            sooner > 8,
            "{index}: obeyed in the same step at {sooner} of 48 moments"
        );
    }
}

#[test]
fn a_run_that_was_planned_anew_goes_on_from_a_saved_state_bit_for_bit() {
    let skeleton = Skeleton::standard();
    let turning = |speed_mps: f32| Controls {
        turn_rate_radps: 1.5,
        ..walking(speed_mps)
    };
    // In a run, in the first step of one, and in the first step of a walk.
    for [from, to] in [[3.0, 3.3], [1.4, 3.0], [3.0, 1.2]] {
        for before in (150..178).step_by(3) {
            let mut walker = generator(Kind::Styled, 11);
            run(&mut walker, &skeleton, &walking(from), before);
            run(&mut walker, &skeleton, &walking(to), 14);
            run(&mut walker, &skeleton, &turning(to), 3);
            let when = format!("{from} to {to} m/s, {before} frames");
            assert_restores(walker, 120, |_| turning(to), &when);
        }
    }
}
