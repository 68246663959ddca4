//! Crowds over a network: one that walks here is shown there, whatever the network does.
//!
//! The link delays every message by 200 ms and up to 10 more, and loses one in twenty; what has to arrive is sent again after half a second.
//!
//! `FOOTFALL_WALKERS=1000 cargo test -p footfall_rig --test crowd_network -- --nocapture late` measures a larger crowd, `FOOTFALL_BUDGET` with another budget.

#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

mod link;
mod strangers;

use footfall_rig::crowd::{Routing, STEP_BYTES};
use glam::{Vec2, Vec3};
use link::{DT_SECS, Link, places, wander};
use rayon::prelude::*;

/// Footsteps agree within this, metres.
const SAME_PLACE_M: f32 = 0.05;

/// So long after a join steps agree, seconds.
const JOINED_SECS: f32 = 2.0;

/// Nobody who walks at 1.55 m/s and makes good 0.2 m a step goes faster, m/s.
const FASTEST_MPS: f32 = 2.6;

/// A number that the environment may set.
fn set(variable: &str, otherwise: u32) -> u32 {
    let set = std::env::var(variable).ok();
    set.and_then(|set| set.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn who_joins_late_sees_the_same_crowd_within_five_centimetres() {
    const { assert!(STEP_BYTES <= 24) };
    let count = set("FOOTFALL_WALKERS", 60);
    let mut link = Link::new(wander(), count as usize);
    link.bytes_per_second = set("FOOTFALL_BUDGET", 1_000_000);
    link.walk(20.0);
    link.join();
    let joined = link.secs;
    link.walk(40.0);
    let all = link.differences(joined + JOINED_SECS);
    let [median, most, nearly_all, worst] = link.shares(joined + JOINED_SECS);
    println!(
        "{count} walkers: {} of their steps shown, {:.1} mm off in the median, {:.1} for 99 %, {:.1} for 99.9 %, {:.1} at most; \
         {:.0} bytes a second a walker, {:.0} to introduce one; fastest {:.2} m/s",
        all.len(),
        1e3 * median,
        1e3 * most,
        1e3 * nearly_all,
        1e3 * worst,
        link.sent[0] as f32 / 40.0 / count as f32,
        link.sent[1] as f32 / count as f32,
        link.fastest_mps,
    );
    assert_eq!(places(&link.there).len(), count as usize);
    assert!(all.len() > 50 * count as usize, "only {} steps", all.len());
    assert!(nearly_all < SAME_PLACE_M, "{nearly_all} m");
    assert!(link.fastest_mps < FASTEST_MPS, "{} m/s", link.fastest_mps);
}

/// An introduction that is lost arrives after steps that were sent later, and they are sent no more.
#[test]
fn steps_that_overtake_their_walkers_are_taken() {
    let mut link = Link::new(wander(), 60);
    link.loss = 0.0;
    link.reliable_secs = 1.2;
    link.walk(20.0);
    link.join();
    let joined = link.secs;
    link.walk(5.0);
    let all = link.differences(joined + JOINED_SECS);
    assert!(all.len() > 200, "only {} steps", all.len());
    let worst = all[all.len() - 1];
    assert!(worst < SAME_PLACE_M, "{worst} m");
}

#[test]
fn who_stops_and_goes_again_does_so_in_the_same_place() {
    let mut link = Link::new(Routing::Scripted, 0);
    let starts = (0..24_u8).map(|index| (Vec3::X * f32::from(index) * 2.0, 0.3));
    let names = link.here.add(starts);
    link.join();
    link.walk(1.0);
    for round in 0..3_u8 {
        for (index, name) in names.iter().enumerate() {
            let row = link.here.roster().place(*name).expect("its row");
            let aside = if (index + usize::from(round)).is_multiple_of(2) {
                3.0
            } else {
                -4.0
            };
            let agent = &mut link.here.agents_mut()[row];
            let goal = Vec2::new(agent.place.x + aside, agent.place.z + 5.0);
            agent.go_to(goal);
        }
        // Those who meet in the middle take longest.
        link.walk(24.0);
        let (made, shown) = (places(&link.here), places(&link.there));
        for name in &names {
            let off = made[name].distance(shown[name]);
            assert!(off < SAME_PLACE_M, "{name} rests {off} m from its place");
            let heading = |crowd: &footfall_rig::crowd::Crowd| {
                let row = crowd.roster().place(*name).expect("its row");
                crowd.agents()[row].heading
            };
            let turned = heading(&link.here) - heading(&link.there);
            let turned = turned.sin().abs();
            assert!(turned < 0.18, "{name} looks {turned} rad elsewhere");
        }
    }
    let [.., nearly_all, worst] = link.shares(4.0);
    assert!(nearly_all < SAME_PLACE_M, "{nearly_all} m, {worst} at most");
}

#[test]
fn who_comes_and_leaves_does_so_there_and_keeps_its_name() {
    let mut link = Link::new(wander(), 20);
    link.join();
    link.walk(3.0);
    let names = |crowd: &footfall_rig::crowd::Crowd| {
        let mut names: Vec<i32> = crowd.names().collect();
        names.sort_unstable();
        names
    };
    assert_eq!(names(&link.here), names(&link.there));
    for _ in 0..3 {
        let leaving: Vec<usize> = (0..5).collect();
        link.here.leave(&leaving);
        let more = (0..7_u8).map(|index| (Vec3::Z * f32::from(index), 1.0));
        link.here.add(more);
        link.walk(2.0);
        assert_eq!(names(&link.here), names(&link.there));
    }
    // Nobody takes the places of these.
    link.here.leave(&[1, 6, 11]);
    link.walk(1.0);
    assert_eq!(names(&link.here), names(&link.there));
    assert_eq!(places(&link.there).len(), 23);
    // Somebody grows and puts on a red coat.
    let agent = &mut link.here.agents_mut()[3];
    (agent.size, agent.tint) = (1.25, [1.0, 0.0, 0.0, 1.0]);
    link.walk(3.0);
    let there = &link.there.agents()[3];
    assert!((there.size - 1.25).abs() < 1e-3 && there.tint[1] < 1e-3);
    let [.., nearly_all, _] = link.shares(link.secs - 2.0);
    assert!(nearly_all < SAME_PLACE_M, "{nearly_all} m");
}

#[test]
fn what_is_off_after_an_outage_is_walked_off() {
    let mut link = Link::new(wander(), 60);
    link.join();
    link.walk(10.0);
    link.loss = 1.0;
    link.walk(1.5);
    link.loss = 0.05;
    let back = link.secs;
    link.walk(24.0);
    let [.., worst] = link.shares(back - 1.0);
    assert!(worst > 2.0 * SAME_PLACE_M, "nobody was off: {worst} m");
    assert!(link.fastest_mps < FASTEST_MPS, "{} m/s", link.fastest_mps);
    let [.., nearly_all, worst] = link.shares(back + 14.0);
    assert!(nearly_all < SAME_PLACE_M, "{nearly_all} m, {worst} at most");
}

/// A machine that loads something stands still for two seconds, and its crowd with it.
#[test]
fn who_stood_still_finds_the_others_again() {
    for pauses in [[true, false], [false, true]] {
        let mut link = Link::new(wander(), 60);
        link.join();
        link.walk(10.0);
        link.pauses = pauses;
        link.walk(2.0);
        link.pauses = [false; 2];
        let back = link.secs;
        link.walk(24.0);
        let [.., worst] = link.shares(back - 2.0);
        assert!(worst > 2.0 * SAME_PLACE_M, "nobody was off: {worst} m");
        let [median, _, _, worst] = link.shares(back + 6.0);
        println!("{pauses:?}: {median} m in the median, {worst} at most");
        let [.., nearly_all, worst] = link.shares(back + 14.0);
        assert!(nearly_all < SAME_PLACE_M, "{nearly_all} m, {worst} at most");
    }
}

/// Networks differ in the steps that they lose, so that several count together.
#[test]
fn a_small_budget_is_kept_and_shared_by_who_needs_it() {
    const NETWORKS: u8 = 16;
    let all: Vec<f32> = (0..NETWORKS)
        .into_par_iter()
        .map(most_of_a_small_budget)
        .collect();
    let most = all.iter().sum::<f32>() / f32::from(NETWORKS);
    assert!(most < 0.5, "{most} m for 99 %");
}

/// Checks one network that carries a third of what all copies of all steps take; returns the distance within which 99 % of the footsteps agree, metres.
fn most_of_a_small_budget(chance: u8) -> f32 {
    let mut link = Link::new(wander(), 120);
    link.chance = 5 + u32::from(chance);
    link.bytes_per_second = 4000;
    link.join();
    link.walk(40.0);
    let [steps, people] = link.sent;
    assert!(steps < 41 * 4000, "{steps} bytes about steps");
    assert!(people < 120 * 45, "{people} bytes about people");
    let [median, most, ..] = link.shares(10.0);
    assert!(median < SAME_PLACE_M, "{median} m in the median");
    assert!(link.fastest_mps < FASTEST_MPS, "{} m/s", link.fastest_mps);
    most
}

#[test]
fn who_follows_no_more_goes_on_by_itself() {
    let mut link = Link::new(wander(), 10);
    link.join();
    link.walk(3.0);
    link.there.lead();
    let before = places(&link.there);
    for _ in 0..(3.0 / DT_SECS) as usize {
        link.there.begin_all().expect("a walk");
        link.there.advance(DT_SECS, true);
    }
    let after = places(&link.there);
    assert_eq!(before.len(), after.len());
    let went = after
        .iter()
        .filter(|(name, place)| place.distance(before[name]) > 0.3);
    assert!(went.count() > 5, "they stand");
}

#[test]
fn who_shared_steps_before_it_is_told_takes_its_own_then_and_there() {
    let mut link = Link::new(wander(), 30);
    link.here.repeats = true;
    link.walk(3.0);
    assert!((0..30).all(|row| link.here.shares(row)), "own steps");
    link.here.repeats = false;
    link.join();
    let joined = link.secs;
    link.walk(6.0);
    for crowd in [&link.here, &link.there] {
        assert_eq!(places(crowd).len(), 30);
        assert!((0..30).all(|row| crowd.is_alone(row)), "shared steps");
    }
    let [.., worst] = link.shares(joined + JOINED_SECS);
    assert!(worst < SAME_PLACE_M, "{worst} m");
}
