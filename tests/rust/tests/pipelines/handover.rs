//! One motion gives way to another: nothing pops, and feet that stand stay where they are.

use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton};
use footfall_ik::FootTarget;
use footfall_ik::RockerFoot;
use footfall_ik::handover::{Handover, Moving};
use footfall_synth::{Controls, GaitGenerator};
use footfall_tests::walkers;
use glam::{Quat, Vec3};

const DT: f32 = 1.0 / 60.0;
/// A walk that goes on undisturbed accelerates the knee of a leg that is almost straight by 103 m/s² already.
const MOST_ACCELERATION: f32 = 105.0;
/// The same for the hips of a body that gets up.
const MOST_OF_HIPS: f32 = 60.0;
/// A foot that rolls onto its toes and is about to leave is the fastest that stands.
const MOST_SLIP: f32 = 0.12;

fn walker(seed: u64) -> GaitGenerator {
    walkers::generator(&Skeleton::standard(), seed)
}

/// One frame of a walk, in the space where it began.
fn step(walker: &mut GaitGenerator, controls: &Controls) -> (Pose, [bool; 2]) {
    (
        walkers::step_in_world(walker, DT, controls),
        walker.feet_in_contact(),
    )
}

fn joints(pose: &Pose) -> [Vec3; 22] {
    let model = ModelPose::of(&Skeleton::standard(), pose);
    model.positions
}

/// Speed of the slowest point of a sole between two frames, m/s: a rolling foot has one that stands.
fn slip(side: Side, before: &Pose, now: &Pose) -> f32 {
    let skeleton = Skeleton::standard();
    let points = |pose: &Pose| {
        let model = ModelPose::of(&skeleton, pose);
        RockerFoot::new(&skeleton, side).points(&FootTarget {
            ankle: model.position(side.foot()),
            foot: model.rotation(side.foot()),
            toes: model.rotation(side.toes()),
        })
    };
    let speeds = points(before)
        .into_iter()
        .zip(points(now))
        .map(|(before, now)| before.distance(now) / DT);
    speeds.fold(f32::MAX, f32::min)
}

/// Goes over from a motion whose last two frames are given; returns the frames before and after, and how fast feet that were held went.
fn go_over(
    from: [&Pose; 2],
    stood: [bool; 2],
    mut to: impl FnMut() -> (Pose, [bool; 2], bool),
    secs: f32,
    frames: usize,
) -> (Vec<[Vec3; 22]>, f32) {
    let (before, _, _) = to();
    let (now, stands, _) = to();
    let from_motion = Moving {
        before: from[0],
        now: from[1],
        stands: stood,
    };
    let to_motion = Moving {
        before: &before,
        now: &now,
        stands,
    };
    let mut handover = Handover::new(&Skeleton::standard(), &from_motion, &to_motion, DT, secs);
    let mut shown = vec![joints(from[0]), joints(from[1])];
    let held = [0, 1].map(|side| stood[side] && stands[side]);
    let mut still_held = held;
    let mut most_slip = 0.0_f32;
    let mut last = from[1].clone();
    for _ in 0..frames {
        let (mut pose, stands, rests) = to();
        handover.step(DT, stands, rests, &mut pose);
        for side in Side::BOTH {
            let index = side.index();
            still_held[index] &= stands[index] && !rests;
            if still_held[index] {
                most_slip = most_slip.max(slip(side, &last, &pose));
            }
        }
        shown.push(joints(&pose));
        last = pose;
    }
    assert!(handover.is_over(), "it ends");
    (shown, most_slip)
}

/// A body that stands with knees a little bent: those of a straight leg snap whatever moves it.
fn standing() -> Pose {
    const THIGH: f32 = 0.2;
    let skeleton = Skeleton::standard();
    let mut pose = Pose::rest(&skeleton);
    for side in Side::BOTH {
        pose.rotations[side.upper_leg().index()] = Quat::from_rotation_x(-THIGH);
        pose.rotations[side.lower_leg().index()] = Quat::from_rotation_x(2.0 * THIGH);
        pose.rotations[side.foot().index()] = Quat::from_rotation_x(-THIGH);
    }
    pose.root_position.y -= skeleton.leg_length(Side::Left) * (1.0 - THIGH.cos());
    pose
}

fn most_acceleration(shown: &[[Vec3; 22]]) -> (f32, Joint) {
    let mut most = (0.0_f32, Joint::Hips);
    for frames in shown.windows(3) {
        for joint in Joint::ALL {
            let [a, b, c] = [0, 1, 2].map(|frame| frames[frame][joint.index()]);
            let acceleration = (c - 2.0 * b + a).length() / (DT * DT);
            if acceleration > most.0 {
                most = (acceleration, joint);
            }
        }
    }
    most
}

fn walking(speed_mps: f32) -> Controls {
    Controls {
        speed_mps,
        ..Controls::STAND
    }
}

#[test]
fn a_walk_goes_over_into_another_without_a_pop() {
    for begin in [70, 80, 90, 100, 110, 120] {
        let (mut first, mut second) = (walker(1), walker(2));
        let mut last = (Pose::default(), [true; 2]);
        let mut before = last.0.clone();
        for _ in 0..begin {
            before.clone_from(&last.0);
            last = step(&mut first, &walking(1.2));
            step(&mut second, &walking(1.4));
        }
        // The other walk is elsewhere: 12 cm to the side and a little turned.
        let aside = Vec3::new(0.12, 0.0, 0.05) + last.0.root_position;
        let mut from_here = None;
        let to = || {
            let (mut pose, stands) = step(&mut second, &walking(1.4));
            let origin = *from_here.get_or_insert(pose.root_position);
            let turn = Quat::from_rotation_y(0.1);
            let way = (pose.root_position - origin) * Vec3::new(1.0, 0.0, 1.0);
            let height = pose.root_position.y;
            pose.root_position = Vec3::new(aside.x, height, aside.z) + turn * way;
            pose.rotations[0] = turn * pose.rotations[0];
            (pose, stands, false)
        };
        let (shown, slip) = go_over([&before, &last.0], last.1, to, 0.4, 150);
        let (most, joint) = most_acceleration(&shown);
        assert!(
            most < MOST_ACCELERATION,
            "{most} m/s² of {joint:?} from frame {begin}"
        );
        assert!(
            slip < MOST_SLIP,
            "a held foot went at {slip} m/s from frame {begin}"
        );
    }
}

#[test]
fn a_pose_at_rest_is_reached_by_steps_one_foot_at_a_time() {
    let mut walker = walker(3);
    let mut last = (Pose::default(), [true; 2]);
    let mut before = last.0.clone();
    // Until both feet are on the ground, one behind the other.
    for frame in 0..200 {
        before.clone_from(&last.0);
        last = step(&mut walker, &walking(1.3));
        if frame > 100 && last.1 == [true; 2] {
            break;
        }
    }
    assert_eq!(last.1, [true; 2]);
    let mut rest = standing();
    rest.root_position += last.0.root_position * Vec3::new(1.0, 0.0, 1.0);
    let to = || (rest.clone(), [true; 2], true);
    let (shown, _) = go_over([&before, &last.0], last.1, to, 0.3, 90);
    let (most, joint) = most_acceleration(&shown);
    assert!(most < MOST_ACCELERATION, "{most} m/s² of {joint:?}");
    let end = joints(&rest);
    for joint in Joint::ALL {
        let apart = shown[shown.len() - 1][joint.index()].distance(end[joint.index()]);
        assert!(apart < 1e-3, "{joint:?} is {apart} m from the rest pose");
    }
    for frames in shown.windows(2) {
        // A foot that stands may roll about its toes.
        let speed = |side: Side| {
            let joint = |joint: Joint| frames[1][joint.index()].distance(frames[0][joint.index()]);
            joint(side.foot()).min(joint(side.toes())) / DT
        };
        let slower = speed(Side::Left).min(speed(Side::Right));
        assert!(
            slower < 0.35,
            "one foot stands while the other goes: {slower} m/s"
        );
    }
}

#[test]
fn nothing_is_left_of_a_motion_that_is_the_same() {
    let mut walker = walker(4);
    let frames: Vec<(Pose, [bool; 2])> =
        (0..120).map(|_| step(&mut walker, &walking(1.3))).collect();
    let moving = |frame: usize| Moving {
        before: &frames[frame - 1].0,
        now: &frames[frame].0,
        stands: frames[frame].1,
    };
    let mut handover = Handover::new(&Skeleton::standard(), &moving(60), &moving(60), DT, 0.5);
    for (pose, stands) in &frames[61..] {
        let mut shown = pose.clone();
        handover.step(DT, *stands, false, &mut shown);
        for (shown, wanted) in joints(&shown).iter().zip(&joints(pose)) {
            assert!(shown.distance(*wanted) < 1e-4);
        }
    }
}

/// Feet that lie far from the hips on the ground are no reason to pull the hips down to them.
#[test]
fn a_body_that_lies_gets_up_without_its_hips_dropping() {
    let mut lies = standing();
    for (turn, height) in [(-1.5, 0.13), (1.5, 0.13), (-1.3, 0.25)] {
        for begin in (0..40).step_by(4) {
            let mut walk = walker(3);
            for _ in 0..60 + begin {
                lies.root_position = step(&mut walk, &walking(1.3)).0.root_position;
            }
            lies.root_position.y = height;
            lies.rotations[0] = Quat::from_rotation_x(turn);
            let to = || {
                let (pose, stands) = step(&mut walk, &walking(1.3));
                (pose, stands, false)
            };
            let (shown, _) = go_over([&lies, &lies], [true; 2], to, 0.8, 90);
            for frames in shown.windows(3) {
                let [a, b, c] = [0, 1, 2].map(|frame: usize| frames[frame][0]);
                let bend = (a - 2.0 * b + c).length() / (DT * DT);
                assert!(
                    bend < MOST_OF_HIPS,
                    "{bend} m/s² from {turn}, frame {begin}: {a} {b} {c}"
                );
            }
        }
    }
}
