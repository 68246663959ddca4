//! Standing motion in crowds, in loops and on slopes.

use super::{DT, alive, config, standing, walker};
use footfall_core::{Joint, ModelPose, Side, Skeleton};
use footfall_ik::placement::PlacementConfig;
use footfall_synth::{Controls, CrowdPose, CrowdWalker, Detail, LoopedWalk, StyledBody, Workshop};
use footfall_tests::terrain::{PlacedWalker, Relief};

#[test]
fn crowds_stand_alive_in_every_detail() {
    let space = alive();
    let skeleton = Skeleton::standard();
    let styled = StyledBody::new(&space, &[], &skeleton).unwrap();
    let mut workshop = Workshop::new(&styled);
    let walking = Controls {
        speed_mps: 1.2,
        ..Controls::STAND
    };
    for detail in Detail::ALL {
        let [mut walker, mut other] = [1, 2]
            .map(|seed| CrowdWalker::new(&styled, &config(seed), true, &mut workshop).unwrap());
        let (mut pose, mut elsewhere) = (CrowdPose::default(), CrowdPose::default());
        let mut before: Option<CrowdPose> = None;
        let (mut moved, mut apart) = (0.0_f32, 0.0_f32);
        walker.pose(&mut pose);
        let first = pose.clone();
        for n in 0..1500 {
            walker.set_detail(detail);
            let controls = if (900..1000).contains(&n) {
                walking
            } else {
                Controls::STAND
            };
            walker.step(DT, controls, &mut workshop);
            other.step(DT, Controls::STAND, &mut workshop);
            walker.pose(&mut pose);
            other.pose(&mut elsewhere);
            let head = pose.position(Joint::Head);
            if let Some(before) = before.as_ref().filter(|_| n < 900) {
                let fast = head.distance(before.position(Joint::Head)) / DT;
                assert!(fast < 0.4, "{detail:?}, frame {n}: head at {fast} m/s");
                for side in Side::BOTH {
                    let slip = pose
                        .position(side.foot())
                        .distance(first.position(side.foot()));
                    assert!(slip < 0.002, "{detail:?}, frame {n}: foot by {slip} m");
                }
                moved = moved.max(head.distance(first.position(Joint::Head)));
                apart = apart.max(head.distance(elsewhere.position(Joint::Head)));
            }
            if let Some(before) = &before {
                let fast = head.distance(before.position(Joint::Head)) / DT;
                assert!(fast < 1.2, "{detail:?}, frame {n}: head at {fast} m/s");
            }
            before = Some(pose.clone());
        }
        assert!(
            moved > 0.008 && apart > 0.01,
            "{detail:?}: {moved} m, {apart} m"
        );
    }
}

#[test]
fn a_loop_of_standing_closes_on_planted_feet() {
    let space = alive();
    let looped = LoopedWalk::standing(walker(&space, 4), 6.0);
    let bodies: Vec<ModelPose> = looped
        .poses
        .iter()
        .map(|pose| ModelPose::of(&Skeleton::standard(), pose))
        .collect();
    assert_eq!(looped.poses.first(), looped.poses.last());
    assert!((looped.duration_secs() - 6.0).abs() < 0.05);
    let last = bodies.len() - 1;
    for joint in [Joint::Head, Joint::Hips] {
        let velocity = |a: usize, b: usize| {
            (bodies[b].position(joint) - bodies[a].position(joint)) / looped.frame_secs
        };
        let jump = velocity(0, 1).distance(velocity(last - 1, last));
        assert!(jump < 0.02, "{joint:?} jumps by {jump} m/s");
    }
    for body in &bodies {
        for side in Side::BOTH {
            let gone = body
                .position(side.foot())
                .distance(bodies[0].position(side.foot()));
            assert!(gone < 0.003, "{gone}");
        }
    }
}

#[test]
fn feet_stay_on_a_slope() {
    let space = alive();
    let mut slope = Relief::still(|_, z| 0.2 * z);
    let mut walker = PlacedWalker::new(standing(&space, 6), &PlacementConfig::default());
    let mut before: Option<ModelPose> = None;
    for n in 0..900 {
        walker.step(DT, Controls::STAND, &mut slope, true);
        let body = walker.world.clone();
        if let Some(before) = before.filter(|_| n > 120) {
            for side in Side::BOTH {
                let slip = body
                    .position(side.foot())
                    .distance(before.position(side.foot()))
                    / DT;
                assert!(slip < 0.01, "frame {n}: {slip} m/s");
            }
        }
        before = Some(body);
    }
}
