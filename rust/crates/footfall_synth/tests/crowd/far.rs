//! Walkers of a crowd far away, who share steps: as fast as those near by, without jumps, on feet that stay.

use super::{DT, config, styled};
use footfall_core::Joint;
use footfall_synth::{Controls, CrowdPose, CrowdWalker, StyledBody, Workshop};
use glam::Vec3;

/// The way and the mean speed of a walker, after it has settled, who shares steps or takes its own.
fn mean_speed(seed: u64, speed_mps: f32, shares: bool, workshop: &mut Workshop) -> f32 {
    let mut walker = CrowdWalker::new(&styled(), &config(seed, 0.2, 1.0), false, workshop).unwrap();
    walker.set_repeating(shares);
    let controls = Controls {
        speed_mps,
        ..Controls::STAND
    };
    let mut from = Vec3::ZERO;
    for frame in 0..1500 {
        walker.step(DT, controls, workshop);
        if frame == 300 {
            from = walker.start_from_character().position;
        }
    }
    let way = walker.start_from_character().position - from;
    way.length() / 20.0
}

#[test]
fn whoever_shares_steps_walks_and_runs_as_fast_as_asked() {
    let mut workshop = Workshop::new(&styled());
    for speed_mps in [0.5, 0.8, 1.0, 1.2, 1.25, 1.5, 1.8, 2.4, 2.8, 3.5] {
        let mut mean = [0.0; 2];
        for seed in 0..8 {
            for (mean, shares) in mean.iter_mut().zip([false, true]) {
                *mean += mean_speed(seed, speed_mps, shares, &mut workshop) / 8.0;
            }
        }
        assert!(
            (mean[1] / mean[0] - 1.0).abs() < 0.05,
            "asked {speed_mps}: {mean:?}"
        );
    }
}

/// One who shares steps from the first one on.
fn sharing(styled: &StyledBody, seed: u64) -> CrowdWalker {
    CrowdWalker::sharing(styled, &config(seed, 0.2, 1.0))
}

/// Changes of speed, a run, stops and a turn on the spot.
fn asked_far_away(frame: usize) -> Controls {
    let (speed_mps, turn_rate_radps) = match frame {
        0..200 => (1.3, 0.0),
        200..400 => (0.6, 0.4),
        600..700 => (0.0, 0.8),
        700..900 => (3.0, 0.0),
        900..1100 => (1.0, -0.5),
        _ => (0.0, 0.0),
    };
    Controls {
        speed_mps,
        turn_rate_radps,
        ..Controls::STAND
    }
}

#[test]
fn a_speed_and_a_turn_are_taken_up_far_away() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    let mut walker = sharing(&styled, 3);
    let mut walk = |secs: usize, speed_mps: f32, turn_rate_radps: f32| {
        let from = walker.start_from_character();
        let controls = Controls {
            speed_mps,
            turn_rate_radps,
            ..Controls::STAND
        };
        for _ in 0..60 * secs {
            walker.step(DT, controls, &mut workshop);
        }
        let now = walker.start_from_character();
        let way = now.position.distance(from.position);
        let turned = footfall_core::rotation::wrap_angle(now.heading - from.heading);
        (way / secs as f32, turned)
    };
    for speed_mps in [1.5, 0.6, 2.8, 0.9] {
        walk(2, speed_mps, 0.0);
        let (walked, _) = walk(4, speed_mps, 0.0);
        assert!(
            (walked / speed_mps - 1.0).abs() < 0.06,
            "{walked} of {speed_mps} m/s"
        );
    }
    walk(1, 1.0, 0.3);
    let (_, turned) = walk(6, 1.0, 0.3);
    assert!((turned - 1.8).abs() < 0.15, "{turned} rad");
    walk(2, 0.0, 0.0);
    let (walked, turned) = walk(2, 0.0, 0.0);
    assert!(walked < 1e-4 && turned.abs() < 1e-4, "it stands");
    let (walked, turned) = walk(3, 0.0, 0.6);
    assert!(
        walked < 0.1 && turned > 1.2,
        "it turns on the spot: {walked} m/s, {turned} rad"
    );
}

#[test]
fn shared_steps_go_over_into_each_other_without_a_jump() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    let mut walker = sharing(&styled, 4);
    let mut joints = CrowdPose::default();
    let mut before: Option<[Vec3; 22]> = None;
    for frame in 0..1300 {
        walker.step(DT, asked_far_away(frame), &mut workshop);
        walker.pose(&mut joints);
        let place = walker.start_from_character();
        let turn = footfall_core::rotation::from_heading(place.heading);
        let now: [Vec3; 22] = core::array::from_fn(|joint| {
            place.position + turn * joints.position(Joint::ALL[joint])
        });
        if let Some(before) = before {
            for (joint, (now, before)) in Joint::ALL.iter().zip(now.iter().zip(before)) {
                // Hands and feet of a runner move at 8 m/s.
                let moved = now.distance(before);
                assert!(moved < 0.16, "frame {frame}: {joint:?} jumps by {moved} m");
            }
        }
        before = Some(now);
    }
}

#[test]
fn feet_far_away_stay_where_they_stand() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    for speed_mps in [0.9, 1.1, 1.35, 1.65] {
        let mut walker = sharing(&styled, 5);
        let controls = Controls {
            speed_mps,
            ..Controls::STAND
        };
        let mut joints = CrowdPose::default();
        let mut stood: [Option<Vec3>; 2] = [None; 2];
        let mut slipped = 0.0_f32;
        for frame in 0..600 {
            walker.step(DT, controls, &mut workshop);
            walker.pose(&mut joints);
            let place = walker.start_from_character();
            let contacts = walker.feet_in_contact();
            let feet = [Joint::LeftToes, Joint::RightToes];
            for ((foot, stood), bears) in feet.into_iter().zip(&mut stood).zip(contacts) {
                let at = place.position + joints.position(foot);
                let other = contacts.iter().all(|bears| *bears);
                if !bears || other {
                    *stood = None;
                } else if frame > 120 {
                    let from = *stood.get_or_insert(at);
                    slipped = slipped.max((at - from).with_y(0.0).length());
                }
            }
        }
        assert!(slipped < 0.03, "{slipped} m at {speed_mps} m/s");
    }
}

fn controls_stand(frame: usize) -> bool {
    asked_far_away(frame).is_standing()
}

#[test]
fn the_poses_that_a_texture_holds_are_those_that_are_shown() {
    let styled = styled().numbered(7);
    let mut workshop = Workshop::new(&styled);
    let mut walker = sharing(&styled, 6);
    let (mut shown, mut looks) = (CrowdPose::default(), Vec::new());
    for frame in 0..1300 {
        walker.step(DT, asked_far_away(frame), &mut workshop);
        walker.pose(&mut shown);
        let (number, look) = walker.shared_pose(0.0).unwrap();
        assert_eq!(number, 7);
        let (_, ago) = walker.shared_pose(DT).unwrap();
        // As the shader blends them.
        let read = |pose: usize, joint: Joint| {
            let mut out = CrowdPose::default();
            styled.shared_pose(pose, &mut out);
            out.position(joint)
        };
        let blended = |look: &footfall_synth::SharedPose, joint: Joint| {
            let two = |first: usize| read(first, joint).lerp(read(first + 1, joint), look.blend);
            let first = look.pose as usize;
            let left = first.saturating_add_signed(9 * isize::from(look.beside));
            two(first).lerp(two(left), look.leaving)
        };
        for joint in [Joint::LeftHand, Joint::RightFoot] {
            let off = blended(&look, joint).distance(shown.position(joint));
            assert!(off < 1e-3, "frame {frame}: {joint:?} is {off} m off");
            // Who sets out from a stand ends its sway at once.
            let stood = frame > 0 && controls_stand(frame - 1) && !controls_stand(frame);
            if let Some(before) = looks.last().filter(|_| !stood) {
                let off = blended(&ago, joint).distance(blended(before, joint));
                assert!(off < 0.03, "frame {frame}: {joint:?} was {off} m off");
            }
        }
        assert!((look.pose as usize) + 1 < styled.shared_poses());
        looks.push(look);
    }
    assert!(
        looks
            .iter()
            .any(|look| look.leaving > 0.5 && look.beside < 0)
    );
}
