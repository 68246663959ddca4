//! Pushes: at once, over planted feet, and stepped off.

use crate::jumping::{hips, stander};
use crate::world::{
    DT, Frame, Kind, assert_planted_within, assert_smooth, generator, run, walking,
};
use footfall_core::{Joint, Pose, Skeleton};
use footfall_synth::Controls;
use glam::{Vec2, Vec3};

#[test]
fn a_soft_push_is_stood_and_a_hard_one_stepped_off() {
    let skeleton = Skeleton::standard();
    for (seed, push, steps) in [
        (1, Vec2::new(0.15, 0.1), false),
        (2, Vec2::new(0.0, 0.9), true),
        (3, Vec2::new(0.8, 0.0), true),
        (4, Vec2::new(0.0, -0.8), true),
        (5, Vec2::new(-1.0, 0.5), true),
    ] {
        let mut generator = stander(seed);
        let (before, _) = run(&mut generator, &skeleton, &Controls::STAND, 20);
        generator.push(push);
        let (frames, footsteps) = run(&mut generator, &skeleton, &Controls::STAND, 300);
        assert_eq!(!footsteps.is_empty(), steps, "{push} m/s: {footsteps:?}");
        let level = |frame: &Frame| frame.model.position(Joint::Hips).with_y(0.0);
        let farthest = frames
            .iter()
            .map(|frame| (level(frame) - level(&before[19])).dot(Vec3::new(push.x, 0.0, push.y)))
            .fold(0.0, f32::max)
            / push.length();
        assert!((0.005..1.5).contains(&farthest), "{farthest} m for {push}");
        assert!(generator.is_standing(), "{push} m/s leaves it walking");
        assert_planted_within(&skeleton, &frames, 0.02);
        assert_smooth(&frames, 0.036);
        let came_back = (hips(&frames[299]) - hips(&before[19])).abs();
        assert!(came_back < 0.01, "{came_back} m lower in the end");
    }
    let mut generator = stander(1);
    let mut pose = Pose::default();
    generator.push(Vec2::new(f32::NAN, 1.0));
    generator.step(DT, &Controls::STAND, &mut pose);
    assert!(pose.root_position.is_finite() && generator.is_standing());
}

/// Displacement of a joint by a push in its direction after each frame, metres: beside the same walker left alone.
fn moved(pushed: &[Frame], alone: &[Frame], joint: Joint, push: Vec2) -> Vec<f32> {
    let direction = Vec3::new(push.x, 0.0, push.y).normalize();
    let place = |frame: &Frame| frame.model.position(joint).dot(direction);
    let pairs = pushed.iter().zip(alone);
    pairs.map(|(a, b)| place(a) - place(b)).collect()
}

/// People who are pushed move before they can step: the trunk ahead of the hips, the hands behind it.
#[test]
fn a_push_moves_the_body_at_once() {
    let skeleton = Skeleton::standard();
    // Least share of the push's velocity that the hips have on average in the first 0.3 s: ankles brake a soft push at once, and the legs of a walker go on.
    for (seed, speed, push, share) in [
        (1, 0.0, Vec2::new(0.0, -0.8), 0.55),
        (2, 0.0, Vec2::new(0.0, 0.8), 0.5),
        (3, 0.0, Vec2::new(0.8, 0.0), 0.7),
        (4, 0.0, Vec2::new(0.0, -0.25), 0.2),
        (5, 1.3, Vec2::new(-0.8, 0.0), 0.15),
        (6, 1.3, Vec2::new(0.0, 0.8), 0.85),
        (7, 1.3, Vec2::new(0.0, -0.8), 0.3),
    ] {
        let [pushed, alone] = [push, Vec2::ZERO].map(|push| {
            let mut generator = generator(Kind::Styled, seed);
            generator.stand();
            run(&mut generator, &skeleton, &walking(speed), 150);
            generator.push(push);
            run(&mut generator, &skeleton, &walking(speed), 30).0
        });
        let way = |joint| moved(&pushed, &alone, joint, push);
        let (hips, head) = (way(Joint::Hips), way(Joint::Head));
        let hands = [Joint::LeftHand, Joint::RightHand].map(way);
        let name = format!("{push} m/s at {speed} m/s");
        let velocity = hips[17] / 0.3;
        assert!(velocity > share * push.length(), "{velocity} m/s: {name}");
        assert!(
            head[8] > 1.4 * hips[8],
            "{} and {} m: {name}",
            head[8],
            hips[8]
        );
        let hands = 0.5 * (hands[0][14] + hands[1][14]);
        assert!(
            hands < 0.75 * head[14],
            "{hands} and {} m: {name}",
            head[14]
        );
    }
}
