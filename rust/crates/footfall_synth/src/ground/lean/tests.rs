//! Tests of leaning bodies.

use super::*;
use crate::ground::generated::Stride;
use footfall_core::Skeleton;
use footfall_core::lanes::f32x8;

/// Two generated frames of the T-pose.
fn upright(skeleton: &Skeleton) -> [GeneratedFrame; 2] {
    let poses = [PlantedFrame::default(), PlantedFrame::default()];
    let mut frames = [GeneratedFrame::default(), GeneratedFrame::default()];
    let stride = Stride {
        scale: f32x8::ONE,
        upright: f32x8::ONE,
    };
    GeneratedFrame::fill(&mut frames, &poses, skeleton, |_| stride);
    frames
}

fn lengths(skeleton: &Skeleton) -> [f32; 2] {
    Side::BOTH.map(|side| skeleton.leg_length(side))
}

#[test]
fn a_lean_goes_on_from_step_to_step() {
    let into_turn = Pull {
        within: Vec2::new(0.0, 3.0),
        after: Vec2::new(2.5, 0.0),
        ..Pull::default()
    };
    let begin = Lean {
        angle: Vec2::new(0.05, -0.02),
        rate: Vec2::new(0.3, 0.1),
        leg: 0.0,
    };
    let bend = Bend::new(begin, &into_turn, 0.5);
    assert!(bend.at(0.0).angle.distance(begin.angle) < 1e-6);
    assert!(bend.at(0.0).rate.distance(begin.rate) < 1e-5);
    assert!(bend.at(1.0).rate.length() < 1e-4);
    // The angle of balance's tangent is 2.5 over 9.81.
    assert!((bend.at(1.0).angle.x - 0.72 * 0.2495).abs() < 0.002);
    for s in [0.2, 0.5, 0.8] {
        let step = 1e-3;
        let slope = (bend.at(s + step).angle - bend.at(s - step).angle) / (2.0 * step * 0.5);
        assert!(slope.distance(bend.at(s).rate) < 0.01, "at {s}");
    }
}

#[test]
fn hips_sink_in_turns() {
    let depth = |mps2: f32| {
        let pull = Pull {
            within: Vec2::ZERO,
            after: Vec2::new(mps2, 0.0),
            ..Pull::default()
        };
        let bend = Bend::new(Lean::default(), &pull, 0.8);
        bend.at(1.0).depth()
    };
    assert!(depth(1.5) == 0.0 && depth(2.5) < 0.008, "{}", depth(2.5));
    assert!((depth(4.0) - 0.029).abs() < 0.003, "{}", depth(4.0));
    assert!((depth(-3.0) - depth(3.0)).abs() < 1e-6);
}

#[test]
fn feet_land_ahead_of_who_brakes_and_hips_come_over_them_at_rest() {
    let skeleton = Skeleton::standard();
    let upright = upright(&skeleton);
    // Distances by which the standing and the landing foot are farther ahead, as a step begins and ends.
    let step = |begin: Lean, mps2: f32, rests: bool| {
        let pull = Pull {
            within: Vec2::ZERO,
            after: Vec2::new(0.0, mps2),
            rests: [false, rests],
        };
        let bend = Bend::new(begin, &pull, 0.8);
        let mut frames = upright.clone();
        bend.lean_over(&mut frames, Side::Left, lengths(&skeleton));
        let ahead = [0, 1].map(|frame: usize| {
            Side::BOTH.map(|side| {
                let [leg, before] = [&frames, &upright].map(|of| of[frame].legs[side.index()]);
                (leg.ankle.z - leg.hip.z) - (before.ankle.z - before.hip.z)
            })
        });
        (ahead, bend.next())
    };
    let ([begins, ends], braking) = step(Lean::default(), -2.0, false);
    assert!(begins[0].abs().max(begins[1].abs()).max(ends[0].abs()) < 0.01);
    assert!((0.1..0.35).contains(&ends[1]), "{ends:?} m");
    let ([begins, ends], rest) = step(braking, 0.0, true);
    assert!((begins[0] - 0.87 * braking.leg.sin().abs()).abs() < 0.05);
    assert!(ends[0].abs().max(ends[1].abs()) < 0.01, "{ends:?} m");
    assert!(rest.leg.abs() < 1e-6);
    let (_, gaining) = step(Lean::default(), 2.0, false);
    assert!(gaining.leg > 0.1 && braking.leg < -gaining.leg);
    let ([begins, ends], _) = step(gaining, 2.0, false);
    // While it stands a leg leans as it landed.
    assert!(begins[0] < -0.05 && (begins[0] - ends[0]).abs() < 0.02);
}

#[test]
fn bodies_lean_over_their_feet() {
    let skeleton = Skeleton::standard();
    let lean_over = |x: f32, y: f32, frames: &mut [GeneratedFrame]| {
        let begin = Lean {
            angle: Vec2::new(x, y),
            ..Lean::default()
        };
        let bend = Bend::new(begin, &Pull::default(), 0.5);
        bend.lean_over(frames, Side::Left, lengths(&skeleton));
    };
    let upright = upright(&skeleton);
    let mut frames = upright.clone();
    lean_over(0.2, 0.0, &mut frames);
    let up = frames[0].hips * Vec3::Y;
    assert!((up.x - 0.2_f32.sin()).abs() < 1e-4 && up.z.abs() < 1e-6);
    for side in Side::BOTH {
        let [before, after] = [&upright, &frames].map(|frames| frames[0].legs[side.index()]);
        let [reached, reaches] = [before, after].map(|leg| leg.ankle - leg.hip);
        assert!((reached.length() - reaches.length()).abs() < 1e-5);
        let aside = LEGS * 0.2;
        assert!((reached.angle_between(reaches) - aside).abs() < 0.01 && reaches.x < reached.x);
        assert_eq!(before.foot, after.foot);
    }
    let mut bowed = upright.clone();
    lean_over(0.0, 0.2, &mut bowed);
    let up = bowed[0].hips * Vec3::Y;
    assert!(up.x.abs() < 1e-6 && (up.z - 0.2_f32.sin()).abs() < 1e-4);
    for side in Side::BOTH {
        let ankle = |frames: &[GeneratedFrame]| frames[0].legs[side.index()].ankle;
        assert!(ankle(&upright).distance(ankle(&bowed)) < 1e-6);
    }
}

#[test]
fn heads_are_raised_whatever_way_they_face() {
    for heading in [0.0, 2.0] {
        let facing = Quat::from_rotation_y(heading);
        let mut frame = PlantedFrame {
            level: facing,
            ..PlantedFrame::default()
        };
        let bowed = Quat::from_rotation_x(0.2);
        frame.pose.rotations[Joint::Hips.index()] = facing * bowed;
        raise_head(&mut frame, 0.2);
        let up = bowed * (frame.pose.rotation(Joint::Neck) * Vec3::Y);
        assert!(up.x.abs() < 1e-4 && (up.z - 0.1).abs() < 0.01, "{up}");
    }
}
