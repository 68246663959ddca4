//! Arms keep clear of the trunk and of each other.

use crate::strafing::going;
use crate::world::{Frame, Kind, generator, run, walking};
use core::f32::consts::PI;
use footfall_core::{Joint, Skeleton};
use footfall_synth::Controls;
use glam::Vec3;

/// Points on a forearm, elbow to hand, and on the trunk, hips to neck.
const POINTS: u8 = 8;

fn points(from: Vec3, to: Vec3) -> impl Iterator<Item = Vec3> + Clone {
    (0..=POINTS).map(move |point| from.lerp(to, f32::from(point) / f32::from(POINTS)))
}

/// Least distances of the forearms' middle lines from that of the trunk, and from each other, metres.
fn clearances(frames: &[Frame]) -> [f32; 2] {
    let mut least = [f32::INFINITY; 2];
    for frame in frames {
        let line =
            |from: Joint, to: Joint| points(frame.model.position(from), frame.model.position(to));
        let trunk = line(Joint::Hips, Joint::Neck);
        let left = line(Joint::LeftLowerArm, Joint::LeftHand);
        let right = line(Joint::RightLowerArm, Joint::RightHand);
        for arm in [&left, &right] {
            for point in arm.clone() {
                let nearest = trunk.clone().map(|of_trunk| of_trunk.distance(point));
                least[0] = nearest.fold(least[0], f32::min);
            }
        }
        for point in left {
            let nearest = right.clone().map(|other| other.distance(point));
            least[1] = nearest.fold(least[1], f32::min);
        }
    }
    least
}

/// Forearms of walkers at CMU are 13 cm from the middle of the trunk, those of O3DE's actor who crouches 8. Arms that were turned as far as other people's, from another posture, or swung
/// to the other side of it, went through hips and each other.
#[test]
fn arms_keep_clear_of_the_body() {
    let skeleton = Skeleton::standard();
    let crouched = |controls: Controls| Controls {
        crouch: 1.0,
        ..controls
    };
    for (what, controls, trunk_m, other_m) in [
        ("walking", walking(1.3), 0.11, 0.3),
        ("backwards", going(PI, 1.0), 0.08, 0.25),
        ("crouched", crouched(Controls::STAND), 0.09, 0.06),
        ("walking crouched", crouched(walking(0.9)), 0.065, 0.1),
        ("backwards crouched", crouched(going(PI, 0.8)), 0.08, 0.1),
    ] {
        for seed in 1..=4 {
            let mut walker = generator(Kind::Styled, seed);
            run(&mut walker, &skeleton, &controls, 90);
            let (frames, _) = run(&mut walker, &skeleton, &controls, 240);
            let [trunk, other] = clearances(&frames);
            assert!(
                trunk > trunk_m && other > other_m,
                "{what}, seed {seed}: {trunk} m from the trunk, {other} m from each other"
            );
        }
    }
}
