//! Stops: feet that come together, and bodies that stand.

use crate::quick::{assert_no_pop, assert_restores};
use crate::strafing::{directions, going};
use crate::world::{Frame, Kind, assert_planted_within, generator, run, walking};
use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::{Controls, GaitGenerator};

/// Walks at this velocity, stops after some frames, and walks off two seconds later; returns all frames, and the number of the one in which it is to stop.
fn stopped(controls: &Controls, before: usize) -> (Vec<Frame>, usize) {
    let skeleton = Skeleton::standard();
    let mut walker = generator(Kind::Styled, 3);
    let (mut frames, _) = run(&mut walker, &skeleton, controls, before);
    frames.extend(run(&mut walker, &skeleton, &Controls::STAND, STOOD).0);
    frames.extend(run(&mut walker, &skeleton, &walking(1.3), 60).0);
    let when = format!("{controls:?}, {before}");
    assert_planted_within(&skeleton, &frames, 0.05);
    assert_no_pop(&frames[100..], [30.0, 50.0], &when);
    (frames, before)
}

/// Frames from the request to stop until the walker sets out again.
const STOOD: usize = 120;

/// Stops requested at every moment of a sidestep.
#[test]
fn whoever_stops_sidestepping_brings_the_trailing_foot_to_the_other() {
    for (sign, leading) in [(1.0, Side::Left), (-1.0, Side::Right)] {
        for speed in [0.4, 0.8, 1.4] {
            for moment in 0..18 {
                let controls = going(sign * FRAC_PI_2, speed);
                let (frames, asked) = stopped(&controls, 150 + 3 * moment);
                let stood = &frames[asked - 1..asked + STOOD];
                let outwards =
                    |frame: &Frame, foot: Side| sign * frame.model.position(foot.foot()).x;
                let farthest = stood
                    .iter()
                    .filter(|frame| frame.contact[leading.index()])
                    .map(|frame| outwards(frame, leading))
                    .fold(f32::MIN, f32::max);
                let last = &stood[STOOD];
                let back = farthest - outwards(last, leading);
                assert!(back < 0.03, "{controls:?}, {asked}: {back} m back");
                let apart = outwards(last, leading) - outwards(last, leading.other());
                assert!(
                    (0.1..0.3).contains(&apart),
                    "{controls:?}, {asked}: {apart} m"
                );
            }
        }
    }
}

/// They came to rest as they had walked, on bent knees and over one leg, and leant to 17 cm ahead of their ankles in the end.
#[test]
fn whoever_stops_stands_upright_whichever_way_it_went() {
    for direction in directions() {
        for moment in 0..12 {
            let controls = going(direction, 0.8);
            let (frames, asked) = stopped(&controls, 150 + 4 * moment);
            // Later it sways.
            let last = &frames[asked + 65];
            let [hips, left, right] = [Joint::Hips, Joint::LeftFoot, Joint::RightFoot]
                .map(|joint| last.model.position(joint));
            let off = hips - 0.5 * (left + right);
            let when = format!("{direction}, {asked}: {off}");
            assert!((0.86..0.9).contains(&off.y), "{when}");
            assert!(
                (-0.01..0.07).contains(&off.z) && off.x.abs() < 0.06,
                "{when}"
            );
        }
    }
}

/// Lean of the body from the hips to the neck, forwards, degrees.
fn lean(frame: &Frame) -> f32 {
    let up = frame.model.position(Joint::Neck) - frame.model.position(Joint::Hips);
    (up.z / up.y).atan().to_degrees()
}

/// Walks, stops, and returns in the frame in which it stands, with the frames since it was to stop.
fn rested(seed: u64, standing_motion: f32) -> (GaitGenerator, Vec<Frame>) {
    let skeleton = Skeleton::standard();
    let mut walker = generator(Kind::Styled, seed);
    walker.set_standing_motion(standing_motion);
    run(
        &mut walker,
        &skeleton,
        &walking(1.3),
        150 + 5 * seed as usize,
    );
    let mut frames = Vec::new();
    while !walker.is_standing() {
        frames.extend(run(&mut walker, &skeleton, &Controls::STAND, 1).0);
    }
    (walker, frames)
}

/// O3DE's actor leans back by 4° as his feet come to rest after a walk, by 3.5°, 2°, 1.1° and 0.7° a tenth of a second later, three, five and six tenths. Walkers were upright within a tenth
/// of a second before they landed.
#[test]
fn whoever_stops_leans_back_and_rights_itself_over_half_a_second() {
    let skeleton = Skeleton::standard();
    for (seed, alive) in (1..9).zip([1.0, 0.0].into_iter().cycle()) {
        let (mut walker, mut frames) = rested(seed, alive);
        let rests = frames.len() - 1;
        frames.extend(run(&mut walker, &skeleton, &Controls::STAND, 60).0);
        let back = |frame: usize| lean(&frames[rests + 60]) - lean(&frames[rests + frame]);
        let spread = 2.0 * alive;
        assert!(
            (1.5..6.0 + spread).contains(&back(0)),
            "{seed}: {}°",
            back(0)
        );
        let half = back(18) / back(0);
        assert!((0.2..0.7).contains(&half), "{seed}: {half} of it is left");
        assert!(back(36) < 1.0 + spread, "{seed}: {}°", back(36));
        frames.extend(run(&mut walker, &skeleton, &walking(1.3), 60).0);
        assert_planted_within(&skeleton, &frames, 0.05);
        assert_no_pop(&frames, [30.0, 50.0], "stopped and gone on");
    }
}

#[test]
fn a_body_that_rights_itself_goes_on_from_a_saved_state_bit_for_bit() {
    for stood in [0, 12, 40] {
        let (mut walker, _) = rested(5, 1.0);
        run(&mut walker, &Skeleton::standard(), &Controls::STAND, stood);
        // It walks off before it is upright, too.
        assert_eq!(
            walker.state()[0],
            16,
            "the format with bodies that right themselves"
        );
        let goes = |frame: usize| {
            if frame < 20 {
                Controls::STAND
            } else {
                walking(1.3)
            }
        };
        assert_restores(walker, 60, goes, "righting itself");
    }
}
