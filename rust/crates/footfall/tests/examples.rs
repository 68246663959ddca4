//! Outcomes of the examples: distance covered, feet planted, files that read back.

#[expect(dead_code, reason = "the test calls what `main` calls")]
#[path = "../examples/game_loop.rs"]
mod game_loop;
#[expect(dead_code, reason = "the test calls what `main` calls")]
#[path = "../examples/replay_sensor.rs"]
mod replay_sensor;
#[expect(dead_code, reason = "the test calls what `main` calls")]
#[path = "../examples/walk_once.rs"]
mod walk_once;

use footfall::body::{ModelPose, Pose, Side, Skeleton};
use footfall::gait::EventKind;
use footfall::glam::Vec3;
use footfall::ground::Frame;
use footfall::model::GaitModel;
use footfall::sensor::csv;
use footfall_motion::{bvh, retarget};
use std::path::Path;
use std::sync::Arc;

fn model() -> Arc<GaitModel> {
    let bytes = std::fs::read(walk_once::MODEL).expect("the shipped model");
    Arc::new(GaitModel::from_bytes(&bytes).expect("a gait model"))
}

/// Heel, ball and toe tip of both feet over a floor, in the world, metres.
fn soles(skeleton: &Skeleton, world_from_floor: &Frame, pose: &Pose) -> [[Vec3; 3]; 2] {
    let model = ModelPose::of(skeleton, pose);
    Side::BOTH.map(|side| {
        let foot = skeleton.foot(side);
        [
            model.point(side.foot(), foot.heel),
            model.point(side.toes(), foot.ball),
            model.point(side.toes(), foot.toe_tip),
        ]
        .map(|point| world_from_floor.point(point))
    })
}

/// The least that any point of a sole moved between two frames, metres: a foot that rolls keeps one point.
fn least_motion(before: &[Vec3; 3], now: &[Vec3; 3]) -> f32 {
    let moved = before.iter().zip(now).map(|(a, b)| a.distance(*b));
    moved.fold(f32::INFINITY, f32::min)
}

#[test]
fn a_walk_is_as_long_as_asked_with_planted_feet_and_reads_back() {
    let walk = walk_once::walk(&model(), 12).unwrap();
    let clip = &walk.clip;
    let events = walk.events();
    let landings = events
        .iter()
        .filter(|e| e.kind == EventKind::InitialContact);
    assert_eq!(landings.count(), 12);
    let metres = clip.poses.last().unwrap().root_position.z;
    assert!((7.0..8.0).contains(&metres), "12 steps of {metres} m");

    let soles: Vec<_> = clip
        .poses
        .iter()
        .map(|pose| soles(&clip.skeleton, &Frame::IDENTITY, pose))
        .collect();
    for side in [0, 1] {
        for stance in &walk.contacts[side] {
            for frame in stance.first + 1..=stance.last {
                let slip = least_motion(&soles[frame - 1][side], &soles[frame][side]);
                assert!(
                    slip < 2e-5,
                    "foot {side} slips by {slip} m at frame {frame}"
                );
                let lowest = soles[frame][side]
                    .iter()
                    .map(|p| p.y)
                    .fold(f32::INFINITY, f32::min);
                assert!(
                    lowest.abs() < 2e-3,
                    "foot {side} is at {lowest} m at frame {frame}"
                );
            }
        }
    }

    let text = bvh::write(&bvh::clip_to_bvh(clip));
    let file = bvh::parse(&text).unwrap();
    let read = retarget::retarget(&file, &retarget::RetargetOptions::default()).unwrap();
    assert_eq!(read.clip.poses.len(), clip.poses.len());
    for (ours, theirs) in clip.poses.iter().zip(&read.clip.poses) {
        assert!(ours.root_position.distance(theirs.root_position) < 1e-3);
    }
}

#[test]
fn the_game_loop_ends_on_the_kerb_with_feet_that_stay() {
    let model = model();
    let mut before: Option<([bool; 2], [[Vec3; 3]; 2])> = None;
    let mut frames = 0;
    let (mut end, mut last_locked) = (Frame::IDENTITY, [false; 2]);
    let mut last_soles = [[Vec3::ZERO; 3]; 2];
    game_loop::play(&model, |_, place, placer, pose| {
        let locked = placer.feet().map(|foot| foot.locked);
        let now = soles(&model.skeleton, &place, pose);
        if let Some((stood, soles)) = &before {
            for side in 0..2 {
                if stood[side] && locked[side] {
                    let slip = least_motion(&soles[side], &now[side]);
                    assert!(slip < 1e-4, "foot {side} slips by {slip} m at {place:?}");
                }
            }
        }
        assert!(
            locked.contains(&true),
            "somebody who walks has a foot on the ground"
        );
        before = Some((locked, now));
        (end, last_locked, last_soles) = (place, locked, now);
        frames += 1;
    })
    .unwrap();
    assert_eq!(frames, 420);
    assert_eq!(last_locked, [true; 2], "it stands in the end");
    assert!((5.6..6.5).contains(&end.position.z), "{end:?}");
    for point in last_soles.as_flattened() {
        assert!(
            (point.y - game_loop::KERB_M).abs() < 5e-3,
            "a sole at {point}"
        );
    }
}

#[test]
fn a_sensor_on_a_foot_walks_a_body_as_far_as_its_wearer_went() {
    let recording = csv::read(Path::new(replay_sensor::RECORDING)).unwrap();
    let mut body = replay_sensor::body().unwrap();
    let skeleton = model().skeleton.clone();
    let (mut way, mut footfalls) = (Vec3::ZERO, 0);
    let mut before: Option<([bool; 2], [[Vec3; 3]; 2])> = None;
    let (mut heights, mut slips): (Vec<f32>, Vec<f32>) = (vec![], vec![]);
    replay_sensor::replay(&recording, &mut body, |_, body, pose| {
        way = pose.root_position;
        footfalls += body.landings().iter().flatten().count();
        let now = soles(&skeleton, &Frame::IDENTITY, pose);
        let lowest = now.as_flattened().iter().map(|point| point.y);
        heights.push(lowest.fold(f32::INFINITY, f32::min));
        let stands = body.stands();
        if let Some((stood, soles)) = &before {
            for side in 0..2 {
                if stood[side] && stands[side] {
                    slips.push(least_motion(&soles[side], &now[side]));
                }
            }
        }
        before = Some((stands, now));
    });
    // The walk that was measured: `walker_1_slow.bvh`.
    let file = Path::new(replay_sensor::RECORDING).with_file_name("walker_1_slow.bvh");
    let options = retarget::RetargetOptions::default();
    let worn = retarget::retarget(&bvh::read(file).unwrap(), &options)
        .unwrap()
        .clip;
    let poses = [worn.poses.first(), worn.poses.last()].map(|pose| pose.unwrap().root_position);
    let truth = (poses[1] - poses[0]).with_y(0.0).length();
    let share = way.with_y(0.0).length() / truth;
    slips.sort_by(f32::total_cmp);
    // A body of other lengths, known by one sensor: 0.89 of the way, straight ahead, step by step.
    assert!((0.82..0.95).contains(&share), "{way} of {truth} m");
    // Where ahead is follows from its first steps, within twenty degrees.
    assert!(way.x.abs() < 0.36 * way.z, "{way}");
    assert!((10..=12).contains(&footfalls), "{footfalls}");
    // In most frames a standing foot does not move at all; in the first few after its sensor has it land it settles.
    slips.sort_by(f32::total_cmp);
    let [median, seldom] = [slips.len() / 2, slips.len() * 19 / 20].map(|n| slips[n]);
    assert!(median < 1e-4 && seldom < 2.5e-3, "{median} {seldom}");
    let sunk = heights.iter().copied().fold(f32::INFINITY, f32::min);
    let floats = heights.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!(sunk > -0.03 && floats < 0.05, "{sunk} {floats}");
}
