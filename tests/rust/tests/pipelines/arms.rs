//! Arms of the shipped walk where its pace changes.

use footfall_core::{Joint, ModelPose, Skeleton};
use footfall_synth::{Controls, GaitChoice};
use footfall_tests::walkers;
use glam::Vec3;

/// Places of the left hand over a walk at these speeds, m/s, for 150 frames each.
fn left_hand(seed: u64, speeds_mps: &[f32]) -> Vec<Vec3> {
    let skeleton = Skeleton::standard();
    let mut walker = walkers::generator(&skeleton, seed);
    let frames = speeds_mps.iter().flat_map(|speed_mps| [*speed_mps; 150]);
    frames
        .map(|speed_mps| {
            let controls = Controls {
                speed_mps,
                gait: GaitChoice::Walk,
                ..Controls::STAND
            };
            let pose = walkers::step_in_world(&mut walker, 1.0 / 60.0, &controls);
            ModelPose::of(&skeleton, &pose).position(Joint::LeftHand)
        })
        .collect()
}

#[test]
fn hands_turn_round_gently_where_the_pace_changes() {
    let most = |seed: u64| {
        let hand = left_hand(seed, &[1.6, 0.8, 1.6, 0.8, 1.6, 0.8]);
        let changes = hand[60..].windows(3).map(|frames| {
            let [before, now, after] = [0, 1, 2].map(|index| frames[index]);
            (before - 2.0 * now + after).length() * 3600.0
        });
        changes.fold(0.0, f32::max)
    };
    let fastest = (1..25).map(most).fold(0.0, f32::max);
    // 119 m/s² where the likeliest trajectory of the new pace takes over at once.
    assert!(fastest < 80.0, "{fastest} m/s²");
}
