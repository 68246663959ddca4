//! Quick to obey: starts, stops and turns within a step, also in the middle of one.

use crate::world::{
    DT, Frame, KINDS, Kind, assert_planted_within, config, generator, run, space, walking,
};
use core::f32::consts::{FRAC_PI_2, PI, TAU};
use footfall_core::rotation::wrap_angle;
use footfall_core::{Joint, Pose, Skeleton};
use footfall_synth::{Controls, GaitGenerator};
use glam::Vec3;

/// Frames over which speeds are taken: hips surge faster.
const OVER: usize = 12;

/// The hips' velocity over the ground about a frame, m/s.
fn velocity(frames: &[Frame], at: usize) -> Vec3 {
    let hips = |frame: usize| frames[frame].model.position(Joint::Hips);
    let (first, last) = (
        at.saturating_sub(OVER / 2),
        (at + OVER / 2).min(frames.len() - 1),
    );
    let way = (hips(last) - hips(first)) / ((last - first) as f32 * DT);
    Vec3::new(way.x, 0.0, way.z)
}

/// Seconds from a frame until something is so of the velocity.
pub(crate) fn secs_until(frames: &[Frame], from: usize, is_so: impl Fn(Vec3) -> bool) -> f32 {
    let found = (from..frames.len()).find(|at| is_so(velocity(frames, *at)));
    found.map_or(f32::INFINITY, |at| (at - from) as f32 * DT)
}

/// The largest acceleration of a joint, m/s².
pub(crate) fn hardest(frames: &[Frame], joint: Joint) -> f32 {
    let place = |frame: &Frame| frame.model.position(joint);
    let accelerations = frames
        .windows(3)
        .map(|at| (place(&at[2]) - 2.0 * place(&at[1]) + place(&at[0])).length() / (DT * DT));
    accelerations.fold(0.0, f32::max)
}

/// Fails when hips or head accelerate harder than these, m/s².
pub(crate) fn assert_no_pop(frames: &[Frame], most_mps2: [f32; 2], when: &str) {
    for (joint, most) in [Joint::Hips, Joint::Head].into_iter().zip(most_mps2) {
        let hardest = hardest(frames, joint);
        assert!(hardest < most, "{when}: {joint:?} {hardest} m/s²");
    }
}

/// Fails when another walker, restored from the state of this one, does not go on as this one does, bit for bit.
pub(crate) fn assert_restores(
    mut first: GaitGenerator,
    frames: usize,
    controls: impl Fn(usize) -> Controls,
    when: &str,
) {
    let skeleton = Skeleton::standard();
    let state = first.state();
    let mut second = GaitGenerator::new(&space(), &[], &skeleton, &config(2)).unwrap();
    second.restore(&state).unwrap();
    let (mut a, mut b) = (Pose::default(), Pose::default());
    for frame in 0..frames {
        first.step(DT, &controls(frame), &mut a);
        second.step(DT, &controls(frame), &mut b);
        assert_eq!(a, b, "{when}, {frame} frames later");
    }
}

/// A walker who has stood for some frames.
pub(crate) fn stood(seed: u64, frames: usize) -> (GaitGenerator, Vec<Frame>) {
    let mut walker = generator(Kind::Styled, seed);
    walker.stand();
    let (frames, _) = run(&mut walker, &Skeleton::standard(), &Controls::STAND, frames);
    (walker, frames)
}

#[test]
fn a_start_takes_one_step() {
    let skeleton = Skeleton::standard();
    for seed in 1..7 {
        for (speed, most) in [(1.3, 0.5), (3.0, 0.7)] {
            let (mut walker, mut frames) = stood(seed, 40);
            frames.extend(run(&mut walker, &skeleton, &walking(speed), 120).0);
            let secs = secs_until(&frames, 40, |velocity| velocity.z > 0.8 * speed);
            assert!(secs < most, "seed {seed}: {secs} s to {speed} m/s");
            assert_planted_within(&skeleton, &frames, 0.05);
        }
    }
}

#[test]
fn a_stop_takes_a_second_at_most() {
    let skeleton = Skeleton::standard();
    for seed in 1..7 {
        for (speed, most) in [(1.3, 0.85), (3.4, 1.15)] {
            let mut walker = generator(Kind::Styled, seed);
            let before = 150 + 7 * seed as usize;
            let (mut frames, _) = run(&mut walker, &skeleton, &walking(speed), before);
            frames.extend(run(&mut walker, &skeleton, &Controls::STAND, 150).0);
            let secs = secs_until(&frames, before, |velocity| velocity.length() < 0.15);
            assert!(secs < most, "seed {seed}: {secs} s from {speed} m/s");
            assert_planted_within(&skeleton, &frames, 0.05);
        }
    }
}

/// Stops requested at every moment of a stride: early in a step, that very step closes beside the standing foot. Hips that would have to brake too hard for it go on.
#[test]
fn a_stop_from_a_walk_takes_half_a_second() {
    let skeleton = Skeleton::standard();
    let (mut secs, mut closed, mut backwards) = (vec![], 0, vec![]);
    for seed in 1..4 {
        for moment in 0..33 {
            let mut walker = generator(Kind::Styled, seed);
            let before = 150 + 2 * moment;
            let (mut frames, _) = run(&mut walker, &skeleton, &walking(1.3), before);
            let (stopped, footsteps) = run(&mut walker, &skeleton, &Controls::STAND, 120);
            // The step that closes ends with a contact, too.
            closed += usize::from(footsteps.len() == 1);
            frames.extend(stopped);
            let moving = (before..frames.len()).rfind(|at| velocity(&frames, *at).length() > 0.15);
            secs.push(moving.map_or(0.0, |at| (at + 1 - before) as f32 * DT));
            // Walkers head along +Z. Who stops too early for their speed come back.
            let ahead = (before..frames.len()).map(|at| velocity(&frames, at).z);
            backwards.push(-ahead.fold(0.0, f32::min));
            assert_planted_within(&skeleton, &frames, 0.02);
            let [left, right] = [Joint::LeftFoot, Joint::RightFoot]
                .map(|joint| frames[frames.len() - 1].model.position(joint).z);
            assert!((left - right).abs() < 0.03, "{moment}: {left} {right}");
            let hardest = hardest(&frames[100..], Joint::Hips);
            assert!(hardest < 30.0, "{moment}: hips {hardest} m/s²");
        }
    }
    let mean = secs.iter().sum::<f32>() / secs.len() as f32;
    assert!(mean < 0.5, "{mean} s");
    let farthest = backwards.iter().fold(0.0_f32, |most, back| most.max(*back));
    assert!(farthest < 0.35, "{farthest} m/s backwards");
    assert!(closed > 20, "{closed} of {} close at once", secs.len());
}

/// It was reported as the walk went on, with a foot that had long stood.
#[test]
fn the_foot_that_closes_is_reported_as_it_lands() {
    let skeleton = Skeleton::standard();
    for kind in KINDS {
        for seed in 1..9 {
            let mut walker = generator(kind, seed);
            let before = 150 + 7 * seed as usize;
            run(&mut walker, &skeleton, &walking(1.3), before);
            for controls in [Controls::STAND, walking(1.3), Controls::STAND] {
                let standing = walker.feet_in_contact();
                let (frames, footsteps) = run(&mut walker, &skeleton, &controls, 150);
                let contacts = [standing]
                    .into_iter()
                    .chain(frames.iter().map(|f| f.contact));
                let contacts: Vec<[bool; 2]> = contacts.collect();
                let lands = |side: usize| {
                    contacts
                        .windows(2)
                        .filter(|pair| !pair[0][side] && pair[1][side])
                        .count()
                };
                assert_eq!(
                    footsteps.len(),
                    lands(0) + lands(1),
                    "{kind:?}, seed {seed}: {controls:?}"
                );
            }
        }
    }
}

/// Walks or runs, and then follows other controls. Returns all frames, and whether the same foot is at once to land elsewhere, by more than `moved_m`, or under
/// another heading.
pub(crate) fn interrupted(
    speed_mps: f32,
    before: usize,
    controls: &Controls,
    moved_m: f32,
) -> (Vec<Frame>, bool) {
    let mut walker = generator(Kind::Styled, 4);
    let (frames, _) = run(
        &mut walker,
        &Skeleton::standard(),
        &walking(speed_mps),
        before,
    );
    redirected((walker, frames), speed_mps, controls, moved_m)
}

/// Sets out from standing, and then follows other controls; returns what [`interrupted`] does.
fn interrupted_start(speed_mps: f32, before: usize, controls: &Controls) -> (Vec<Frame>, bool) {
    let skeleton = Skeleton::standard();
    let (mut walker, mut frames) = stood(4, 20);
    frames.extend(run(&mut walker, &skeleton, &walking(speed_mps), before).0);
    redirected((walker, frames), speed_mps, controls, 0.06)
}

fn redirected(
    (mut walker, mut frames): (GaitGenerator, Vec<Frame>),
    speed_mps: f32,
    controls: &Controls,
    moved_m: f32,
) -> (Vec<Frame>, bool) {
    let skeleton = Skeleton::standard();
    let landing = walker.next_footstep().unwrap().0;
    frames.extend(run(&mut walker, &skeleton, controls, 1).0);
    let now = walker.next_footstep().unwrap().0;
    let stays = landing.position - speed_mps * DT * Vec3::Z;
    let moved = now.position.distance(stays) > moved_m;
    let turned = (now.heading - landing.heading).abs() > 0.1;
    frames.extend(run(&mut walker, &skeleton, controls, 90).0);
    (frames, now.side == landing.side && (moved || turned))
}

/// Steers towards a heading as `GaitCharacter3D` does, by what is left of the turn less what the steps go on turning; returns the frames.
pub(crate) fn turned_to(
    walker: &mut GaitGenerator,
    (heading, speed_mps): (f32, f32),
    frames: usize,
) -> Vec<Frame> {
    let skeleton = Skeleton::standard();
    let mut turned = Vec::with_capacity(frames);
    let mut before = walker.start_from_character().heading;
    for _ in 0..frames {
        let now = walker.start_from_character().heading;
        let turning = wrap_angle(now - before) / DT;
        before = now;
        let left = wrap_angle(heading - now);
        let controls = Controls {
            turn_rate_radps: ((left - 0.2 * turning) / 0.3).clamp(-3.5, 3.5),
            ..walking(if left > 2.0 {
                0.4 * speed_mps
            } else {
                speed_mps
            })
        };
        turned.extend(run(walker, &skeleton, &controls, 1).0);
    }
    turned
}

/// The first step goes on turning no longer than it has to.
#[test]
fn whoever_sets_out_to_the_side_turns_no_farther_than_asked() {
    let skeleton = Skeleton::standard();
    for (seed, side) in (1..13).flat_map(|seed| [(seed, 1.0), (seed, -1.0)]) {
        let (mut walker, mut frames) = stood(seed, 40);
        frames.extend(turned_to(&mut walker, (side * FRAC_PI_2, 1.3), 120));
        let secs = secs_until(&frames, 40, |velocity| side * velocity.x > 0.8 * 1.3);
        assert!(secs < 0.5, "seed {seed}: {secs} s");
        let headings = frames[40..].iter().map(|frame| side * frame.heading);
        let farthest = headings.fold(0.0, f32::max) - FRAC_PI_2;
        assert!(farthest < 0.15, "seed {seed}: {farthest} rad too far");
        assert_planted_within(&skeleton, &frames, 0.02);
        let hardest = hardest(&frames, Joint::Hips);
        assert!(hardest < 25.0, "seed {seed}: hips {hardest} m/s²");
    }
}

/// Controls change at every moment of a stride.
#[test]
fn a_change_in_the_middle_of_a_step_is_obeyed_without_a_pop() {
    let skeleton = Skeleton::standard();
    let news = [
        Controls {
            turn_rate_radps: 1.5,
            ..walking(1.3)
        },
        walking(0.7),
        walking(1.7),
        Controls::STAND,
    ];
    for (index, controls) in news.iter().enumerate() {
        let mut sooner = 0;
        for moment in 0..33 {
            let before = 121 + 2 * moment;
            let (frames, obeyed) = interrupted(1.3, before, controls, 0.03);
            sooner += usize::from(obeyed);
            assert_planted_within(&skeleton, &frames, 0.02);
            assert_no_pop(&frames[100..], [30.0, 50.0], &format!("{index}, {moment}"));
        }
        assert!(
            sooner > 6,
            "{index}: obeyed in the same step at {sooner} of 33 moments"
        );
    }
}

/// Controls change at every moment of the step in which a walker sets out.
#[test]
fn a_change_in_the_first_step_is_obeyed_without_a_pop() {
    let skeleton = Skeleton::standard();
    let turning = Controls {
        turn_rate_radps: -2.0,
        ..walking(1.3)
    };
    for (index, controls) in [turning, walking(0.5), walking(1.9)].iter().enumerate() {
        let mut sooner = 0;
        for moment in 1..27 {
            let (frames, obeyed) = interrupted_start(1.3, moment, controls);
            sooner += usize::from(obeyed);
            assert_planted_within(&skeleton, &frames, 0.02);
            assert_no_pop(&frames, [30.0, 50.0], &format!("{index}, {moment}"));
        }
        assert!(
            sooner > 6,
            "{index}: obeyed in the first step at {sooner} of 26 moments"
        );
    }
}

#[test]
fn whoever_turns_back_plants_a_foot_and_goes() {
    let skeleton = Skeleton::standard();
    for seed in 1..7 {
        let mut walker = generator(Kind::Styled, seed);
        let before = 150 + 5 * seed as usize;
        let (mut frames, _) = run(&mut walker, &skeleton, &walking(1.3), before);
        frames.extend(turned_to(&mut walker, (PI, 1.3), 180));
        let secs = secs_until(&frames, before, |velocity| velocity.z < -0.8 * 1.3);
        assert!(secs < 1.4, "seed {seed}: {secs} s");
        let last = walker.start_from_character().heading.rem_euclid(TAU);
        assert!((last - PI).abs() < 0.1, "seed {seed}: faces {last}");
        assert_planted_within(&skeleton, &frames, 0.05);
    }
}

#[test]
fn a_step_that_was_planned_anew_goes_on_from_a_saved_state_bit_for_bit() {
    let skeleton = Skeleton::standard();
    let turning = Controls {
        turn_rate_radps: 1.2,
        ..walking(1.6)
    };
    for before in [121, 127, 133, 139, 145, 151, 157] {
        let mut walker = generator(Kind::Styled, 11);
        run(&mut walker, &skeleton, &walking(1.2), before);
        run(&mut walker, &skeleton, &turning, 3);
        let controls = |frame| if frame < 40 { turning } else { walking(0.8) };
        assert_restores(walker, 200, controls, &format!("{before} frames"));
    }
    // In the step in which it sets out.
    for before in (10..22).step_by(3) {
        let mut walker = generator(Kind::Styled, 11);
        walker.stand();
        run(&mut walker, &skeleton, &walking(1.2), before);
        run(&mut walker, &skeleton, &turning, 3);
        assert_restores(
            walker,
            90,
            |_| turning,
            &format!("{before} frames from standing"),
        );
    }
}
