//! First foot of a walk from standing.

use crate::quick::{assert_no_pop, stood};
use crate::walking;
use crate::world::{Frame, assert_planted_within, run};
use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;

/// Time after which walkers are asked to go, frames.
const WAITS: [usize; 3] = [40, 190, 420];

/// Returns the foot that leaves the ground first, and how far the hips are to the left of the middle of the feet as the walker, which faces +Z, is asked to go.
fn first_lifted(controls: &Controls, seed: u64, wait: usize) -> (Side, f32) {
    let skeleton = Skeleton::standard();
    let (mut walker, mut frames) = stood(seed, wait);
    let aside = hips_aside(frames.last().unwrap());
    frames.extend(run(&mut walker, &skeleton, controls, 120).0);
    let when = format!("seed {seed}, {wait}");
    assert_planted_within(&skeleton, &frames, 0.02);
    assert_no_pop(&frames[wait - 2..], [30.0, 50.0], &when);
    let lifted = |frame: &Frame| {
        Side::BOTH
            .into_iter()
            .find(|side| !frame.contact[side.index()])
    };
    let side = frames[wait..].iter().find_map(lifted);
    (side.unwrap_or_else(|| panic!("{when}: no step")), aside)
}

fn hips_aside(frame: &Frame) -> f32 {
    let x = |joint: Joint| frame.model.position(joint).x;
    x(Joint::Hips) - 0.5 * (x(Joint::LeftFoot) + x(Joint::RightFoot))
}

#[test]
fn whoever_goes_aside_or_turns_lifts_the_foot_of_that_side() {
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let aside = Controls {
            direction_rad: sign * FRAC_PI_2,
            ..walking(0.8)
        };
        let on_the_spot = Controls {
            turn_rate_radps: sign,
            ..Controls::STAND
        };
        let leaving = Controls {
            turn_rate_radps: 1.5 * sign,
            ..walking(1.3)
        };
        for controls in [aside, on_the_spot, leaving] {
            for (seed, wait) in (1..7).zip(WAITS.into_iter().cycle()) {
                let (first, _) = first_lifted(&controls, seed, wait);
                assert_eq!(first, side, "{controls:?}, seed {seed}, {wait}");
            }
        }
    }
}

#[test]
fn whoever_stands_on_one_leg_more_lifts_the_other() {
    let mut lifted = [0, 0];
    for seed in 1..9 {
        for wait in WAITS {
            let (first, aside) = first_lifted(&walking(1.3), seed, wait);
            if aside.abs() > 0.015 {
                let other = if aside > 0.0 { Side::Right } else { Side::Left };
                assert_eq!(first, other, "seed {seed}, {wait}: hips {aside} m aside");
                lifted[first.index()] += 1;
            }
        }
    }
    assert!(lifted.iter().all(|count| *count > 2), "{lifted:?}");
}
