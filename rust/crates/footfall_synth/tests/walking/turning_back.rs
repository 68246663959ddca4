//! Reversals of the direction of travel, the body facing one way.

use crate::jumping::hips;
use crate::strafing::going;
use crate::world::{DT, Frame, Kind, generator, run};
use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Skeleton};
use glam::{Vec2, Vec3Swizzles as _};

const SPEED_MPS: f32 = 1.2;
/// Frames on either side over which a velocity is taken.
const HALF: usize = 4;
/// Frames after which the walker is asked to turn back: in every part of a step.
const ASKED: [usize; 6] = [150, 155, 160, 165, 170, 175];

/// Sidesteps to the left, and 110 frames from when the walker is asked to go to the right.
fn turned_back(seed: u64, asked: usize) -> [Vec<Frame>; 2] {
    let skeleton = Skeleton::standard();
    let mut walker = generator(Kind::Styled, seed);
    [(FRAC_PI_2, asked), (-FRAC_PI_2, 110)].map(|(direction, frames)| {
        run(&mut walker, &skeleton, &going(direction, SPEED_MPS), frames).0
    })
}

/// Velocities of the hips over the ground, m/s, from frame `HALF` on.
fn velocities(frames: &[Frame]) -> Vec<Vec2> {
    let place = |frame: &Frame| frame.model.position(Joint::Hips).xz();
    let pairs = frames.iter().zip(&frames[2 * HALF..]);
    pairs
        .map(|(then, now)| (place(now) - place(then)) / (2.0 * HALF as f32 * DT))
        .collect()
}

/// A walker brakes over a wide stance. Hips were thrown back within a tenth of a second and sank to 0.75 m in a lunge of 1.1 m, or a foot dawdled for 0.75 s.
#[test]
fn sidesteps_turn_back_without_a_lunge() {
    let mut longest = 0.0_f32;
    for (seed, asked) in (1..=6).flat_map(|seed| ASKED.map(|asked| (seed, asked))) {
        let [before, after] = turned_back(seed, asked);
        let lowest = after.iter().map(hips).fold(f32::INFINITY, f32::min);
        assert!(lowest > 0.83, "{seed}, {asked}: hips down to {lowest} m");
        let feet = [Joint::LeftFoot, Joint::RightFoot];
        let apart = after.iter().map(|frame| {
            let [left, right] = feet.map(|foot| frame.model.position(foot));
            left.distance(right)
        });
        let apart = apart.fold(0.0, f32::max);
        assert!(apart < 0.92, "{seed}, {asked}: feet {apart} m apart");
        let before = velocities(&before);
        let there = before[before.len() / 2..].iter().sum::<Vec2>().normalize();
        let after = velocities(&after);
        let secs = 2.0 * HALF as f32 * DT;
        let hardest = after.iter().zip(&after[2 * HALF..]);
        let hardest = hardest
            .map(|(then, now)| then.distance(*now) / secs)
            .fold(0.0, f32::max);
        assert!(hardest < 19.0, "{seed}, {asked}: hips at {hardest} m/s²");
        let turned = after
            .iter()
            .position(|now| now.dot(there) < -0.8 * SPEED_MPS);
        let turned = turned.expect("it turns back") as f32 * DT;
        longest = longest.max(turned);
    }
    assert!(longest < 1.3, "took {longest} s to turn back");
}
