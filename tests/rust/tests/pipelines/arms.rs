//! Arms of the shipped walk where its pace changes.

use footfall_core::Joint;
use footfall_synth::{Controls, GaitChoice};
use footfall_tests::walkers;

#[test]
fn hands_turn_round_gently_where_the_pace_changes() {
    let most = |seed: u64| {
        let walk = walkers::shown(seed, 900, |frame| Controls {
            speed_mps: [1.6, 0.8][frame / 150 % 2],
            gait: GaitChoice::Walk,
            ..Controls::STAND
        });
        let hand = walk[60..]
            .iter()
            .map(|(body, _)| body.position(Joint::LeftHand));
        walkers::most_acceleration(&hand.collect::<Vec<_>>())
    };
    let fastest = (1..25).map(most).fold(0.0, f32::max);
    // 119 m/s² where the likeliest trajectory of the new pace takes over at once.
    assert!(fastest < 80.0, "{fastest} m/s²");
}
