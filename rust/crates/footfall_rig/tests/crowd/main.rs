//! A crowd of the shipped walk: equal seeds, saved and restored crowds, avoidance, and goals.

#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

mod goals;

use footfall_core::rotation::wrap_angle;
use footfall_model::GaitModel;
use footfall_rig::crowd::{
    Crowd, CrowdRecipe, CrowdSettings, Limits, Passerby, Routing, SavedCrowd, Tier,
    finish_disposals,
};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use std::path::Path;
use std::sync::{Arc, LazyLock};

const DT_SECS: f32 = 1.0 / 60.0;

const LIMITS: Limits = Limits {
    counts: [2, 4],
    distances_m: [5.0, 20.0],
};

static MODEL: LazyLock<Arc<GaitModel>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let bytes = std::fs::read(root.join("addons/footfall/models/locomotion.footfall"))
        .expect("the shipped walk");
    Arc::new(GaitModel::from_bytes(&bytes).expect("a walk"))
});

fn crowd(routing: Routing) -> Crowd {
    crowd_of(0, routing)
}

fn recipe() -> CrowdRecipe {
    CrowdRecipe {
        model: Arc::clone(&MODEL),
        styles: Vec::new(),
        space: None,
        body: MODEL.skeleton.clone(),
    }
}

fn crowd_of(seed: u64, routing: Routing) -> Crowd {
    let settings = CrowdSettings {
        seed,
        ..CrowdSettings::default()
    };
    Crowd::new(recipe(), routing, settings)
}

fn places(crowd: &Crowd) -> Vec<Vec3> {
    let rows = crowd.roster().order().iter();
    rows.map(|row| crowd.agents()[*row as usize].place)
        .collect()
}

fn walk(crowd: &mut Crowd, secs: f32, look: impl FnMut(&Crowd)) {
    walk_with(crowd, secs, true, look);
}

fn walk_with(crowd: &mut Crowd, secs: f32, avoidance: bool, mut look: impl FnMut(&Crowd)) {
    for _ in 0..(secs / DT_SECS) as usize {
        crowd.begin_all().expect("a walk");
        crowd.advance(DT_SECS, avoidance);
        look(crowd);
    }
}

#[test]
fn equal_seeds_give_equal_crowds_that_wander_and_others_do_not() {
    let half = Vec2::splat(20.0);
    let mut twins = [0, 1].map(|_| crowd(Routing::Wander { half }));
    for twin in &mut twins {
        twin.set_count(30);
        walk(twin, 3.0, |_| {});
    }
    assert_eq!(places(&twins[0]), places(&twins[1]));
    let begin = {
        let mut crowd = crowd(Routing::Wander { half });
        crowd.set_count(30);
        places(&crowd)
    };
    let ways = places(&twins[0]).into_iter().zip(begin);
    let moved = ways.filter(|(now, then)| now.distance(*then) > 1.0);
    assert!(moved.count() > 20);
}

/// They took the step in the middle of which others begin, and went 0.7 m.
#[test]
fn who_has_no_speed_stands_from_the_beginning_and_walks_when_asked() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add((0..12_u8).map(|index| (Vec3::X * f32::from(index) * 3.0, 0.5)));
    crowd.come_in(usize::MAX);
    let begin = places(&crowd);
    let farthest = |crowd: &Crowd| {
        let ways = places(crowd)
            .into_iter()
            .zip(&begin)
            .map(|(now, then)| now.distance(*then));
        ways.fold(0.0, f32::max)
    };
    for agent in crowd.agents_mut() {
        agent.speed_mps = 0.0;
    }
    walk(&mut crowd, 2.0, |crowd| {
        assert!(farthest(crowd) < 0.01, "{} m", farthest(crowd));
    });
    for agent in crowd.agents_mut() {
        agent.speed_mps = 1.3;
    }
    walk(&mut crowd, 3.0, |_| {});
    let ways = places(&crowd).into_iter().zip(&begin);
    let least = ways
        .map(|(now, then)| now.distance(*then))
        .fold(f32::INFINITY, f32::min);
    assert!(least > 2.5, "{least} m");
}

#[test]
fn names_and_places_outlast_saving_and_others_who_leave() {
    let mut first = crowd(Routing::Scripted);
    let starts = (0..5_u8).map(|index| (Vec3::X * f32::from(index) * 3.0, 0.5));
    let names = first.add(starts);
    walk(&mut first, 0.2, |_| {});
    let left = first.roster().place(names[1]).expect("its row");
    first.leave(&[left]);

    let bytes = first.save();
    let saved = SavedCrowd::from_bytes(&bytes).expect("a crowd");
    let mut second = crowd(Routing::Scripted);
    second.restore(&saved);
    assert_eq!(second.names().collect::<Vec<_>>(), [0, 2, 3, 4]);
    assert_eq!(places(&second), places(&first));
    assert_eq!(second.roster().place(names[1]), None);
    let near = second.nearest(Vec3::X * 8.9, 1.0);
    assert_eq!(near, second.roster().place(names[3]));
    let over = Vec3::new(12.0, 10.0, 0.0);
    let met = second.first_met(over, over.with_y(-1.0));
    assert_eq!(met, second.roster().place(names[4]));
}

#[test]
fn dropped_crowds_are_freed_whole_even_while_they_are_made() {
    for is_made in [true, false] {
        let model = Arc::new(GaitModel::clone(&MODEL));
        let recipe = CrowdRecipe {
            model: Arc::clone(&model),
            ..recipe()
        };
        let mut crowd = Crowd::new(recipe, Routing::Scripted, CrowdSettings::default());
        crowd.set_count(100);
        if is_made {
            walk(&mut crowd, DT_SECS, |_| {});
        }
        assert!(Arc::strong_count(&model) > 1);
        drop(crowd);
        finish_disposals();
        assert_eq!(Arc::strong_count(&model), 1);
    }
}

/// Seconds for which two of eight walkers touch, of two rows that pass through each other.
fn touching_secs(seed: u64, avoidance: bool) -> f32 {
    let mut crowd = crowd_of(seed, Routing::Scripted);
    let row = |z: f32, heading: f32| {
        (0..4_u8).map(move |index| (Vec3::new(1.5 * f32::from(index), 0.0, z), heading))
    };
    let starts: Vec<_> = row(-6.0, 0.0).chain(row(6.0, PI)).collect();
    crowd.add(starts.into_iter());
    walk(&mut crowd, 0.1, |_| {});
    for agent in crowd.agents_mut() {
        agent.go_to(Vec2::new(agent.place.x, -2.0 * agent.place.z));
    }
    let mut frames = 0;
    // The slowest is there after 8 s if nobody is in the way.
    walk_with(&mut crowd, 12.0, avoidance, |crowd| {
        let places = places(crowd);
        let others = |index: usize| places[index + 1..].iter();
        let touch = |(index, place): (usize, &Vec3)| {
            others(index).any(|other| place.distance(*other) < 0.4)
        };
        frames += u32::from(places.iter().enumerate().any(touch));
    });
    let agents = crowd.agents().iter().zip(0..8);
    let passed = agents.filter(|(agent, index)| (agent.place.z > 2.0) == (*index < 4));
    assert_eq!(passed.count(), 8, "seed {seed}: {:?}", places(&crowd));
    frames as f32 * DT_SECS
}

#[test]
fn rows_that_meet_pass_through_each_other_without_bumping() {
    let [avoiding, straight] = [true, false].map(|avoidance| {
        let seeds = 0..12;
        seeds
            .map(|seed| touching_secs(seed, avoidance))
            .sum::<f32>()
    });
    assert!(straight > 6.0, "the rows meet: {straight} s");
    assert!(avoiding < 0.05 * straight, "{avoiding} of {straight} s");
}

/// So many walkers that have wandered in a square of 16 m for five seconds.
fn wanderers(seed: u64, people: usize) -> Crowd {
    let half = Vec2::splat(8.0);
    let settings = CrowdSettings {
        seed,
        half_area: half,
        ..CrowdSettings::default()
    };
    let mut crowd = Crowd::new(recipe(), Routing::Wander { half }, settings);
    crowd.set_count(people);
    walk(&mut crowd, 5.0, |_| {});
    crowd
}

/// Share of their time for which somebody is nearer to a walker than this, metres, of walkers that wander in a square of 16 m: each has 2 m².
fn crowded(seed: u64, nearer_m: f32) -> f32 {
    const PEOPLE: usize = 120;
    let mut crowd = wanderers(seed, PEOPLE);
    let (mut near, mut frames) = (0, 0);
    walk(&mut crowd, 15.0, |crowd| {
        let places = places(crowd);
        let pairs = places.iter().enumerate();
        let pairs = pairs
            .flat_map(|(index, one)| places[..index].iter().map(move |two| one.distance(*two)));
        near += 2 * pairs.filter(|far| *far < nearer_m).count();
        frames += PEOPLE;
    });
    near as f32 / frames as f32
}

#[test]
fn people_in_a_crowded_square_seldom_walk_through_each_other() {
    let seeds = 0..3;
    let near = seeds.map(|seed| crowded(seed, 0.3)).sum::<f32>() / 3.0;
    assert!(near < 0.03, "{near} of the time");
}

/// Shares of their time in which walkers, each alone in a square of 16 m, turn faster than 40 °/s, and their mean speed, m/s.
fn alone() -> [f32; 2] {
    const SEEDS: u64 = 20;
    /// Frames over which turns and ways are taken.
    const OVER: usize = 12;
    let (mut turning, mut way, mut secs) = (0.0, 0.0, 0.0);
    for seed in 0..SEEDS {
        let mut crowd = wanderers(seed, 1);
        let mut frames = Vec::new();
        walk(&mut crowd, 20.0, |crowd| {
            let agent = &crowd.agents()[0];
            frames.push((agent.place, agent.heading));
        });
        let long = OVER as f32 * DT_SECS;
        for pair in frames.iter().step_by(OVER).collect::<Vec<_>>().windows(2) {
            let rate = wrap_angle(pair[1].1 - pair[0].1) / long;
            turning += f32::from(u8::from(rate.abs() > 40_f32.to_radians())) * long;
            way += pair[0].0.distance(pair[1].0);
            secs += long;
        }
    }
    [turning / secs, way / secs]
}

/// They went to any place, also behind them, turned so fast in 22 % of their time, and went at 1.03 m/s.
#[test]
fn who_wanders_goes_on_rather_than_back() {
    let [turning, mps] = alone();
    assert!(
        turning < 0.16 && mps > 1.08,
        "{turning} of the time, {mps} m/s"
    );
}

/// Least distance of a walker from somebody who stands in its way and is not of the crowd.
fn nearest_to_other(is_given: bool) -> f32 {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add([(Vec3::ZERO, 0.0)].into_iter());
    walk(&mut crowd, 0.1, |_| {});
    crowd.agents_mut()[0].go_to(Vec2::new(0.0, 9.0));
    let other = Vec2::new(0.05, 5.0);
    if is_given {
        crowd.set_others([other, Vec2::NAN].into_iter().map(|place| Passerby {
            place,
            velocity: Vec2::ZERO,
        }));
    }
    let mut nearest = f32::INFINITY;
    walk(&mut crowd, 10.0, |crowd| {
        let place = crowd.agents()[0].place;
        nearest = nearest.min(Vec2::new(place.x, place.z).distance(other));
    });
    assert!(crowd.agents()[0].place.z > 8.0, "it arrives");
    nearest
}

#[test]
fn whoever_else_is_about_is_walked_around() {
    let [avoided, ignored] = [true, false].map(nearest_to_other);
    assert!(ignored < 0.2, "it would walk through: {ignored} m");
    assert!(avoided > 0.45, "{avoided} m");
}

#[test]
fn the_nearest_are_drawn_best_and_all_have_poses() {
    let mut crowd = crowd(Routing::Scripted);
    let starts = (0..12_u8).map(|index| (Vec3::Z * f32::from(index), 0.0));
    crowd.add(starts);
    walk(&mut crowd, 0.2, |_| {});
    crowd.choose_tiers(Vec3::ZERO, &LIMITS);
    let count = |tier: Tier| crowd.tiers().iter().filter(|own| **own == tier).count();
    assert_eq!([Tier::Full, Tier::Near, Tier::Far].map(count), [2, 4, 6]);
    assert_eq!(crowd.tiers()[0], Tier::Full);
    let mut pose = footfall_synth::CrowdPose::default();
    assert!(crowd.agents().iter().all(|agent| agent.pose(&mut pose)));
}

/// A crowd that a camera passes: walkers come near and go away again.
fn passed_by(seed: u64) -> Crowd {
    let half = Vec2::splat(20.0);
    let mut crowd = crowd_of(seed, Routing::Wander { half });
    crowd.set_count(60);
    for second in 0..8_u8 {
        walk(&mut crowd, 1.0, |_| {});
        crowd.choose_tiers(Vec3::X * (5.0 * f32::from(second) - 20.0), &LIMITS);
    }
    crowd
}

#[test]
fn equal_crowds_stay_equal_as_walkers_come_near_and_go_away() {
    let [first, second, other] = [1, 1, 2].map(passed_by);
    assert_eq!(places(&first), places(&second));
    assert_ne!(places(&first), places(&other));
    let alone = (0..60).filter(|row| first.is_alone(*row)).count();
    assert!((1..=12).contains(&alone), "{alone} take steps of their own");
    for (row, tier) in first.tiers().iter().enumerate() {
        let near = *tier != Tier::Far;
        assert!(near || first.is_alone(row) != first.shares(row));
    }
}

#[test]
fn whoever_comes_near_or_goes_away_does_not_jump() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add([(Vec3::ZERO, 0.0)].into_iter());
    walk(&mut crowd, 0.1, |_| {});
    crowd.agents_mut()[0].turn(0.1);
    let mut pose = footfall_synth::CrowdPose::default();
    let mut before: Option<Vec3> = None;
    let mut moved = 0.0_f32;
    for second in 0..12_u8 {
        // Near for a second and a half, then as long far away; those far away move in every fourth frame.
        let far = second % 3 == 2;
        crowd.choose_tiers(Vec3::X * if far { 500.0 } else { 0.0 }, &LIMITS);
        walk(&mut crowd, 1.0, |crowd| {
            let agent = &crowd.agents()[0];
            assert!(agent.pose(&mut pose));
            let turn = glam::Quat::from_rotation_y(agent.heading);
            let hand = pose.position(footfall_core::Joint::LeftHand) * agent.size;
            let hand = agent.place + turn * hand;
            moved = moved.max(before.map_or(0.0, |before| hand.distance(before)));
            before = Some(hand);
        });
    }
    // Four frames of a hand that swings at 3 m/s.
    assert!(moved < 0.2, "a hand moves by {moved} m");
}
