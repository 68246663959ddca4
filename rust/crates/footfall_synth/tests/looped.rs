//! Walks that end as they begin.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::GaitModel;
use footfall_synth::{GaitGenerator, GeneratorConfig, LoopedWalk, StyleSpace};
use glam::Vec3;
use std::sync::Arc;

fn maker() -> impl Fn() -> Option<GaitGenerator> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../addons/footfall/models/locomotion.footfall"
    );
    let model = GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    let space = Arc::new(StyleSpace::new(&Arc::new(model), &[]).unwrap());
    let config = GeneratorConfig {
        seed: 3,
        phase: 0.0,
        variation: 1.0,
    };
    move || GaitGenerator::new(&space, &[], &Skeleton::standard(), &config).ok()
}

fn joints(pose: &Pose) -> [Vec3; 22] {
    let mut model = ModelPose::default();
    forward_kinematics(&Skeleton::standard(), pose, &mut model);
    Joint::ALL.map(|joint| model.position(joint))
}

#[test]
fn loops_close_at_the_speed_that_was_asked_for() {
    for (speed, secs) in [(0.8, 6.0), (1.3, 1.0), (1.6, 3.0)] {
        let walk = LoopedWalk::record(maker(), speed, secs).unwrap();
        assert!(
            (walk.speed_mps / speed - 1.0).abs() < 1e-3,
            "{}",
            walk.speed_mps
        );
        assert!(
            (walk.duration_secs() - secs).abs() < 1.0,
            "{}",
            walk.duration_secs()
        );
        assert!(walk.seam_m < 0.12, "moved by {} m to close", walk.seam_m);
        assert_eq!(walk.poses.first(), walk.poses.last());
        let frames: Vec<_> = walk.poses.iter().map(joints).collect();
        for joint in Joint::ALL {
            let velocity = |joint: Joint, frame: usize| {
                (frames[frame + 1][joint.index()] - frames[frame][joint.index()]) / walk.frame_secs
            };
            let change = |joint: Joint, frame: usize, next: usize| {
                velocity(joint, frame).distance(velocity(joint, next))
            };
            let seam = change(joint, frames.len() - 2, 0);
            // A loop closes where the left foot lands: what a leg does there, the other one does within the loop. A landing stops a knee by
            // up to 1.4 m/s, and a loop of one second has no other.
            let most = [joint, joint.mirrored()]
                .into_iter()
                .flat_map(|joint| (0..frames.len() - 2).map(move |frame| (joint, frame)))
                .map(|(joint, frame)| change(joint, frame, frame + 1))
                .fold(1.4, f32::max);
            assert!(
                seam < most,
                "{joint:?} pops by {seam} m/s where the loop closes, elsewhere by {most} m/s at most"
            );
        }
    }
}

#[test]
fn who_stands_stands_on_the_spot() {
    let still = LoopedWalk::standing(maker()().unwrap(), 2.0);
    assert!(still.speed_mps.abs() < f32::EPSILON);
    assert!(
        still
            .poses
            .iter()
            .all(|pose| pose.root_position.distance(still.poses[0].root_position) < 0.05)
    );
}
