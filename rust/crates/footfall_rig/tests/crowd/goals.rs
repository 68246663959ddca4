//! Goals: walkers who are sent somewhere, by ways that become known, and come to rest there.

use super::{DT_SECS, LIMITS, crowd, places, walk};
use footfall_core::Side;
use footfall_rig::crowd::{Crowd, Routing};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

#[test]
fn who_is_sent_somewhere_arrives_there_by_way_of_the_places_between() {
    let mut crowd = crowd(Routing::Scripted);
    let names = crowd.add([(Vec3::ZERO, 0.0)].into_iter());
    walk(&mut crowd, 0.1, |_| {});
    crowd.choose_tiers(Vec3::ZERO, &LIMITS);
    let row = crowd.roster().place(names[0]).expect("its row");
    let corner = Vec2::new(0.0, 5.0);
    let goal = Vec2::new(5.0, 5.0);
    crowd.agents_mut()[row].go_along([corner, goal].into_iter());
    let (mut from_corner, mut steps) = (f32::INFINITY, [0_u32; 2]);
    walk(&mut crowd, 15.0, |crowd| {
        let place = crowd.agents()[row].place;
        from_corner = from_corner.min(Vec2::new(place.x, place.z).distance(corner));
        for (_, side, _) in crowd.landed() {
            steps[usize::from(side == Side::Right)] += 1;
        }
    });
    let agent = &crowd.agents()[row];
    let end = Vec2::new(agent.place.x, agent.place.z);
    assert!(from_corner < 1.0, "{from_corner}");
    assert!(end.distance(goal) < 0.6 && !agent.is_on_its_way(), "{end}");
    assert!(agent.velocity().length() < 0.05, "it stands");
    assert!(
        steps[0].abs_diff(steps[1]) <= 2 && steps[0] > 4,
        "{steps:?}"
    );
}

#[test]
fn who_awaits_a_route_stands_until_it_is_known() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add((0..2).map(|n| (Vec3::new(3.0 * n as f32, 0.0, 0.0), 0.0)));
    walk(&mut crowd, 1.0, |_| {});
    let to = Vec3::new(0.0, 1.5, 20.0);
    let starts = places(&crowd);
    for agent in crowd.agents_mut() {
        agent.await_route(to);
    }
    walk(&mut crowd, 5.0, |_| {});
    for (agent, start) in crowd.agents().iter().zip(starts) {
        let off = agent.place.distance(start);
        assert!(off < 1.5, "{off} m from where it was");
        assert!(agent.velocity().length() < 0.05, "it stands");
        assert_eq!(agent.straight_way(), None, "its ground is unknown");
        assert_eq!(agent.awaited(), Some(to));
    }
    crowd.agents_mut()[0].go_along([Vec2::new(0.0, 12.0)].into_iter());
    crowd.agents_mut()[1].turn(0.0);
    walk(&mut crowd, 2.0, |_| {});
    for agent in crowd.agents() {
        assert_eq!(agent.awaited(), None, "it has another goal");
        assert!(agent.velocity().length() > 0.5, "it walks");
    }
}

#[test]
fn a_way_is_new_until_its_ground_is_known_and_again_at_a_corner() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add([(Vec3::ZERO, 0.0)].into_iter());
    walk(&mut crowd, 0.1, |_| {});
    let corner = Vec2::new(0.0, 5.0);
    let agent = &mut crowd.agents_mut()[0];
    assert!(!agent.is_on_new_way(), "it has no route");
    agent.go_along([corner, Vec2::new(6.0, 5.0)].into_iter());
    assert!(agent.is_on_new_way());
    agent.guide(None, [0.5; 2]);
    for _ in 0..(10.0 / DT_SECS) as usize {
        if crowd.agents()[0].is_on_new_way() {
            break;
        }
        walk(&mut crowd, DT_SECS, |_| {});
    }
    let agent = &mut crowd.agents_mut()[0];
    assert!(agent.is_on_new_way(), "at the corner");
    let place = Vec2::new(agent.place.x, agent.place.z);
    assert!(place.distance(corner) < 1.0, "{place}");
    agent.go_to(corner);
    assert!(!agent.is_on_new_way(), "no ground is known to a place");
}

#[test]
fn whoever_arrives_slows_down_and_stops_at_the_goal() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.add((0..6).map(|n| (Vec3::new(3.0 * n as f32, 0.0, 0.0), 0.0)));
    walk(&mut crowd, 0.1, |_| {});
    for (n, agent) in crowd.agents_mut().iter_mut().enumerate() {
        agent.go_to(Vec2::new(3.0 * n as f32, 8.0));
    }
    walk(&mut crowd, 20.0, |_| {});
    for agent in crowd.agents() {
        let past = agent.place.z - 8.0;
        assert!(past.abs() < 0.35, "{past} m past the goal");
    }
}

/// Goals are 0.3 to 0.7 m beside somebody who stands.
#[test]
fn whoever_is_sent_beside_somebody_comes_to_rest() {
    let mut crowd = crowd(Routing::Scripted);
    let on_circle = |turns: f32| Vec2::from_angle(2.0 * PI * turns);
    let pairs = (0..200_u8).map(|n| Vec2::new(20.0 * f32::from(n), 0.0));
    let ways: Vec<[Vec2; 3]> = pairs
        .enumerate()
        .map(|(n, stands)| {
            let from = stands + 7.0 * on_circle(n as f32 / 40.0);
            [
                stands,
                from,
                stands + (0.3 + 0.1 * (n / 40) as f32) * on_circle(0.618 * n as f32),
            ]
        })
        .collect();
    let begin = |place: Vec2| (Vec3::new(place.x, 0.0, place.y), 0.0);
    let starts: Vec<(Vec3, f32)> = ways
        .iter()
        .flat_map(|way| [begin(way[0]), begin(way[1])])
        .collect();
    let names = crowd.add(starts.into_iter());
    walk(&mut crowd, 0.1, |_| {});
    let row = |crowd: &Crowd, index: usize| crowd.roster().place(names[index]).expect("its row");
    for (index, way) in ways.iter().enumerate() {
        for (which, goal) in [way[0], way[2]].into_iter().enumerate() {
            let row = row(&crowd, 2 * index + which);
            crowd.agents_mut()[row].go_to(goal);
        }
    }
    walk(&mut crowd, 25.0, |_| {});
    let place = |crowd: &Crowd, index: usize| {
        let place = crowd.agents()[row(crowd, index)].place;
        Vec2::new(place.x, place.z)
    };
    let before: Vec<Vec2> = (0..names.len()).map(|index| place(&crowd, index)).collect();
    walk(&mut crowd, 3.0, |_| {});
    for (index, then) in before.iter().enumerate() {
        let went = then.distance(place(&crowd, index));
        assert!(went < 0.05, "{index} goes to and fro: {went} m");
        let off = then.distance(ways[index / 2][if index % 2 == 0 { 0 } else { 2 }]);
        assert!(off < 0.9, "{index} rests {off} m from its place");
    }
}

#[test]
fn ground_that_ends_leads_along_itself() {
    let mut crowd = crowd(Routing::Scripted);
    crowd.repeats = false;
    crowd.add([(Vec3::ZERO, 0.0)].into_iter());
    walk(&mut crowd, 0.1, |_| {});
    crowd.agents_mut()[0].go_along([Vec2::new(6.0, 6.0)].into_iter());
    let mut farthest = 0.0_f32;
    for _ in 0..(15.0 / DT_SECS) as usize {
        walk(&mut crowd, DT_SECS, |_| {});
        // The ground ends at z = 3 until x is 5.
        let agent = &mut crowd.agents_mut()[0];
        let ends = agent.place.x < 5.0;
        if let Some(straight) = agent.straight_way() {
            let blocked = ends && agent.place.z + straight.y > 3.0;
            agent.guide(blocked.then_some(Vec2::X), [0.7; 2]);
        }
        if ends {
            farthest = farthest.max(agent.place.z);
        }
    }
    assert!(farthest < 3.6, "{farthest} m");
    let place = crowd.agents()[0].place;
    assert!(
        Vec2::new(place.x, place.z).distance(Vec2::new(6.0, 6.0)) < 1.5,
        "{place}"
    );
    assert_eq!(crowd.agents()[0].straight_way(), None, "it has arrived");
}
