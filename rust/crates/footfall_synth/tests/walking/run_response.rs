//! Runners obey in the middle of a stance: turns, changes of speed, and steps in which the gait changes.

use crate::quick::{assert_no_pop, assert_restores, hardest, interrupted, secs_until, turned_to};
use crate::running::ROLLING_MPS;
use crate::world::{Frame, Kind, assert_planted_within, generator, run, walking};
use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Skeleton};
use footfall_synth::Controls;

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

#[test]
fn a_change_in_the_middle_of_a_stance_is_obeyed_without_a_pop() {
    let skeleton = Skeleton::standard();
    let turning = Controls {
        turn_rate_radps: 2.0,
        ..walking(3.2)
    };
    for (index, controls) in [turning, walking(2.4), walking(4.0)].iter().enumerate() {
        let mut sooner = 0;
        for moment in 0..24 {
            let (frames, obeyed) = interrupted(3.2, 151 + moment, controls, 0.05);
            sooner += usize::from(obeyed);
            assert_planted_within(&skeleton, &frames, ROLLING_MPS);
            assert_no_pop(&frames[100..], [30.0, 55.0], &format!("{index}, {moment}"));
        }
        assert!(
            sooner > 4,
            "{index}: obeyed in the same step at {sooner} of 24 moments"
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
