//! Switches of walkers whose steps are known.

use crate::common::walker::{STANCE, STRIDE_SECS, bend_leg, first_landing, walker};
use footfall_core::{Clip, FrameSpan, Pose, Side, Skeleton};
use footfall_motion::switches::{Switch, detect_switches, stances};
use glam::Vec3;

const RATE_HZ: f64 = 60.0;

fn switches_of(clip: &Clip) -> Vec<Switch> {
    detect_switches(clip, 0).expect("finite poses")
}

/// Seconds between a foot's time and its nearest switch.
fn nearest(switches: &[Switch], side: Side, secs: f32) -> f32 {
    let own = switches.iter().filter(|switch| switch.side == side);
    own.map(|switch| (switch.frame as f32 / RATE_HZ as f32 - secs).abs())
        .fold(f32::INFINITY, f32::min)
}

#[test]
fn backwards_the_foot_that_was_lifted_lands_behind() {
    let clip = walker(RATE_HZ, 420);
    let mut back = clip.clone();
    back.poses.reverse();
    let forward = switches_of(&clip);
    let switches = switches_of(&back);
    let end = (clip.poses.len() - 1) as f32 / RATE_HZ as f32;
    for side in Side::BOTH {
        for n in 0..4 {
            let lands = STRIDE_SECS * (first_landing(side) + n as f32);
            let off = nearest(&forward, side, lands);
            assert!(off < 0.05, "{side:?} forwards at {lands}: {off} s");
            // Time runs back: it lands where it left the ground.
            let lands = end - (lands + STANCE * STRIDE_SECS);
            let off = nearest(&switches, side, lands);
            assert!(off < 0.05, "{side:?} backwards at {lands}: {off} s");
        }
    }
    for pair in switches.windows(2) {
        assert_ne!(pair[0].side, pair[1].side, "feet alternate");
    }
}

/// Somebody who stands while one foot goes so far ahead and up, frame by frame.
fn stands(foot: impl Fn(f32) -> [f32; 2]) -> Clip {
    let skeleton = Skeleton::standard();
    let poses = (0..240).map(|frame| {
        let mut pose = Pose {
            root_position: Vec3::Y * (skeleton.hip_height() - 0.05),
            ..Pose::default()
        };
        for side in Side::BOTH {
            let [ahead, up] = match side {
                Side::Left => foot(frame as f32 / RATE_HZ as f32),
                Side::Right => [0.0, 0.0],
            };
            let hip = pose.root_position + skeleton.offset(side.upper_leg());
            let down = up - skeleton.foot(side).heel.y - hip.y;
            bend_leg(&skeleton, &mut pose, side, ahead, down);
        }
        pose
    });
    Clip {
        skeleton: skeleton.clone(),
        frame_rate_hz: RATE_HZ,
        poses: poses.collect(),
    }
}

/// Share of a swing from 1.5 s to 2 s, gently.
fn swung(secs: f32) -> f32 {
    let share = ((secs - 1.5) / 0.5).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[test]
fn feet_that_are_put_together_land_where_they_come_to_rest() {
    for (from, rise) in [(-0.3, 0.1), (0.0, 0.12)] {
        let clip = stands(|secs| {
            let share = swung(secs);
            [
                from * (1.0 - share),
                rise * (core::f32::consts::PI * share).sin(),
            ]
        });
        let switches = switches_of(&clip);
        assert_eq!(switches.len(), 1, "from {from}: {switches:?}");
        let off = nearest(&switches, Side::Left, 2.0);
        assert!(off < 0.06, "from {from}: {switches:?}, off by {off} s");
    }
}

#[test]
fn who_only_raises_a_heel_does_not_step() {
    let clip = stands(|secs| [0.0, 0.03 * (core::f32::consts::PI * swung(secs)).sin()]);
    assert_eq!(switches_of(&clip), []);
}

#[test]
fn who_sways_over_feet_apart_does_not_step() {
    // Feet half a step apart that change places without one above the other: a body that sways, no steps.
    let clip = stands(|secs| [0.2 * (core::f32::consts::TAU * secs).sin(), 0.0]);
    assert!(switches_of(&clip).len() <= 1, "{:?}", switches_of(&clip));
}

#[test]
fn who_steps_twice_with_one_foot_stands_on_the_other() {
    let switches = [
        (10, Side::Left),
        (40, Side::Right),
        (70, Side::Right),
        (100, Side::Left),
    ]
    .map(|(frame, side)| Switch { frame, side });
    let spans = |spans: &[[usize; 2]]| -> Vec<FrameSpan> {
        let span = |[first, last]: &[usize; 2]| FrameSpan {
            first: *first,
            last: *last,
        };
        spans.iter().map(span).collect()
    };
    let [left, right] = stances(&switches, 200);
    assert_eq!(left, spans(&[[10, 70], [100, 199]]));
    assert_eq!(right, spans(&[[40, 40], [70, 100]]));
}
