//! Contacts, events and steps of walkers whose steps are known, and of the recordings against published detectors.

mod common;

use common::walker::{STANCE, STRIDE_SECS, first_landing, mirrored, walker};
use footfall_core::{Clip, EventKind, Pose, Side, StepPosition};
use footfall_motion::contacts::{ContactConfig, Contacts, detect_contacts};
use footfall_motion::steps::segment_walks;

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

/// Share of events that have a partner within the tolerance, as F1, and the mean delay of ours, seconds.
fn agreement(pairs: &[(Vec<f64>, Vec<f64>)], tolerance_secs: f64) -> (f64, f64) {
    let (mut matched, mut all, mut delay) = (0, 0, 0.0);
    for (ours, reference) in pairs {
        all += ours.len() + reference.len();
        let mut free = ours.clone();
        for time in reference {
            let nearest = (0..free.len())
                .min_by(|&a, &b| (free[a] - time).abs().total_cmp(&(free[b] - time).abs()));
            if let Some(n) = nearest
                && (free[n] - time).abs() <= tolerance_secs
            {
                delay += free.swap_remove(n) - time;
                matched += 1;
            }
        }
    }
    (
        2.0 * f64::from(matched) / all as f64,
        delay / f64::from(matched),
    )
}

/// Zeni et al. 2008: a foot lands where it is farthest ahead of the hips and lifts where it is farthest behind.
fn zeni(clip: &Clip, first: usize, side: Side) -> (Vec<usize>, Vec<usize>) {
    use footfall_core::{Joint, ModelPose, forward_kinematics};
    let rate = clip.frame_rate_hz;
    let mut model = ModelPose::default();
    let (mut hips, mut ankles, mut toes) = (Vec::new(), Vec::new(), Vec::new());
    for pose in &clip.poses[first..] {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        hips.push(model.position(Joint::Hips));
        ankles.push(model.position(side.foot()));
        toes.push(model.position(side.toes()));
    }
    let reach = (0.25 * rate) as usize;
    let ahead: Vec<_> = (0..hips.len())
        .map(|n| {
            let (from, to) = (n.saturating_sub(reach), (n + reach).min(hips.len() - 1));
            (hips[to] - hips[from]).with_y(0.0).normalize_or_zero()
        })
        .collect();
    let extremes = |points: &[glam::Vec3], sign: f32| {
        let along: Vec<f32> = (0..points.len())
            .map(|n| sign * (points[n] - hips[n]).dot(ahead[n]))
            .collect();
        let apart = (0.3 * rate) as usize;
        (1..along.len().saturating_sub(1))
            .filter(|&n| {
                let window = &along[n.saturating_sub(apart)..=(n + apart).min(along.len() - 1)];
                let highest = window.iter().copied().fold(f32::MIN, f32::max);
                let lowest = window.iter().copied().fold(f32::MAX, f32::min);
                along[n] >= highest && highest - lowest > 0.1
            })
            .map(|n| n + first)
            .collect()
    };
    (extremes(&ankles, 1.0), extremes(&toes, -1.0))
}

#[test]
fn events_of_recorded_walks_agree_with_a_published_detector() {
    use footfall_motion::bvh;
    use footfall_motion::retarget::{RetargetOptions, retarget};
    let Some(folder) = common::data_folder() else {
        return;
    };
    for set in [
        "cmu/neutral_walk",
        "bandai/neutral_walk",
        "bandai/styled_walk",
    ] {
        let mut initial = Vec::new();
        let mut terminal = Vec::new();
        for path in common::bvh_files(&folder.join(set)) {
            let file = bvh::read(&path).unwrap();
            let retargeted = retarget(&file, &RetargetOptions::default()).unwrap();
            let (clip, first) = (&retargeted.clip, retargeted.first_frame);
            let events = detect_contacts(clip, &ContactConfig::from_frame(first)).events();
            let margin = (0.2 * clip.frame_rate_hz) as usize;
            let inside = first + margin..clip.poses.len() - margin;
            let secs = |frames: Vec<usize>| -> Vec<f64> {
                frames
                    .into_iter()
                    .filter(|frame| inside.contains(frame))
                    .map(|frame| frame as f64 / clip.frame_rate_hz)
                    .collect()
            };
            for side in Side::BOTH {
                let ours = |kind: EventKind| {
                    secs(
                        events
                            .iter()
                            .filter(|event| event.side == side && event.kind == kind)
                            .map(|event| event.frame)
                            .collect(),
                    )
                };
                let (landings, lifts) = zeni(clip, first, side);
                initial.push((ours(EventKind::InitialContact), secs(landings)));
                terminal.push((ours(EventKind::TerminalContact), secs(lifts)));
            }
        }
        for (kind, pairs, bias) in [("initial", &initial, 0.03), ("terminal", &terminal, 0.015)] {
            let (f1, delay) = agreement(pairs, 0.0501);
            println!("{set} {kind}: F1 {f1:.3}, {:+.1} ms", delay * 1000.0);
            assert!(f1 > 0.95, "{set} {kind}: F1 {f1}");
            assert!(delay.abs() < bias, "{set} {kind}: {delay} s");
        }
    }
}
