//! Rolls of a foot against the ground, a search over all pitches, and the leg solver.

use super::*;
use crate::leg::solve_leg;
use footfall_core::{Joint, Pose, forward_kinematics};

fn plant() -> Plant {
    Plant {
        flat_ankle: Vec3::new(0.2, 0.085, 1.0),
        heading: 0.3,
    }
}

#[test]
fn the_rocker_never_sinks_and_its_pivot_never_moves() {
    let foot = RockerFoot::new(&Skeleton::standard(), Side::Left);
    let mut previous: Option<FootTarget> = None;
    for step in -60..=140 {
        let target = foot.stand(&plant(), step as f32 * 0.01);
        let lowest = foot.lowest_point(&target);
        assert!(lowest.abs() < 1e-5, "sole at {lowest} at step {step}");
        if let Some(previous) = previous {
            let moved = target.ankle.distance(previous.ankle);
            assert!(
                moved < 0.01 * 0.25,
                "the ankle jumps by {moved} at step {step}"
            );
            let joint = |target: &FootTarget| target.ankle + target.foot * foot.toe_joint;
            let points = |target: &FootTarget| {
                let [heel, _, tip] = foot.points(target);
                [heel, joint(target), tip]
            };
            let slip = points(&target)
                .into_iter()
                .zip(points(&previous))
                .map(|(now, then)| now.distance(then))
                .fold(f32::INFINITY, f32::min);
            assert!(
                slip < 1e-5,
                "every pivot moves, by {slip} at least, at step {step}"
            );
        }
        previous = Some(target);
    }
}

/// The closed form against all pitches, tried one by one.
#[test]
fn a_heel_rises_as_far_as_the_leg_needs() {
    let rocker = RockerFoot::new(&Skeleton::standard(), Side::Left);
    let trials = 20_000;
    for (hip, least) in [
        (Vec3::new(0.04, 0.79, 0.27), 0.0),
        (Vec3::new(-0.05, 0.76, 0.4), 0.2),
        (Vec3::new(0.0, 0.83, 0.05), 0.0),
    ] {
        let reach_at = |pitch: f32| rocker.roll(pitch).distance(hip);
        for share in [0.5, 0.97, 0.99, 1.0, 1.1] {
            let reach = share * reach_at(least);
            let found = rocker.pitches_within_reach(
                Vec3x8::splat(hip),
                f32x8::splat(reach),
                f32x8::splat(least),
            );
            let found = found.as_array()[0];
            let pitches = (0..=trials)
                .map(|trial| least + (MAX_TOE_FLEXION - least) * trial as f32 / trials as f32);
            let within = pitches
                .clone()
                .find(|pitch| reach_at(*pitch) <= reach + 1e-6);
            let nearest = || pitches.min_by(|a, b| reach_at(*a).total_cmp(&reach_at(*b)));
            let tried = within.or_else(nearest).unwrap();
            assert!(
                (found - tried).abs() < 2e-3,
                "{hip} {share}: {found}, tried {tried}"
            );
        }
    }
}

#[test]
fn a_plant_is_found_from_the_ankle_above_it() {
    let foot = RockerFoot::new(&Skeleton::standard(), Side::Right);
    for pitch in [-0.4, 0.0, 0.5, 1.2] {
        let ankle = foot.stand(&plant(), pitch).ankle;
        let found = foot.plant_under(ankle, plant().heading, pitch);
        assert!(found.flat_ankle.distance(plant().flat_ankle) < 1e-5);
    }
}

#[test]
fn the_leg_solver_puts_the_sole_on_the_ground() {
    let skeleton = Skeleton::standard();
    let foot = RockerFoot::new(&skeleton, Side::Left);
    let mut pose = Pose::rest(&skeleton);
    pose.root_position = Vec3::new(0.1, 0.93, 1.0);
    pose.rotations[Joint::LeftLowerLeg.index()] = Quat::from_rotation_x(0.4);
    let mut model = footfall_core::ModelPose::default();
    forward_kinematics(&skeleton, &pose, &mut model);
    let target = foot.stand(&plant(), 0.3);
    assert!(solve_leg(&skeleton, Side::Left, &target, &mut pose, &mut model) < 1e-4);
    let tip = model.point(Joint::LeftToes, skeleton.foot(Side::Left).toe_tip);
    assert!(tip.y.abs() < 1e-4, "{tip}");
}

#[test]
fn a_foot_that_swings_past_straight_down_keeps_its_heading() {
    let mut before = None;
    for step in 0..=100 {
        let pitch = 0.02 * step as f32;
        let rolled = Quat::from_rotation_x(pitch) * Quat::from_rotation_z(0.05);
        let (heading, found) = foot_attitude(from_heading(0.4) * rolled);
        assert!((heading - 0.4).abs() < 0.06, "{heading} at {pitch}");
        assert!((found - pitch).abs() < 0.01, "{found} at {pitch}");
        let turned = before.map_or(0.0, |before: f32| (heading - before).abs());
        assert!(turned < 0.002, "turned by {turned} at {pitch}");
        before = Some(heading);
    }
}

#[test]
fn small_pitches_settle_and_large_ones_stay() {
    assert!(settled_pitch(0.03_f32).abs() < 0.004);
    assert!((settled_pitch(-0.5_f32) + 0.5).abs() < 0.02);
    let foot = from_heading(0.4) * Quat::from_rotation_x(0.2);
    assert!((foot_pitch(foot) - 0.2).abs() < 1e-5 && (foot_heading(foot) - 0.4).abs() < 1e-5);
}
