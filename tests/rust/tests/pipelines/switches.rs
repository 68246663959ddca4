//! Switches of joint angles against contacts that are known otherwise.

use footfall_core::{Clip, EventKind, Pose, Side, Skeleton};
use footfall_model::GaitModel;
use footfall_motion::corpus::{Corpus, Where};
use footfall_motion::switches::{Switch, detect_switches, stances};
use footfall_synth::{WalkConfig, synthesize};
use footfall_tests::data::{recordings, repository};
use std::sync::Arc;

/// Seconds apart at most.
const TOLERANCE_SECS: f64 = 0.0335;
/// A contact of a generated walk begins when its foot is at rest, so long after the foot touches the ground, seconds: as the shipped walk was trained.
const REST_SECS: f64 = 0.025;

/// 2 TP / (found + known), foot by foot; events near the ends of the clip are left out.
fn agreement(
    switches: &[Switch],
    known: &[(usize, Side)],
    clip: &Clip,
    first: usize,
) -> [usize; 3] {
    let edge = (0.1 * clip.frame_rate_hz) as usize;
    let inside = |frame: usize| (first + edge..clip.poses.len() - edge).contains(&frame);
    let mut counts = [0; 3];
    for side in Side::BOTH {
        let mut found: Vec<usize> = switches
            .iter()
            .filter(|s| s.side == side && inside(s.frame))
            .map(|s| s.frame)
            .collect();
        let known = known
            .iter()
            .filter(|(frame, foot)| *foot == side && inside(*frame));
        counts[1] += found.len();
        for (frame, _) in known {
            counts[2] += 1;
            let near = |other: &usize| {
                other.abs_diff(*frame) as f64 <= TOLERANCE_SECS * clip.frame_rate_hz
            };
            if let Some(index) = found.iter().position(near) {
                found.remove(index);
                counts[0] += 1;
            }
        }
    }
    counts
}

fn f1([matched, found, known]: [usize; 3]) -> f64 {
    2.0 * matched as f64 / (found + known) as f64
}

#[test]
fn steps_of_generated_walks_are_found_at_any_rate() {
    let path = repository().join("addons/footfall/models/locomotion.footfall");
    let model = Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap());
    let mut counts = [0; 3];
    for (seed, rate) in [
        (1, 60.0),
        (2, 120.0),
        (3, 30.0),
        (4, 100.0),
        (5, 60.0),
        (6, 24.0),
    ] {
        let config = WalkConfig {
            steps: 12,
            seed,
            variation: 1.0,
            speed_mps: None,
            turn_rate_radps: 0.0,
            direction_rad: 0.0,
            frame_rate_hz: Some(rate),
            from_standing: false,
            gait: footfall_synth::GaitChoice::Auto,
        };
        let walk = synthesize(&model, &Skeleton::standard(), &config).unwrap();
        let switches = detect_switches(&walk.clip, 0).unwrap();
        for pair in switches.windows(2) {
            assert!(pair[0].frame < pair[1].frame);
            assert_ne!(pair[0].side, pair[1].side, "feet alternate");
        }
        let at_rest_after = (REST_SECS * walk.clip.frame_rate_hz).round() as usize;
        let known: Vec<(usize, Side)> = walk
            .events()
            .iter()
            .filter(|event| event.kind == EventKind::InitialContact)
            .map(|event| (event.frame.saturating_sub(at_rest_after), event.side))
            .collect();
        let own = agreement(&switches, &known, &walk.clip, 0);
        for (sum, own) in counts.iter_mut().zip(own) {
            *sum += own;
        }
        let stances = stances(&switches, walk.clip.poses.len());
        assert_eq!(stances[0].len() + stances[1].len(), switches.len());
    }
    assert!(f1(counts) > 0.9, "F1 {:.2}, {counts:?}", f1(counts));
}

#[test]
fn nobody_walks_nothing_switches() {
    let skeleton = Skeleton::standard();
    let clip = |poses: Vec<Pose>| Clip {
        skeleton: skeleton.clone(),
        frame_rate_hz: 60.0,
        poses,
    };
    let still = Pose::rest(&skeleton);
    for frames in [0, 1, 5, 12, 300] {
        let found = detect_switches(&clip(vec![still.clone(); frames]), 0).unwrap();
        assert!(found.is_empty(), "{found:?} of {frames} frames");
    }
    let mut broken = vec![still; 100];
    broken[50].rotations[Side::Left.upper_leg().index()].x = f32::NAN;
    assert!(detect_switches(&clip(broken), 0).is_err());
}

#[test]
fn switches_of_captured_walks_are_the_kinematic_contacts() {
    let Some(data) = recordings("switches_of_captured_walks_are_the_kinematic_contacts") else {
        return;
    };
    let conditions: Vec<Where> = ["category=neutral_walk", "path=cmu/*"]
        .map(|condition| condition.parse().unwrap())
        .into();
    let corpus = Corpus::read(data.join("index.csv"), &conditions).unwrap();
    let mut counts = [0; 3];
    for clip in &corpus.clips {
        let motion = &clip.retargeted;
        let switches = detect_switches(&motion.clip, motion.first_frame).unwrap();
        let known: Vec<(usize, Side)> = clip
            .contacts
            .events()
            .iter()
            .filter(|event| event.kind == EventKind::InitialContact)
            .map(|event| (event.frame, event.side))
            .collect();
        let own = agreement(&switches, &known, &motion.clip, motion.first_frame);
        for (sum, own) in counts.iter_mut().zip(own) {
            *sum += own;
        }
    }
    assert!(f1(counts) >= 0.9, "F1 {:.2}, {counts:?}", f1(counts));
}
