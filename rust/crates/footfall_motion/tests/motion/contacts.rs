//! Contacts, events and steps of walkers whose steps are known.

use crate::common::walker::{Gait, STANCE, STRIDE_SECS, first_landing, mirrored, walker};
use footfall_core::{Clip, EventKind, Pose, Side, StepPosition};
use footfall_motion::contacts::{ContactConfig, Contacts, detect_contacts};
use footfall_motion::steps::segment_walks;
use glam::Quat;

fn detect(clip: &Clip) -> Contacts {
    detect_contacts(clip, &ContactConfig::from_frame(0))
}

#[test]
fn known_contacts_are_found_at_every_rate() {
    for rate in [24.0, 30.0, 60.0, 100.0, 120.0, 240.0] {
        let secs = 6.0;
        let clip = walker(rate, (secs * rate) as usize);
        let events = detect(&clip).events();
        let mut expected = 0;
        for side in Side::BOTH {
            for n in 0..5 {
                let landing = STRIDE_SECS * (first_landing(side) + n as f32);
                let times = [
                    (landing, EventKind::InitialContact),
                    (landing + STANCE * STRIDE_SECS, EventKind::TerminalContact),
                ];
                for (time, kind) in times {
                    if time > 0.1 && time < secs as f32 - 0.1 {
                        expected += 1;
                        let nearest = events
                            .iter()
                            .filter(|event| event.side == side && event.kind == kind)
                            .map(|event| (event.frame as f32 / rate as f32 - time).abs())
                            .fold(f32::INFINITY, f32::min);
                        // Speeds over two frames see a sudden lift up to one and a half frames early.
                        let allowed = (1.5 / rate as f32).max(0.021);
                        assert!(
                            nearest <= allowed,
                            "{rate} fps, {side:?} {kind:?} at {time}: off by {nearest} s"
                        );
                    }
                }
            }
        }
        // The first stance of the right foot began before the clip and ends within it.
        assert!(
            events.len() <= expected + 2,
            "{rate} fps: {} events",
            events.len()
        );
    }
}

#[test]
fn a_mirrored_clip_has_mirrored_events() {
    let clip = walker(60.0, 400);
    let events = detect(&clip).events();
    let mut other = detect(&mirrored(&clip)).events();
    for event in &mut other {
        event.side = event.side.other();
    }
    other.sort_by_key(|event| (event.frame, event.kind, event.side));
    assert_eq!(events, other);
    assert!(events.len() > 15);
}

#[test]
fn somebody_who_stands_has_contact_and_no_events() {
    let mut clip = walker(60.0, 200);
    clip.poses = vec![Pose::rest(&clip.skeleton); 200];
    let contacts = detect(&clip);
    for side in Side::BOTH {
        assert!((0..200).all(|frame| contacts.bears(side, frame)));
        assert!(contacts.foot(side).heel.iter().all(|heel| *heel));
    }
    assert!(contacts.events().is_empty());
    assert!(segment_walks(&clip, &contacts).is_empty());
}

#[test]
fn a_jump_is_two_landings_and_no_step() {
    let mut clip = walker(60.0, 120);
    let rest = Pose::rest(&clip.skeleton);
    clip.poses = (0..120)
        .map(|frame| {
            let mut pose = rest.clone();
            let secs = (frame as f32 - 40.0) / 60.0;
            // 0.4 s of flight.
            pose.root_position.y += (4.905 * secs * (0.4 - secs)).max(0.0);
            pose
        })
        .collect();
    let contacts = detect(&clip);
    let events = contacts.events();
    assert_eq!(events.len(), 4, "{events:?}");
    for event in events {
        let expected = if event.kind == EventKind::TerminalContact {
            40
        } else {
            64
        };
        assert!(event.frame.abs_diff(expected) <= 1, "{event:?}");
    }
    assert!(segment_walks(&clip, &contacts).is_empty());
}

#[test]
fn empty_and_tiny_clips_are_no_trouble() {
    for frames in 0..4 {
        let clip = walker(30.0, frames);
        let contacts = detect(&clip);
        assert_eq!(contacts.events().len(), 0);
        assert!(segment_walks(&clip, &contacts).is_empty());
        detect_contacts(&clip, &ContactConfig::from_frame(10));
    }
}

#[test]
fn steps_alternate_and_know_their_place() {
    let walking = walker(60.0, 480);
    let contacts = detect(&walking);
    let walks = segment_walks(&walking, &contacts);
    assert_eq!(walks.len(), 1);
    let steps = &walks[0].steps;
    assert!(steps.len() >= 10);
    for pair in steps.windows(2) {
        assert_eq!(pair[0].side, pair[1].side.other());
        assert_eq!(pair[0].end, pair[1].first);
    }
    for step in steps {
        assert_eq!(
            step.position,
            StepPosition::Inside,
            "the clip shows no standing"
        );
        assert!(step.frames().abs_diff(36) <= 1, "{step:?}");
        let terminal = step.other_terminal.unwrap() - step.first;
        assert!(
            terminal.abs_diff((0.12 * STRIDE_SECS * 60.0) as usize) <= 2,
            "{step:?}"
        );
    }
}

/// Walkers unlike each other in pace, in feet and in size.
const GAITS: [Gait; 6] = [
    Gait::PLAIN,
    Gait {
        stride_secs: 1.6,
        stance: 0.7,
        speed: 0.45,
        ..Gait::PLAIN
    },
    Gait {
        stride_secs: 0.95,
        stance: 0.58,
        speed: 1.2,
        ..Gait::PLAIN
    },
    Gait {
        roll: 0.9,
        ..Gait::PLAIN
    },
    Gait {
        size: 0.5,
        roll: 0.6,
        ..Gait::PLAIN
    },
    Gait {
        size: 1.3,
        roll: 0.3,
        ..Gait::PLAIN
    },
];

#[test]
fn whoever_walks_has_the_contacts_that_are_known() {
    for gait in GAITS {
        for rate in [30.0, 60.0, 120.0] {
            let secs = 7.0;
            let events = detect(&gait.clip(rate, (secs * rate) as usize)).events();
            for side in Side::BOTH {
                for (kind, phase) in [
                    (EventKind::InitialContact, 0.0),
                    (EventKind::TerminalContact, gait.stance),
                ] {
                    let found: Vec<f64> = events
                        .iter()
                        .filter(|event| event.side == side && event.kind == kind)
                        .map(|event| event.frame as f64 / rate)
                        .collect();
                    let known: Vec<f64> = (-1..10)
                        .map(|n| gait.stride_secs * (first_landing(side) + n as f32 + phase))
                        .map(f64::from)
                        .filter(|time| (0.15..secs - 0.15).contains(time))
                        .collect();
                    assert!(known.len() >= 3);
                    for time in &known {
                        let nearest = found.iter().map(|found| (found - time).abs());
                        let nearest = nearest.fold(f64::INFINITY, f64::min);
                        assert!(
                            nearest <= (1.5 / rate).max(0.026),
                            "{gait:?} at {rate} fps, {side:?} {kind:?} at {time}: off by {nearest} s"
                        );
                    }
                    assert!(found.len() <= known.len() + 1, "{gait:?}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn contacts_do_not_depend_on_how_long_somebody_stands_before() {
    let gait = Gait {
        is_gentle: true,
        roll: 0.9,
        ..Gait::PLAIN
    };
    let walk = gait.clip(120.0, 900);
    let alone = detect(&walk).events();
    let standing = 20 * 120;
    let mut with_standing = walk.clone();
    let rest = Pose::rest(&walk.skeleton);
    with_standing
        .poses
        .splice(0..0, std::iter::repeat_n(rest, standing));
    let settled = 120;
    let after: Vec<_> = detect(&with_standing)
        .events()
        .into_iter()
        .filter(|event| event.frame >= standing + settled)
        .map(|mut event| {
            event.frame -= standing;
            event
        })
        .collect();
    let alone: Vec<_> = alone.into_iter().filter(|e| e.frame >= settled).collect();
    assert!(alone.len() >= 16, "{alone:?}");
    assert_eq!(after, alone);
}

#[test]
fn a_foot_held_over_the_ground_does_not_stand() {
    let mut clip = walker(60.0, 300);
    let rest = Pose::rest(&clip.skeleton);
    // On the left leg, the right foot four centimetres up and level, for three seconds.
    clip.poses = (0..300)
        .map(|frame| {
            let mut pose = rest.clone();
            if (60..240).contains(&frame) {
                let side = Side::Right;
                pose.rotations[side.upper_leg().index()] = Quat::from_rotation_x(-0.31);
                pose.rotations[side.lower_leg().index()] = Quat::from_rotation_x(0.62);
                pose.rotations[side.foot().index()] = Quat::from_rotation_x(-0.31);
            }
            pose
        })
        .collect();
    let contacts = detect(&clip);
    assert!((0..300).all(|frame| contacts.bears(Side::Left, frame)));
    assert!((70..230).all(|frame| !contacts.bears(Side::Right, frame)));
    assert!(contacts.bears(Side::Right, 30) && contacts.bears(Side::Right, 270));
}

#[test]
fn a_larger_body_has_the_same_contacts() {
    let gait = Gait {
        is_gentle: true,
        roll: 0.7,
        ..Gait::PLAIN
    };
    let of_size = |size: f32| detect(&Gait { size, ..gait }.clip(60.0, 480)).events();
    let events = of_size(1.0);
    assert!(events.len() >= 20);
    for size in [0.4, 0.75, 1.5] {
        assert_eq!(of_size(size), events, "size {size}");
    }
}
