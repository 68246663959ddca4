//! Looking: heads turn into turns, ahead of the body.

use crate::quick::assert_restores;
use crate::world::{DT, Frame, Kind, generator, run, walking};
use footfall_core::rotation::{heading, wrap_angle};
use footfall_core::{Joint, Skeleton};
use footfall_synth::Controls;

fn turning(speed_mps: f32, turn_dps: f32) -> Controls {
    Controls {
        turn_rate_radps: turn_dps.to_radians(),
        ..walking(speed_mps)
    }
}

/// Turn of the head relative to the hips, degrees.
fn look(frame: &Frame) -> f32 {
    let [hips, head] = [Joint::Hips, Joint::Head].map(|joint| heading(frame.model.rotation(joint)));
    wrap_angle(head - hips).to_degrees()
}

/// The turns are those of O3DE's actor. Heads did not turn.
#[test]
fn heads_look_into_turns_as_those_of_people() {
    let skeleton = Skeleton::standard();
    for (speed_mps, turn_dps, people_deg) in [
        (1.3, 20.0, 7.0),
        (1.3, 45.0, 18.0),
        (1.3, 80.0, 24.0),
        (1.3, 130.0, 29.0),
        (2.8, 45.0, 18.0),
        (2.8, 80.0, 25.0),
        (0.0, 45.0, 8.0),
        (0.0, 80.0, 17.0),
        (0.0, 130.0, 21.0),
    ] {
        let looks = [1.0, -1.0].map(|side| {
            let controls = turning(speed_mps, side * turn_dps);
            let mut walker = generator(Kind::Styled, 2);
            run(&mut walker, &skeleton, &controls, 120);
            let (frames, _) = run(&mut walker, &skeleton, &controls, 480);
            frames.iter().map(look).sum::<f32>() / frames.len() as f32
        });
        let into_turn = 0.5 * (looks[0] - looks[1]);
        assert!(
            (into_turn - people_deg).abs() < 4.0,
            "{into_turn}° at {speed_mps} m/s and {turn_dps} °/s"
        );
    }
}

/// Seconds until a heading has turned by so many degrees.
fn secs_until(headings: impl Iterator<Item = f32>, turned_deg: f32) -> f32 {
    let mut headings = headings.peekable();
    let first = *headings.peek().unwrap();
    let frame = headings.position(|now| wrap_angle(now - first).to_degrees() > turned_deg);
    frame.unwrap() as f32 * DT
}

#[test]
fn a_head_turns_before_the_body() {
    let skeleton = Skeleton::standard();
    let mut ahead = 0.0;
    for seed in 1..=8 {
        let mut walker = generator(Kind::Styled, seed);
        run(&mut walker, &skeleton, &walking(1.3), 200);
        let (frames, _) = run(&mut walker, &skeleton, &turning(1.3, 60.0), 120);
        let head = frames
            .iter()
            .map(|frame| heading(frame.model.rotation(Joint::Head)));
        let body = frames.iter().map(|frame| frame.heading);
        ahead += (secs_until(body, 20.0) - secs_until(head, 20.0)) / 8.0;
    }
    assert!(ahead > 0.15, "{ahead} s");
}

/// The head of O3DE's actor turns by up to 220 °/s relative to his hips. A runner's turns by up to 126 °/s, and changes by 93 °/s in a frame, without looking anywhere.
#[test]
fn heads_do_not_jerk_however_a_player_steers() {
    let skeleton = Skeleton::standard();
    for (seed, speed_mps, most_dps, most_change) in [
        (1, 1.3, 240.0, 75.0),
        (2, 0.0, 240.0, 75.0),
        (3, 3.0, 320.0, 140.0),
        (4, 1.3, 240.0, 75.0),
    ] {
        let mut walker = generator(Kind::Styled, seed);
        run(&mut walker, &skeleton, &turning(speed_mps, 30.0), 120);
        let frames = (0..60_u16).flat_map(|index| {
            let turn_dps = 30.0 * f32::from(index * 5 % 7) - 90.0;
            run(&mut walker, &skeleton, &turning(speed_mps, turn_dps), 9).0
        });
        let looks: Vec<f32> = frames
            .map(|frame| wrap_angle(heading(frame.model.rotation(Joint::Head)) - frame.heading))
            .collect();
        let rates = looks
            .windows(2)
            .map(|pair| ((pair[1] - pair[0]) / DT).to_degrees());
        let rates: Vec<f32> = rates.collect();
        let fastest = rates.iter().copied().map(f32::abs).fold(0.0, f32::max);
        let changes = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let hardest = changes.fold(0.0, f32::max);
        assert!(
            fastest < most_dps && hardest < most_change,
            "at {speed_mps} m/s: {fastest} °/s, changed by {hardest} °/s in a frame"
        );
    }
}

#[test]
fn a_head_that_turns_is_restored() {
    let skeleton = Skeleton::standard();
    let controls = |frame: usize| {
        turning(
            1.3,
            if (frame / 11).is_multiple_of(2) {
                70.0
            } else {
                -70.0
            },
        )
    };
    for frames in (3..60).step_by(7) {
        let mut walker = generator(Kind::Styled, 1);
        run(&mut walker, &skeleton, &walking(1.3), 200);
        for frame in 0..frames {
            run(&mut walker, &skeleton, &controls(frame), 1);
        }
        let controls = |frame: usize| controls(frames + frame);
        assert_restores(walker, 60, controls, &format!("after {frames} frames"));
    }
}
