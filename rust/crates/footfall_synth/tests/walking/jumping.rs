//! Jumps and crouches: parabolas, planted feet, places that are reached.

use crate::quick::hardest;
use crate::world::{
    DT, Frame, Kind, assert_planted_within, assert_smooth, config, generator, model, run, space,
    walking,
};
use footfall_core::{Joint, Pose, Skeleton};
use footfall_synth::{Controls, GaitGenerator, JumpPhase, StyleSpace};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const GRAVITY_MPS2: f32 = 9.81;

/// Somebody who has stood for a second.
pub(crate) fn stander(seed: u64) -> GaitGenerator {
    let mut generator = generator(Kind::Styled, seed);
    generator.stand();
    run(&mut generator, &Skeleton::standard(), &Controls::STAND, 60);
    generator
}

pub(crate) fn hips(frame: &Frame) -> f32 {
    frame.model.position(Joint::Hips).y
}

/// Rise of the hips above their mean height in the half second before.
pub(crate) fn rise(before: &[Frame], frames: &[Frame]) -> f32 {
    let last = &before[before.len() - 30..];
    let level = last.iter().map(hips).sum::<f32>() / 30.0;
    frames.iter().map(hips).fold(0.0, f32::max) - level
}

/// No joint's velocity changes by more between two frames than in captured jumps (seven of the CMU corpus and the O3DE take, 60 fps): hips 30 to 63 mm a
/// frame, knees 22 to 91, feet 89 to 183 as they land.
pub(crate) fn assert_no_pop(frames: &[Frame]) {
    assert_no_pop_beyond(1.0, frames);
}

/// The same, with limits of this many times as much.
pub(crate) fn assert_no_pop_beyond(share: f32, frames: &[Frame]) {
    for (index, triple) in frames.windows(3).enumerate() {
        for (joint, most) in [
            (Joint::Hips, 0.02),
            (Joint::Head, 0.025),
            (Joint::LeftHand, 0.05),
            (Joint::LeftLowerLeg, 0.065),
            (Joint::RightLowerLeg, 0.065),
            (Joint::LeftFoot, 0.08),
            (Joint::RightFoot, 0.08),
        ] {
            let [a, b, c] = [0, 1, 2].map(|at: usize| triple[at].model.position(joint));
            let jolt = (a - 2.0 * b + c).length();
            assert!(
                jolt < share * most,
                "{joint:?} by {jolt} m in frame {index}"
            );
        }
    }
}

pub(crate) fn assert_ballistic(frames: &[Frame]) {
    let mut flown = 0;
    for window in frames.windows(3) {
        if window.iter().any(|frame| frame.contact != [false; 2]) {
            continue;
        }
        let [before, now, next] = [0, 1, 2].map(|index: usize| hips(&window[index]));
        let acceleration = (next - 2.0 * now + before) / (DT * DT);
        assert!(
            (acceleration + GRAVITY_MPS2).abs() < 0.3,
            "{acceleration} m/s² in the air"
        );
        flown += 1;
    }
    assert!(flown > 8, "only {flown} frames in the air");
}

#[test]
fn who_stands_jumps_as_high_as_asked_on_a_parabola() {
    let skeleton = Skeleton::standard();
    for (seed, asked) in [(1, 0.1), (2, 0.25), (3, 0.4), (4, 0.55)] {
        let mut generator = stander(seed);
        let (before, _) = run(&mut generator, &skeleton, &Controls::STAND, 40);
        assert!(generator.jump(asked));
        let (frames, footsteps) = run(&mut generator, &skeleton, &Controls::STAND, 150);
        let risen = rise(&before, &frames);
        assert!((risen / asked - 1.0).abs() < 0.05, "{risen} for {asked} m");
        assert_ballistic(&frames);
        assert_planted_within(&skeleton, &frames, 0.005);
        assert_no_pop(&frames);
        assert_eq!(footsteps.len(), 2, "both feet land");
        assert!(generator.is_standing() && generator.jump_phase().is_none());
        let way = generator.start_from_character().position.length();
        assert!(way < 1e-4, "came {way} m away from the spot");
    }
}

/// Checks that the hips neither fall faster than a body can into the dip nor stop on the way, and come to rest as it stands up.
#[test]
fn a_jump_is_one_movement_down_and_up() {
    let skeleton = Skeleton::standard();
    for (seed, asked) in [(1, 0.2), (2, 0.3), (3, 0.4), (4, 0.5)] {
        let mut generator = stander(seed);
        let (mut frames, _) = run(&mut generator, &skeleton, &Controls::STAND, 2);
        generator.jump(asked);
        frames.extend(run(&mut generator, &skeleton, &Controls::STAND, 150).0);
        let heights: Vec<f32> = frames.iter().map(hips).collect();
        let takes_off = frames.iter().position(|frame| frame.contact == [false; 2]);
        let takes_off = takes_off.expect("the walker leaves the ground");
        let load = &heights[..takes_off];
        let drops = load.windows(3).map(|at| at[0] - 2.0 * at[1] + at[2]);
        let drop = drops.fold(0.0, f32::min) / (DT * DT);
        assert!(drop > -1.05 * GRAVITY_MPS2, "{drop} m/s² down");
        let lowest = (0..load.len()).min_by(|a, b| load[*a].total_cmp(&load[*b]));
        let lowest = lowest.expect("the load has frames");
        let (down, up) = load.split_at(lowest);
        // Breathing moves the hips by fractions of a millimetre.
        assert!(down.windows(2).all(|at| at[1] < at[0] + 5e-4), "{down:?}");
        assert!(up.windows(2).all(|at| at[1] > at[0] - 5e-4), "{up:?}");
        let slowest = down.windows(2).map(|at| at[0] - at[1]);
        let middle = &slowest.collect::<Vec<f32>>()[down.len() / 4..down.len() * 3 / 4];
        let pauses = middle.iter().fold(f32::MAX, |least, fall| least.min(*fall));
        assert!(pauses > 0.3 * DT, "{} m/s in the dip", pauses / DT);
        let settles = hardest(&frames[frames.len() - 60..], Joint::Hips);
        assert!(settles < 3.0, "{settles} m/s² as the walker stands");
    }
}

/// Returns how far the hands are ahead of the shoulders of a walker who faces +Z, metres.
fn reach(frame: &Frame) -> f32 {
    let ahead = |joint: Joint| frame.model.position(joint).z;
    let hands = ahead(Joint::LeftHand) + ahead(Joint::RightHand);
    0.5 * (hands - ahead(Joint::LeftUpperArm) - ahead(Joint::RightUpperArm))
}

#[test]
fn arms_swing_back_in_the_dip_and_up_with_the_push_and_further_in_high_jumps() {
    let skeleton = Skeleton::standard();
    let swings = [0.15, 0.35].map(|asked| {
        let mut generator = stander(3);
        let (mut frames, _) = run(&mut generator, &skeleton, &Controls::STAND, 2);
        generator.jump(asked);
        frames.extend(run(&mut generator, &skeleton, &Controls::STAND, 60).0);
        let takes_off = frames.iter().position(|frame| frame.contact == [false; 2]);
        let load = &frames[..takes_off.expect("the walker leaves the ground")];
        let reaches: Vec<f32> = load.iter().map(reach).collect();
        let back = (0..reaches.len()).min_by(|a, b| reaches[*a].total_cmp(&reaches[*b]));
        let back = back.expect("the load has frames");
        // Hands are behind before the hips are lowest, and ahead as the feet leave the ground.
        let lowest = (0..load.len()).min_by(|a, b| hips(&load[*a]).total_cmp(&hips(&load[*b])));
        assert!(Some(back) < lowest, "{back} {lowest:?}");
        let last = reaches.last().expect("the load has frames");
        [reaches[0] - reaches[back], last - reaches[back]]
    });
    let [low, high] = swings;
    assert!(high[0] > 0.2 && high[1] > 0.5, "{high:?} m");
    assert!(
        low[0] < 0.7 * high[0] && low[1] < 0.7 * high[1],
        "{low:?} of {high:?} m"
    );
}

#[test]
fn phases_follow_each_other_and_feet_bear_but_in_the_flight() {
    let mut generator = stander(5);
    generator.jump(0.3);
    let mut phases = Vec::new();
    let mut pose = Pose::default();
    for _ in 0..150 {
        generator.step(DT, &Controls::STAND, &mut pose);
        let phase = generator.jump_phase();
        let bears = generator.feet_in_contact() == [true; 2];
        assert_eq!(bears, phase != Some(JumpPhase::Flight));
        if phases.last() != Some(&phase) {
            phases.push(phase);
        }
    }
    let expected = [
        Some(JumpPhase::Load),
        Some(JumpPhase::Flight),
        Some(JumpPhase::Landing),
        None,
    ];
    assert_eq!(phases, expected);
}

#[test]
fn a_jump_lands_where_it_was_sent() {
    let skeleton = Skeleton::standard();
    for (seed, place) in [
        (1, Vec3::new(0.0, 0.0, 1.2)),
        (2, Vec3::new(0.3, 0.0, 0.6)),
        (3, Vec3::new(0.0, 0.3, 0.5)),
        (4, Vec3::new(-0.1, -0.6, 0.8)),
    ] {
        let mut generator = stander(seed);
        assert!(generator.jump_to(place));
        let (frames, footsteps) = run(&mut generator, &skeleton, &Controls::STAND, 180);
        let came = generator.start_from_character().position;
        let left_out = frames[0].model.position(Joint::LeftFoot) + place;
        let foot = frames.last().unwrap().model.position(Joint::LeftFoot);
        assert!(came.distance(place) < 1e-3, "{came} for {place}");
        assert!(foot.distance(left_out) < 0.01, "foot at {foot}");
        assert_eq!(footsteps.len(), 2);
        assert!((footsteps[0].position.y - place.y).abs() < 1e-4);
        assert_ballistic(&frames);
        assert_no_pop(&frames);
        run(&mut generator, &skeleton, &walking(1.3), 120);
        let height = generator.start_from_character().position.y;
        assert!((height - place.y).abs() < 1e-4, "walks on at {height}");
    }
}

#[test]
fn who_goes_sideways_stands_first_and_goes_on_after_it() {
    let skeleton = Skeleton::standard();
    let controls = Controls {
        direction_rad: 1.5,
        ..walking(0.6)
    };
    let mut generator = generator(Kind::Styled, 3);
    run(&mut generator, &skeleton, &controls, 180);
    generator.jump(0.3);
    let (frames, _) = run(&mut generator, &skeleton, &controls, 300);
    assert_ballistic(&frames);
    assert!(!generator.is_standing(), "goes on");
    let aloft = |frame: &&Frame| frame.contact == [false; 2];
    let flight = frames.iter().filter(aloft).count();
    assert!((20..45).contains(&flight), "{flight} frames in the air");
}

#[test]
fn asking_again_or_for_nonsense_changes_nothing() {
    let skeleton = Skeleton::standard();
    let mut generator = stander(1);
    for nonsense in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(!generator.jump(nonsense), "{nonsense}");
        assert!(!generator.jump_to(Vec3::new(0.0, nonsense * 0.0, f32::NAN)));
    }
    generator.jump(0.3);
    run(&mut generator, &skeleton, &Controls::STAND, 50);
    generator.jump(0.5);
    let (frames, _) = run(&mut generator, &skeleton, &Controls::STAND, 200);
    let landings = frames
        .windows(2)
        .filter(|pair| pair[0].contact == [false; 2] && pair[1].contact == [true; 2])
        .count();
    assert_eq!(landings, 1);

    let nobody_jumps = footfall_model::GaitModel {
        jump: None,
        crouch: None,
        ..(*model()).clone()
    };
    let space = Arc::new(StyleSpace::new(&Arc::new(nobody_jumps), &[]).unwrap());
    let mut generator = GaitGenerator::new(&space, &[], &skeleton, &config(1)).unwrap();
    assert!(!generator.jump(0.3));
    assert!(!self::generator(Kind::Switching, 1).jump(0.3));
}

#[test]
fn who_crouches_is_lower_on_the_same_feet_and_slower() {
    let skeleton = Skeleton::standard();
    let mut generator = stander(2);
    let crouching = |speed: f32| Controls {
        crouch: 1.0,
        ..walking(speed)
    };
    let (before, _) = run(&mut generator, &skeleton, &Controls::STAND, 30);
    let (frames, _) = run(&mut generator, &skeleton, &crouching(0.0), 90);
    let sunk = hips(&before[29]) - hips(&frames[89]);
    assert!((0.12..0.35).contains(&sunk), "{sunk} m lower");
    assert_planted_within(&skeleton, &frames, 0.005);
    let (frames, _) = run(&mut generator, &skeleton, &crouching(4.0), 400);
    assert_planted_within(&skeleton, &frames, 0.06);
    let speed = (frames[399].place - frames[160].place).length() / (239.0 * DT);
    assert!((0.5..2.0).contains(&speed), "{speed} m/s in a crouch");
    let (frames, _) = run(&mut generator, &skeleton, &walking(1.2), 240);
    assert_smooth(&frames, 0.034);
    assert!(hips(&frames[239]) > 0.85 * hips(&before[29]));
}

#[test]
fn a_jumper_goes_on_from_a_saved_state_bit_for_bit() {
    let skeleton = Skeleton::standard();
    for (speed, saved) in [
        (0.0, 5),
        (0.0, 30),
        (0.0, 55),
        (0.0, 75),
        (1.3, 20),
        (3.0, 40),
    ] {
        let controls = Controls {
            crouch: 0.4,
            ..walking(speed)
        };
        let mut first = generator(Kind::Styled, 9);
        first.stand();
        run(&mut first, &skeleton, &controls, 200);
        first.push(Vec2::new(0.4, 0.1));
        first.jump(0.35);
        run(&mut first, &skeleton, &controls, saved);
        let state = first.state();
        let mut second = GaitGenerator::new(&space(), &[], &skeleton, &config(4)).unwrap();
        second.restore(&state).unwrap();
        let (mut a, mut b) = (Pose::default(), Pose::default());
        for frame in 0..200 {
            first.step(DT, &controls, &mut a);
            second.step(DT, &controls, &mut b);
            assert_eq!(a, b, "{frame} frames after {saved} at {speed} m/s");
            assert_eq!(
                first.start_from_character(),
                second.start_from_character(),
                "{frame} frames after {saved} at {speed} m/s"
            );
        }
    }
}
