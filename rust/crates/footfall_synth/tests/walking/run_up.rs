//! Leaps to a place, out of a walk and a run.

use super::jumping::{assert_ballistic, assert_no_pop_beyond};
use super::world::{DT, Frame, Kind, assert_planted_within, generator, run, walking};
use footfall_core::Skeleton;
use footfall_core::rotation::from_heading;
use footfall_synth::{Controls, Footstep, GaitGenerator, JumpPhase};
use glam::Vec3;

/// A leap lands within this of its place, metres.
const SAME_PLACE_M: f32 = 0.03;

/// Returns a place relative to the start of the walk.
fn start_from(generator: &GaitGenerator, place: Vec3) -> Vec3 {
    let character = generator.start_from_character();
    character.position + from_heading(character.heading) * place
}

/// Goes on until a jump has ended, at most for a time; returns its frames and the footstep that ends it.
fn until_landed(
    generator: &mut GaitGenerator,
    speed: f32,
    secs: f32,
) -> (Vec<Frame>, Option<Footstep>) {
    let skeleton = Skeleton::standard();
    let (mut frames, mut flew) = (Vec::new(), false);
    for _ in 0..(secs / DT) as usize {
        let (mut shown, footsteps) = run(generator, &skeleton, &walking(speed), 1);
        frames.append(&mut shown);
        if let (true, Some(landing)) = (flew, footsteps.last()) {
            return (frames, Some(*landing));
        }
        flew |= generator.jump_phase() == Some(JumpPhase::Flight);
    }
    (frames, None)
}

#[test]
fn who_walks_or_runs_leaps_to_a_place_without_a_stop() {
    let skeleton = Skeleton::standard();
    for (speed, ahead_m) in [
        (1.2, 2.0),
        (1.2, 3.1),
        (1.5, 4.0),
        (2.4, 3.0),
        (3.0, 4.0),
        (3.0, 4.5),
        (3.0, 5.0),
        (3.0, 6.0),
        (3.8, 7.0),
    ] {
        for (seed, aside_m) in [(1, 0.0), (2, 0.25), (3, -0.25), (4, 0.0)] {
            let case = format!("{ahead_m} m at {speed} m/s, {aside_m} m aside, seed {seed}");
            let mut generator = generator(Kind::Styled, seed);
            run(&mut generator, &skeleton, &walking(speed), 240);
            let place = Vec3::new(aside_m, 0.0, ahead_m);
            let there = start_from(&generator, place);
            let heading = generator.start_from_character().heading;
            assert!(generator.jump_to(place), "{case}");
            let (mut frames, landing) = until_landed(&mut generator, speed, 5.0);
            let seen = |place: Vec3| from_heading(-heading) * (place - there);
            let off = seen(landing.expect(&case).position).z;
            assert!(off.abs() < SAME_PLACE_M, "{off} m off: {case}");
            let passes = seen(generator.start_from_character().position).x;
            assert!(passes.abs() < 0.1, "{passes} m beside: {case}");
            let (after, _) = run(&mut generator, &skeleton, &walking(speed), 120);
            frames.extend(after);
            assert_planted_within(&skeleton, &frames, 0.06);
            assert_no_pop_beyond(1.1, &frames);
            let way = (frames[frames.len() - 1].place - frames[0].place).length();
            let mean = way / (frames.len() as f32 * DT);
            assert!(mean > 0.85 * speed, "{mean} m/s: {case}");
        }
    }
}

#[test]
fn walkers_leap_on_a_parabola_to_a_place() {
    let skeleton = Skeleton::standard();
    for (seed, height) in [(5, 0.0), (6, 0.12), (7, -0.12)] {
        let mut generator = generator(Kind::Styled, seed);
        run(&mut generator, &skeleton, &walking(1.4), 200);
        assert!(generator.jump_to(Vec3::new(0.0, height, 3.0)));
        let (frames, _) = until_landed(&mut generator, 1.4, 5.0);
        assert_ballistic(&frames);
    }
}

/// Places that no leap reaches: too near, too high and too far aside. Those that are too far away are not reached at all.
#[test]
fn who_cannot_leap_there_stops_and_jumps_there() {
    let skeleton = Skeleton::standard();
    for (speed, place) in [
        (1.2, Vec3::new(0.0, 0.3, 1.6)),
        (1.3, Vec3::new(0.4, 0.0, 1.5)),
        (1.3, Vec3::new(0.0, 0.0, 0.9)),
    ] {
        let mut generator = generator(Kind::Styled, 2);
        run(&mut generator, &skeleton, &walking(speed), 240);
        let there = start_from(&generator, place);
        assert!(generator.jump_to(place));
        let (_, landing) = until_landed(&mut generator, speed, 5.0);
        assert!(landing.is_some(), "{place} at {speed} m/s");
        run(&mut generator, &skeleton, &Controls::STAND, 90);
        let came = generator.start_from_character().position;
        assert!(came.distance(there) < 0.01, "{came} for {there}");
    }
    let mut generator = generator(Kind::Styled, 2);
    run(&mut generator, &skeleton, &walking(1.3), 240);
    assert!(generator.jump_to(Vec3::new(0.0, 0.0, 12.0)));
    let (frames, landing) = until_landed(&mut generator, 1.3, 5.0);
    assert!(landing.is_some(), "stops for it at once");
    assert!(frames.len() < 180, "{} frames", frames.len());
}

#[test]
fn a_saved_run_up_goes_on_as_it_would_have() {
    let skeleton = Skeleton::standard();
    let [mut walker, mut other] = [8, 9].map(|seed| generator(Kind::Styled, seed));
    run(&mut walker, &skeleton, &walking(2.8), 240);
    assert!(walker.jump_to(Vec3::new(0.1, 0.0, 6.0)));
    run(&mut walker, &skeleton, &walking(2.8), 31);
    other.restore(&walker.state()).unwrap();
    let [(_, here), (_, there)] =
        [&mut walker, &mut other].map(|walker| until_landed(walker, 2.8, 4.0));
    assert_eq!(here.unwrap(), there.unwrap());
    assert_eq!(walker.state(), other.state());
}
