//! Facing one way and going another.

use crate::world::{
    DT, KINDS, Kind, assert_planted, assert_smooth, config, generator, knee, lowest, run, sole,
    walker,
};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use footfall_core::rotation::{heading, wrap_angle};
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;
use glam::Vec3;

pub(crate) fn going(direction_rad: f32, speed_mps: f32) -> Controls {
    Controls {
        speed_mps,
        direction_rad,
        ..Controls::STAND
    }
}

/// Every direction but straight ahead.
pub(crate) fn directions() -> impl Iterator<Item = f32> {
    (1..8).map(|eighth| eighth as f32 * FRAC_PI_4)
}

/// Walkers differ in the width of their sidesteps; their mean speed is the requested one.
#[test]
fn walkers_go_at_the_speed_that_was_asked_for_in_any_direction() {
    const SEEDS: u64 = 7;
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        for direction in directions() {
            let controls = going(direction, 0.6);
            let speeds = (1..=SEEDS).map(|seed| {
                let mut generator = generator(kind, seed);
                run(&mut generator, &skeleton, &controls, 240);
                let from = generator.start_from_character();
                let (frames, _) = run(&mut generator, &skeleton, &controls, 1200);
                let way = frames.last().unwrap().place.distance(from.position);
                way / (1200.0 * DT)
            });
            let mean = speeds.sum::<f32>() / SEEDS as f32;
            assert!(
                (mean / 0.6 - 1.0).abs() < 0.11,
                "{kind:?} {direction}: {mean} m/s"
            );
        }
    }
}

#[test]
fn quick_steps_backwards_and_to_the_side_go_nearly_as_fast_as_they_are_asked_to() {
    let skeleton = Skeleton::standard();
    for (direction, least) in [(PI, 0.95), (FRAC_PI_2, 0.88), (-FRAC_PI_2, 0.88)] {
        let controls = going(direction, 1.5);
        let speeds = (1..=5).map(|seed| {
            let mut generator = generator(Kind::Styled, seed);
            generator.stand();
            // From a stand, four fifths of it within 0.9 s.
            let from = generator.start_from_character();
            let (begun, _) = run(&mut generator, &skeleton, &controls, 54);
            let soon = begun[53].place.distance(begun[41].place) / (12.0 * DT);
            assert!(
                soon > 0.8 * 1.5 * least,
                "{direction}: {soon} m/s after 0.9 s"
            );
            let (frames, _) = run(&mut generator, &skeleton, &controls, 600);
            assert!(frames[0].place.distance(from.position) > 0.4);
            let last = &frames[599];
            last.place.distance(begun[53].place) / (600.0 * DT)
        });
        let share = speeds.sum::<f32>() / 5.0 / 1.5;
        assert!((least..1.05).contains(&share), "{direction}: {share}");
    }
}

#[test]
fn the_body_goes_one_way_and_faces_another() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        for direction in directions() {
            let controls = going(direction, 0.6);
            let mut generator = generator(kind, 3);
            run(&mut generator, &skeleton, &controls, 240);
            let from = generator.start_from_character();
            let (frames, _) = run(&mut generator, &skeleton, &controls, 1800);
            let last = frames.last().unwrap();
            let travel = last.place - from.position;
            let astray = wrap_angle(travel.x.atan2(travel.z) - from.heading - direction);
            assert!(
                astray.abs() < 0.1,
                "{kind:?} {direction}: {astray} rad astray"
            );
            assert!((last.heading - from.heading).abs() < 0.01, "it turns");
            for frame in &frames {
                let chest = heading(frame.model.rotation(Joint::UpperChest));
                let off = wrap_angle(chest - frame.heading);
                assert!(
                    off.abs() < 0.35,
                    "{kind:?} {direction}: the chest faces {off} rad aside"
                );
            }
        }
    }
}

#[test]
fn feet_stand_and_nothing_pops_in_any_direction() {
    for (kind, seed) in KINDS
        .into_iter()
        .flat_map(|kind| (1..21).map(move |seed| (kind, seed)))
    {
        let skeleton = Skeleton::standard();
        let mut all = Vec::new();
        let mut generator = generator(kind, seed);
        for controls in [
            going(FRAC_PI_2, 0.6),
            going(-FRAC_PI_2, 0.6),
            going(PI, 0.8),
            going(0.0, 1.3),
            going(FRAC_PI_4, 1.0),
            going(-3.0 * FRAC_PI_4, 0.7),
            Controls::STAND,
        ] {
            all.extend(run(&mut generator, &skeleton, &controls, 240).0);
        }
        assert!(generator.is_standing());
        assert_planted(&skeleton, &all);
        // A walk that becomes a sidestep takes a knee along a little harder than one that goes on.
        assert_smooth(&all, 0.04);
    }
}

/// People who walk backwards lift their soles by 4 to 5 cm (Bandai's `walk_back`).
#[test]
fn flat_feet_are_not_lifted_high() {
    let skeleton = Skeleton::standard();
    let highest = |direction: f32, seed: u64| {
        let mut walker = generator(Kind::Styled, seed);
        let controls = going(direction, 0.8);
        run(&mut walker, &skeleton, &controls, 200);
        let (frames, _) = run(&mut walker, &skeleton, &controls, 500);
        let heights = frames
            .iter()
            .flat_map(|frame| Side::BOTH.map(|side| lowest(&sole(&skeleton, frame, side))));
        heights.fold(0.0, f32::max)
    };
    for (direction, most) in [(PI, 0.07), (FRAC_PI_2, 0.055)] {
        let mean = (1..13).map(|seed| highest(direction, seed)).sum::<f32>() / 12.0;
        assert!((0.02..most).contains(&mean), "{direction}: {mean} m");
    }
}

/// Hips rise between two steps to the side, over legs that are nearly straight.
#[test]
fn sidesteps_are_upright() {
    let skeleton = Skeleton::standard();
    for speed in [0.4, 0.7, 1.0] {
        let controls = going(FRAC_PI_2, speed);
        let (mut knees, mut heights) = (Vec::new(), Vec::new());
        for seed in 1..9 {
            let mut walker = generator(Kind::Styled, seed);
            run(&mut walker, &skeleton, &controls, 200);
            for frame in run(&mut walker, &skeleton, &controls, 400).0 {
                heights.push(frame.model.position(Joint::Hips).y);
                for side in Side::BOTH {
                    if frame.contact[side.index()] && !frame.contact[side.other().index()] {
                        knees.push(knee(&frame, side));
                    }
                }
            }
        }
        let [knee, height] = [knees, heights].map(|all| all.iter().sum::<f32>() / all.len() as f32);
        assert!(knee < 36.0, "{speed} m/s: stands on knees of {knee}°");
        assert!(height > 0.915, "{speed} m/s: hips at {height} m");
    }
}

/// Ankles of Bandai's actors who walk backwards at 1.1 to 1.2 m/s go as far ahead of the hips as behind them. Half of the time their knees are bent by less than 23° to 35°.
#[test]
fn walks_backwards_are_upright() {
    let skeleton = Skeleton::standard();
    for speed in [0.5, 1.2] {
        let controls = going(PI, speed);
        let (mut knees, mut heights, mut ahead) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 1..9 {
            let mut walker = generator(Kind::Styled, seed);
            run(&mut walker, &skeleton, &controls, 200);
            for frame in run(&mut walker, &skeleton, &controls, 400).0 {
                heights.push(frame.model.position(Joint::Hips).y);
                let [left, right] = Side::BOTH.map(|side| frame.model.position(side.upper_leg()));
                let forwards = (left - right).cross(Vec3::Y).normalize();
                for side in Side::BOTH {
                    knees.push(knee(&frame, side));
                    let leg =
                        frame.model.position(side.foot()) - frame.model.position(side.upper_leg());
                    ahead.push(leg.dot(forwards));
                }
            }
        }
        for all in [&mut knees, &mut heights, &mut ahead] {
            all.sort_by(f32::total_cmp);
        }
        let at = |all: &[f32], share: f32| all[(share * (all.len() - 1) as f32) as usize];
        let (knee, lowest) = (at(&knees, 0.5), at(&heights, 0.02));
        let middle = 0.5 * (at(&ahead, 0.01) + at(&ahead, 0.99));
        println!("{speed} m/s: knees {knee}°, hips {lowest} m, feet {middle} m ahead");
        assert!(
            knee < 33.0,
            "{speed} m/s: half of the time knees of {knee}°"
        );
        assert!(lowest > 0.92, "{speed} m/s: hips at {lowest} m");
        assert!(middle.abs() < 0.05, "{speed} m/s: feet {middle} m ahead");
    }
}

/// Four fifths of a speed take people 0.4 to 0.7 s from a stand. Who is faster than that backwards comes down between feet 0.8 m apart.
#[test]
fn first_steps_backwards_and_to_the_side_gather_speed() {
    let skeleton = Skeleton::standard();
    for (direction, most_mps, least_m) in [(PI, 1.1, 0.9), (FRAC_PI_2, 1.3, 0.84)] {
        for seed in 1..21 {
            let mut walker = generator(Kind::Styled, seed);
            walker.stand();
            run(&mut walker, &skeleton, &Controls::STAND, 20 + seed as usize);
            let (frames, _) = run(&mut walker, &skeleton, &going(direction, 1.5), 60);
            let hips = |frame: usize| frames[frame].model.position(Joint::Hips);
            let speed = hips(18).distance(hips(9)) / (9.0 * DT);
            let heights = (0..60).map(|frame| hips(frame).y);
            let lowest = heights.fold(f32::INFINITY, f32::min);
            assert!(
                speed < most_mps,
                "{direction}, seed {seed}: {speed} m/s after 0.2 s"
            );
            assert!(
                lowest > least_m,
                "{direction}, seed {seed}: hips at {lowest} m"
            );
        }
    }
}

#[test]
fn hips_stay_up_when_the_direction_changes() {
    let skeleton = Skeleton::standard();
    for (before, after) in [
        (Controls::STAND, going(FRAC_PI_2, 0.6)),
        (going(0.0, 1.5), going(-FRAC_PI_2, 1.4)),
        (going(-3.0 * FRAC_PI_4, 0.7), going(FRAC_PI_2, 1.2)),
    ] {
        for seed in 1..41 {
            let mut walker = generator(Kind::Styled, seed);
            run(&mut walker, &skeleton, &before, 200 + seed as usize);
            let (frames, _) = run(&mut walker, &skeleton, &after, 90);
            let heights = frames.iter().map(|f| f.model.position(Joint::Hips).y);
            let lowest = heights.fold(f32::INFINITY, f32::min);
            assert!(lowest > 0.83, "{after:?}, seed {seed}: hips at {lowest} m");
        }
    }
}

#[test]
fn legs_do_not_cross_in_steps_to_the_side() {
    for direction in [FRAC_PI_2, -FRAC_PI_2] {
        let skeleton = Skeleton::standard();
        let mut generator = generator(Kind::Styled, 5);
        let controls = going(direction, 1.5);
        run(&mut generator, &skeleton, &controls, 300);
        let (frames, _) = run(&mut generator, &skeleton, &controls, 900);
        for frame in frames {
            let [left, right] = Side::BOTH.map(|side| frame.model.position(side.foot()));
            let apart = (left - right).dot(Vec3::X);
            assert!(apart > 0.08, "{direction}: ankles {apart} m apart");
        }
    }
}

#[test]
fn a_walk_backwards_lands_on_its_toes() {
    let skeleton = Skeleton::standard();
    let controls = going(PI, 0.7);
    let mut generator = walker(Kind::Styled, &skeleton, &config(2)).unwrap();
    run(&mut generator, &skeleton, &controls, 300);
    let (frames, footsteps) = run(&mut generator, &skeleton, &controls, 900);
    assert!(footsteps.len() > 15);
    let landings = frames.windows(2).flat_map(|pair| {
        let lands = |side: &Side| !pair[0].contact[side.index()] && pair[1].contact[side.index()];
        Side::BOTH.into_iter().filter(lands).map(|side| {
            let foot = skeleton.foot(side);
            let heel = pair[1].model.point(side.foot(), foot.heel);
            let toes = pair[1].model.point(side.toes(), foot.toe_tip);
            heel.y - toes.y
        })
    });
    for rise in landings {
        assert!(rise > 0.01, "the heel lands {rise} m above the toes");
    }
}

/// The pelvis turns against its turn in a walk forwards; legs that turned with it would set the feet apart by 30 cm.
#[test]
fn a_walk_backwards_does_not_waddle() {
    let skeleton = Skeleton::standard();
    let controls = going(PI, 1.2);
    let sways = (1..9).map(|seed| {
        let mut walker = generator(Kind::Styled, seed);
        run(&mut walker, &skeleton, &controls, 300);
        // About two strides, in which a walk hardly leaves its line.
        let (frames, _) = run(&mut walker, &skeleton, &controls, 110);
        let [first, last] = [&frames[0], &frames[109]].map(|frame| frame.place);
        let aside = Vec3::Y.cross((last - first).normalize());
        let places = frames
            .iter()
            .map(|frame| (frame.model.position(Joint::Hips) - first).dot(aside));
        let (least, most) = places.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), place| {
            (a.min(place), b.max(place))
        });
        most - least
    });
    let sway = sways.sum::<f32>() / 8.0;
    assert!((0.02..0.1).contains(&sway), "hips sway by {sway} m");
}

#[test]
fn directions_that_are_none_go_forwards() {
    let skeleton = Skeleton::standard();
    for direction in [f32::NAN, f32::INFINITY] {
        let mut odd = generator(Kind::Styled, 4);
        let mut plain = generator(Kind::Styled, 4);
        let (odd, _) = run(&mut odd, &skeleton, &going(direction, 1.0), 120);
        let (plain, _) = run(&mut plain, &skeleton, &going(0.0, 1.0), 120);
        assert_eq!(odd.last().unwrap().place, plain.last().unwrap().place);
    }
}

#[test]
fn a_saved_sidestep_goes_on_as_it_would_have() {
    for kind in KINDS {
        let skeleton = Skeleton::standard();
        let controls = going(2.0, 0.6);
        let mut first = generator(kind, 6);
        run(&mut first, &skeleton, &controls, 200);
        let mut second = generator(kind, 7);
        second.restore(&first.state()).unwrap();
        let (a, _) = run(&mut first, &skeleton, &controls, 120);
        let (b, _) = run(&mut second, &skeleton, &controls, 120);
        for (a, b) in a.iter().zip(&b) {
            for joint in Joint::ALL {
                assert_eq!(a.model.position(joint), b.model.position(joint));
            }
        }
    }
}
