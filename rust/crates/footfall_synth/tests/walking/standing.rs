//! Stopping, standing and turning on the spot.

use crate::world::{
    Frame, KINDS, assert_continuous, assert_planted, assert_smooth, generator, run, walking,
};
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;
use glam::Vec3;

/// Somebody stands in both frames: feet on one place, hips no farther than people sway.
fn assert_stays(first: &Frame, last: &Frame) {
    for side in Side::BOTH {
        let [from, to] = [first, last].map(|frame| frame.model.position(side.foot()));
        assert!(from.distance(to) < 1e-3, "its {side:?} foot moves");
    }
    let [from, to] = [first, last].map(|frame| frame.model.position(Joint::Hips));
    assert!(from.distance(to) < 0.08, "its hips go from {from} to {to}");
}

/// Distance between two frames at their most distant joint.
fn distance(a: &Frame, b: &Frame) -> f32 {
    let joints = a.model.positions.iter().zip(&b.model.positions);
    joints.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn a_walker_stops_within_two_steps_stands_and_walks_on() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        for seed in 1..5 {
            let mut generator = generator(kind, seed);
            run(&mut generator, &skeleton, &walking(1.3), 200);
            let (mut frames, footsteps) = run(&mut generator, &skeleton, &Controls::STAND, 240);
            assert!(footsteps.len() <= 2, "{} steps to stop", footsteps.len());
            let (first, last) = (&frames[150], &frames[239]);
            assert_stays(first, last);
            assert_eq!(last.contact, [true; 2]);
            let feet = Side::BOTH.map(|side| last.model.position(side.foot()));
            let apart = (feet[0] - feet[1]).dot(last.model.rotation(Joint::Hips) * Vec3::Z);
            assert!(apart.abs() < 0.12, "feet stand {apart} m apart");
            let hips = last.model.position(Joint::Hips).y;
            assert!(
                (0.95..1.0).contains(&hips),
                "it stands with its hips at {hips} m"
            );
            let (on, footsteps) = run(&mut generator, &skeleton, &walking(1.3), 300);
            assert!(footsteps.len() > 6);
            frames.extend(on);
            assert_planted(&skeleton, &frames);
            assert_continuous(kind, &frames);
        }
    }
}

#[test]
fn it_can_begin_standing() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let mut generator = generator(kind, 2);
        generator.stand();
        generator.set_standing_motion(0.0);
        let (mut frames, footsteps) = run(&mut generator, &skeleton, &Controls::STAND, 30);
        assert!(footsteps.is_empty());
        assert!(distance(&frames[0], &frames[29]) < 1e-6);
        assert!(frames[0].place.length() < 1e-6);
        frames.extend(run(&mut generator, &skeleton, &walking(1.0), 120).0);
        assert!(frames[149].place.z > 0.8);
        let hips = |frame: usize| frames[frame].model.position(Joint::Hips).y;
        assert!(
            (hips(30) - hips(29)).abs() < 5e-4,
            "setting out makes it sag"
        );
        assert_planted(&skeleton, &frames);
        assert_continuous(kind, &frames);
    }
}

#[test]
fn turning_without_speed_turns_in_place() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let mut generator = generator(kind, 6);
        generator.stand();
        let controls = Controls {
            speed_mps: 0.0,
            turn_rate_radps: 1.0,
            ..Controls::STAND
        };
        let (frames, footsteps) = run(&mut generator, &skeleton, &controls, 300);
        let last = frames.last().unwrap();
        assert!(last.place.length() < 0.35, "it went {}", last.place);
        assert!(footsteps.len() >= 4);
        let mut turned = 0.0;
        for pair in frames.windows(2) {
            turned += footfall_core::rotation::wrap_angle(pair[1].heading - pair[0].heading);
        }
        assert!((4.0..5.2).contains(&turned), "it turned by {turned}");
        assert_planted(&skeleton, &frames);
        // A foot that leaves a place that it does not roll off does so at once: knees come to 140 m/s².
        assert_smooth(&frames, 0.04);
    }
}
