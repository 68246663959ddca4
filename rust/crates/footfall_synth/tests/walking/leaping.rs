//! Leaps out of a walk and a run: rise, way, and posture in the air.

use super::jumping::{assert_ballistic, assert_no_pop, hips, rise, stander};
use super::world::{Frame, Kind, assert_planted_within, generator, knee, run, walking};
use footfall_core::{Joint, Side, Skeleton};

#[test]
fn walkers_and_runners_leap() {
    let skeleton = Skeleton::standard();
    for (seed, speed, asked) in [
        (1, 1.2, 0.2),
        (2, 1.4, 0.3),
        (3, 2.8, 0.4),
        (4, 3.4, 0.4),
        (5, 1.0, 0.4),
        (6, 1.0, 0.5),
        (7, 1.2, 0.5),
        (8, 2.4, 0.5),
    ] {
        let mut generator = generator(Kind::Styled, seed);
        let (before, _) = run(&mut generator, &skeleton, &walking(speed), 240);
        assert!(generator.jump(asked));
        let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 150);
        let risen = rise(&before, &frames);
        assert!(
            (risen - asked).abs() < 0.1 * asked + 0.015,
            "{risen} for {asked} m at {speed} m/s"
        );
        let aloft = frames.iter().filter(|f| f.contact == [false; 2]).count();
        assert!(aloft > 15, "{aloft} frames in the air at {speed} m/s");
        assert_planted_within(&skeleton, &frames, 0.06);
        assert_no_pop(&frames);
        let way = (frames.last().unwrap().place - frames[0].place).length() / 2.5;
        assert!(way > 0.75 * speed, "{way} m/s of {speed}");
    }
}

/// The slow step that sets out would become a leap that is longer than the ground has room for.
#[test]
fn who_has_just_set_out_leaps() {
    let skeleton = Skeleton::standard();
    for (seed, asked) in [(0, 0.4), (1, 0.45), (2, 0.4), (3, 0.45)] {
        let mut generator = stander(seed);
        run(&mut generator, &skeleton, &walking(0.9), 30);
        assert!(generator.jump(asked));
        let (frames, _) = run(&mut generator, &skeleton, &walking(0.9), 200);
        assert_ballistic(&frames);
    }
}

/// Index of the frame in which the hips are highest.
fn highest(frames: &[Frame]) -> usize {
    let highest = (0..frames.len()).max_by(|a, b| hips(&frames[*a]).total_cmp(&hips(&frames[*b])));
    highest.expect("there are frames")
}

#[test]
fn runners_land_from_leaps_on_legs_that_hold() {
    let skeleton = Skeleton::standard();
    for (seed, speed, asked, least) in [
        (1, 3.5, 0.4, 0.70),
        (2, 3.5, 0.4, 0.70),
        (3, 2.5, 0.25, 0.73),
        (4, 2.5, 0.25, 0.73),
    ] {
        let mut generator = generator(Kind::Styled, seed);
        run(&mut generator, &skeleton, &walking(speed), 240);
        generator.jump(asked);
        let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 150);
        let landing = &frames[highest(&frames)..];
        let lowest = landing.iter().map(hips).fold(f32::INFINITY, f32::min);
        assert!(
            lowest > least,
            "hips at {lowest} m after {asked} m at {speed} m/s"
        );
        let lowest_at = landing.iter().position(|frame| hips(frame) <= lowest);
        let next = landing[lowest_at.expect("there are frames")..]
            .iter()
            .take(20);
        let risen = next.map(hips).fold(0.0, f32::max);
        assert!(risen > 0.86, "it runs on at {risen} m after {asked} m");
    }
}

/// Height of a wrist over its shoulder, metres.
fn lifted(frame: &Frame, [hand, shoulder]: [Joint; 2]) -> f32 {
    frame.model.position(hand).y - frame.model.position(shoulder).y
}

#[test]
fn a_leap_lifts_a_knee_and_an_arm_and_folds_the_leg_that_took_off() {
    let skeleton = Skeleton::standard();
    for (seed, speed) in [(1, 1.3), (2, 3.0)] {
        let mut generator = generator(Kind::Styled, seed);
        run(&mut generator, &skeleton, &walking(speed), 240);
        generator.jump(0.35);
        let (frames, _) = run(&mut generator, &skeleton, &walking(speed), 150);
        let highest = highest(&frames);
        let takes_off = frames[..highest]
            .iter()
            .rposition(|frame| frame.contact != [false; 2]);
        let takes_off = takes_off.expect("a foot bears before");
        let trails = if frames[takes_off].contact[0] {
            Side::Left
        } else {
            Side::Right
        };
        let [folded, driven] = [trails, trails.other()].map(|side| knee(&frames[highest], side));
        assert!(
            folded > 65.0 && driven > 65.0,
            "{folded}°, {driven}° at {speed} m/s"
        );
        let thigh = frames[highest].model.position(trails.other().lower_leg())
            - frames[highest].model.position(trails.other().upper_leg());
        let flexed = thigh.z.atan2(-thigh.y).to_degrees();
        assert!(flexed > 40.0, "thigh at {flexed}°");
        let arm = match trails {
            Side::Left => [Joint::LeftHand, Joint::LeftUpperArm],
            Side::Right => [Joint::RightHand, Joint::RightUpperArm],
        };
        let raised = lifted(&frames[highest], arm) - lifted(&frames[0], arm);
        assert!(raised > 0.2, "{raised} m");
    }
}
