//! Feet and knees of the shipped walk: where standing feet point, and how gently knees let go of the ground.

use footfall_core::{Joint, ModelPose, Side};
use footfall_synth::{Controls, GaitChoice};
use footfall_tests::walkers;
use glam::Vec3;

/// A frame of the body, and the feet that stand in it.
type Shown = (ModelPose, [bool; 2]);

/// Five seconds of a walk straight ahead, out of standing; it is asked to stop from this frame on.
fn walk_until(seed: u64, speed_mps: f32, stops: usize) -> Vec<Shown> {
    walkers::shown(seed, 300, |frame| {
        if frame < stops {
            Controls {
                speed_mps,
                gait: GaitChoice::Walk,
                ..Controls::STAND
            }
        } else {
            Controls::STAND
        }
    })
}

/// Five seconds of a walk straight ahead, out of standing.
fn walk(seed: u64, speed_mps: f32) -> Vec<Shown> {
    walk_until(seed, speed_mps, usize::MAX)
}

/// Greatest change of a knee's velocity, m/s².
fn fastest_knee(walk: &[Shown]) -> f32 {
    let fastest = Side::BOTH.map(|side| {
        let places = walk.iter().map(|(body, _)| body.position(side.lower_leg()));
        walkers::most_acceleration(&places.collect::<Vec<_>>())
    });
    fastest[0].max(fastest[1])
}

#[test]
fn knees_let_go_of_the_ground_gently() {
    let fast = (1..100)
        .flat_map(|seed| [0.9, 1.2, 1.4].map(|speed| fastest_knee(&walk(seed, speed))))
        .filter(|fastest| *fastest > 105.0)
        .count();
    // 40 where a leg stays straight until it leaves the ground.
    assert!(fast <= 12, "{fast} walks of 297");
}

#[test]
fn knees_let_go_gently_where_a_walk_stops() {
    // At any time of a step.
    let stops = (1..100).map(|seed| (seed, 150 + seed as usize % 40));
    let fast = stops
        .map(|(seed, stops)| fastest_knee(&walk_until(seed, 1.3, stops)[stops..]))
        .filter(|fastest| *fastest > 120.0)
        .count();
    assert!(fast <= 5, "{fast} stops of 99");
}

#[test]
fn feet_stand_as_people_s_lie_and_not_as_their_heels_strike() {
    let (mut sum, mut count) = (0.0, 0);
    for seed in 1..25 {
        for (body, stands) in walk(seed, 1.3).into_iter().skip(120) {
            let forwards = body.rotation(Joint::Hips) * Vec3::Z;
            for side in Side::BOTH {
                if stands[side.index()] {
                    let toes = body.rotation(side.foot()) * Vec3::Z;
                    let turn = toes.x.atan2(toes.z) - forwards.x.atan2(forwards.z);
                    sum += turn * if side == Side::Left { 1.0 } else { -1.0 };
                    count += 1;
                }
            }
        }
    }
    let outwards = (sum / count as f32).to_degrees();
    assert!(outwards < 2.0, "toes point {outwards}° outwards");
}
