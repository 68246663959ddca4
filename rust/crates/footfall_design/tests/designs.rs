//! Each edit does what it says, on a walker whose steps are known.

#![allow(
    clippy::allow_attributes,
    clippy::unwrap_used,
    reason = "helpers of tests"
)]

#[path = "../../footfall_motion/tests/motion/common/walker.rs"]
#[allow(dead_code, reason = "shared with the tests of footfall_motion")]
mod walker;

use footfall_core::{Clip, Joint, ModelPose, Side};
use footfall_design::{DesignError, StyleSheet, design, shipped};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::steps::{Step, segment_walks};
use glam::Vec3;
use walker::{SPEED, STRIDE_SECS, walker};

const RATE_HZ: f64 = 120.0;

fn styled(text: &str) -> Clip {
    styled_with(text, 1)
}

fn styled_with(text: &str, seed: u64) -> Clip {
    styled_clip(&walker(RATE_HZ, 960), text, seed)
}

fn styled_clip(clip: &Clip, text: &str, seed: u64) -> Clip {
    let contacts = detect_contacts(clip, &ContactConfig::from_frame(0));
    let walks = segment_walks(clip, &contacts);
    let sheet = StyleSheet::parse(text).unwrap();
    design(clip, &contacts, &walks, &sheet, seed).unwrap()
}

fn models(clip: &Clip) -> Vec<ModelPose> {
    let solve = |pose| ModelPose::of(&clip.skeleton, pose);
    clip.poses.iter().map(solve).collect()
}

fn steps(clip: &Clip) -> Vec<Step> {
    let contacts = detect_contacts(clip, &ContactConfig::from_frame(0));
    let walks = segment_walks(clip, &contacts);
    walks.into_iter().flat_map(|walk| walk.steps).collect()
}

/// Mean over the inner frames of a clip.
fn mean(clip: &Clip, value: impl Fn(&ModelPose) -> f32) -> f32 {
    let models = models(clip);
    let inner = &models[60..models.len() - 60];
    inner.iter().map(&value).sum::<f32>() / inner.len() as f32
}

fn spread(clip: &Clip, value: impl Fn(&ModelPose) -> f32) -> f32 {
    let models = models(clip);
    let values = models[60..models.len() - 60].iter().map(&value);
    let (low, high) = values.fold((f32::MAX, f32::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    high - low
}

/// Degrees by which a joint's forward axis points below the horizon.
fn pitch_of(model: &ModelPose, joint: Joint) -> f32 {
    -(model.rotation(joint) * Vec3::Z).y.asin().to_degrees()
}

fn elbow(model: &ModelPose) -> f32 {
    let upper = model.position(Joint::LeftLowerArm) - model.position(Joint::LeftUpperArm);
    let lower = model.position(Joint::LeftHand) - model.position(Joint::LeftLowerArm);
    upper.angle_between(lower).to_degrees()
}

/// Distance of the left elbow ahead of its shoulder.
fn elbow_ahead(model: &ModelPose) -> f32 {
    model.position(Joint::LeftLowerArm).z - model.position(Joint::LeftUpperArm).z
}

/// Sets off every stage without asking for anything that could be seen.
const ALMOST_NOTHING: &str = "[head]\nturn = 0.001\n";

#[test]
fn a_neutral_sheet_gives_the_clip_back() {
    let clip = walker(RATE_HZ, 960);
    assert_eq!(styled("name = \"nothing\"\n").poses, clip.poses);
    assert_eq!(styled(shipped::text("template").unwrap()).poses, clip.poses);
}

#[test]
fn almost_nothing_changes_almost_nothing() {
    let clip = walker(RATE_HZ, 960);
    let new = styled(ALMOST_NOTHING);
    for (pose, model) in new.poses.iter().zip(models(&new)) {
        let source = clip
            .pose_at(f64::from(pose.root_position.z / SPEED))
            .unwrap();
        let then = ModelPose::of(&clip.skeleton, &source);
        for joint in Joint::ALL {
            let moved = model.position(joint).distance(then.position(joint));
            let is_leg = joint >= Joint::LeftUpperLeg;
            assert!(
                moved < if is_leg { 0.02 } else { 2e-3 },
                "{joint:?} is off by {moved}"
            );
        }
    }
}

#[test]
fn legs_stay_as_long_where_soles_float() {
    let captured = walker(RATE_HZ, 960);
    let mut floating = captured.clone();
    for pose in &mut floating.poses {
        pose.root_position.y += 0.02;
    }
    let leg = |model: &ModelPose| {
        let legs = Side::BOTH.map(|side| {
            model
                .position(side.upper_leg())
                .distance(model.position(side.foot()))
        });
        legs[0].max(legs[1])
    };
    let expected = mean(&captured, leg);
    let new = mean(&styled_clip(&floating, ALMOST_NOTHING, 1), leg);
    assert!((new - expected).abs() < 3e-3, "{new} m for {expected} m");
}

#[test]
fn stride_and_cadence_make_the_speed() {
    for (stride, cadence) in [(80.0, 100.0), (100.0, 75.0), (70.0, 130.0)] {
        let clip = styled(&format!("[walk]\nstride = {stride}\ncadence = {cadence}\n"));
        let steps = steps(&clip);
        let secs = steps.iter().map(Step::frames).sum::<usize>() as f32 / RATE_HZ as f32;
        let step_secs = secs / steps.len() as f32;
        let wanted = 0.5 * STRIDE_SECS * 100.0 / cadence;
        assert!(
            (step_secs / wanted - 1.0).abs() < 0.03,
            "{step_secs} for {wanted}"
        );
        let way = clip.poses[clip.poses.len() - 1].root_position - clip.poses[0].root_position;
        let speed = way.z / clip.duration_secs() as f32;
        let wanted = SPEED * stride * cadence / 1e4;
        assert!((speed / wanted - 1.0).abs() < 0.02, "{speed} for {wanted}");
    }
}

/// Sheet, what to measure, by how much it is to change on average, and how exactly.
type Case<'a> = (&'a str, &'a dyn Fn(&ModelPose) -> f32, f32, f32);

#[test]
fn edits_do_what_they_say() {
    let plain = styled(ALMOST_NOTHING);
    let difference = |text: &str, value: &dyn Fn(&ModelPose) -> f32| {
        mean(&styled(text), value) - mean(&plain, value)
    };
    let width =
        |model: &ModelPose| model.position(Joint::LeftFoot).x - model.position(Joint::RightFoot).x;
    let cases: [Case<'_>; 9] = [
        ("[walk]\nwidth = 10\n", &width, 0.1, 0.01),
        (
            "[head]\npitch = 20\n",
            &|m| pitch_of(m, Joint::Head),
            20.0,
            1.0,
        ),
        (
            "[trunk]\nlean = 20\nslump = 15\n",
            &|m| pitch_of(m, Joint::UpperChest),
            35.0,
            2.0,
        ),
        (
            "[trunk]\nlean = 20\nslump = 15\n",
            &|m| pitch_of(m, Joint::Head),
            0.0,
            2.0,
        ),
        (
            "[pelvis]\ntilt = 10\n",
            &|m| pitch_of(m, Joint::Hips),
            10.0,
            0.5,
        ),
        (
            "[pelvis]\ntilt = 10\n",
            &|m| pitch_of(m, Joint::Spine),
            0.0,
            0.5,
        ),
        (
            "[pelvis]\nheight = -5\n",
            &|m| m.position(Joint::Hips).y,
            -0.05,
            0.003,
        ),
        ("[arms]\nelbow = 30\n", &elbow, 30.0, 1.0),
        (
            "[arms]\nforward = 30\n",
            &|m| m.position(Joint::LeftLowerArm).z - m.position(Joint::LeftUpperArm).z,
            0.14,
            0.03,
        ),
    ];
    for (text, value, wanted, within) in cases {
        let found = difference(text, value);
        assert!(
            (found - wanted).abs() < within,
            "{text}: {found} for {wanted}"
        );
    }
    let raised = |m: &ModelPose| m.position(Joint::RightUpperArm).y - m.position(Joint::Neck).y;
    assert!(difference("[shoulders]\nraise = 15\n", &raised) > 0.02);
    let out = |m: &ModelPose| m.position(Joint::LeftUpperArm).x - m.position(Joint::LeftLowerArm).x;
    assert!(difference("[arms]\nout = 20\n", &out) < -0.05);
    let inward =
        |m: &ModelPose| m.position(Joint::RightHand).x - m.position(Joint::RightLowerArm).x;
    assert!(difference("[arms]\nelbow = 40\nturn_in = 40\n", &inward) > 0.05);
}

#[test]
fn amplitudes_scale_what_is_there() {
    let plain = styled(ALMOST_NOTHING);
    let half = styled("[arms]\nswing = 50\n");
    let ratio = spread(&half, elbow_ahead) / spread(&plain, elbow_ahead);
    assert!((ratio - 0.5).abs() < 0.1, "{ratio}");
    let sway = styled("[pelvis]\nsway_more = 3\n");
    let x = |model: &ModelPose| model.position(Joint::Hips).x;
    let more = spread(&sway, x) - spread(&plain, x);
    assert!((more - 0.06).abs() < 0.006, "{more}");
    let still = styled("[trunk]\namplitude = 0\n");
    let turn = |model: &ModelPose| (model.rotation(Joint::Chest) * Vec3::Z).x;
    assert!(spread(&still, turn) < 0.2 * spread(&plain, turn));
}

#[test]
fn a_lifted_foot_rises_and_a_toe_landing_is_one() {
    let y = |model: &ModelPose| model.position(Joint::LeftFoot).y;
    let more = spread(&styled("[feet]\nlift = 8\n"), y) - spread(&styled(ALMOST_NOTHING), y);
    assert!((more - 0.08).abs() < 0.02, "{more}");
    let clip = styled("[feet]\nlanding = -25\n");
    let models = models(&clip);
    let steps = steps(&clip);
    assert!(steps.len() > 4);
    for step in &steps[1..steps.len() - 1] {
        let pitch = pitch_of(&models[step.first], step.side.foot());
        assert!(pitch > 8.0, "lands at {pitch}");
    }
    let raised = styled("[feet]\nheel_raise = 25\n");
    let pitch = mean(&raised, |model| pitch_of(model, Joint::RightFoot));
    assert!(pitch > 18.0, "{pitch}");
}

#[test]
fn a_limp_is_uneven() {
    let clip = styled("[left]\nstep_length = 70\nstep_time = 80\n");
    let models = models(&clip);
    let (mut lengths, mut times) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    let all = steps(&clip);
    for step in &all[1..all.len() - 1] {
        let other = step.side.other();
        let ahead = models[step.end + 6].position(other.foot()).z
            - models[step.end + 6].position(step.side.foot()).z;
        lengths[other.index()].push(ahead);
        times[step.side.index()].push(step.frames() as f32);
    }
    let mean = |values: &Vec<f32>| values.iter().sum::<f32>() / values.len() as f32;
    let length = mean(&lengths[0]) / mean(&lengths[1]);
    assert!(
        (length - 0.7).abs() < 0.1,
        "left steps are {length} of right ones"
    );
    let time = mean(&times[0]) / mean(&times[1]);
    assert!(
        (time - 0.8).abs() < 0.06,
        "left stances are {time} of right ones"
    );
}

#[test]
fn chance_repeats_with_its_seed_only() {
    let drunk = shipped::text("drunk").unwrap();
    assert_eq!(styled_with(drunk, 5).poses, styled_with(drunk, 5).poses);
    assert_ne!(styled_with(drunk, 5).poses, styled_with(drunk, 6).poses);
    let times: Vec<usize> = steps(&styled_with(drunk, 5))
        .iter()
        .map(Step::frames)
        .collect();
    let spread = times.iter().max().unwrap() - times.iter().min().unwrap();
    assert!(spread > 8, "steps of {times:?} frames");
}

#[test]
fn curves_follow_the_cycle_on_both_sides() {
    let text = "[[curve]]\njoint = \"UpperArm\"\naxis = \"roll\"\npoints = [[0, 20], [50, -20]]\n";
    let clip = styled(text);
    let plain = styled(ALMOST_NOTHING);
    let models = (models(&clip), models(&plain));
    for step in steps(&plain).iter().skip(1) {
        // A foot that has just landed: its own arm is out, the other one in.
        for (arm, sign) in [(Joint::LeftLowerArm, 1.0), (Joint::RightLowerArm, -1.0)] {
            let shoulder = arm.parent().unwrap();
            let at = |model: &ModelPose| (model.position(arm) - model.position(shoulder)).x * sign;
            let out = at(&models.0[step.first]) - at(&models.1[step.first]);
            let is_own = (step.side == Side::Left) == (arm == Joint::LeftLowerArm);
            assert!(
                if is_own { out > 0.04 } else { out < -0.04 },
                "{arm:?} {out}"
            );
        }
    }
}

#[test]
fn every_style_keeps_feet_planted_knees_human_and_motion_smooth() {
    for (name, text) in shipped::SHEETS {
        let clip = styled_with(text, 3);
        let models = models(&clip);
        for pair in models.windows(3) {
            for joint in Joint::ALL {
                let [a, b, c] = [0, 1, 2].map(|n| pair[n].position(joint));
                let jump = (a - 2.0 * b + c).length();
                // The walker itself starts and stops its feet within a frame, at 2 m/s and more.
                let is_leg = joint >= Joint::LeftUpperLeg;
                assert!(
                    jump < if is_leg { 0.045 } else { 0.006 },
                    "{name}: {joint:?} pops by {jump}"
                );
            }
        }
        for (pose, model) in clip.poses.iter().zip(&models) {
            let hips = pose.root_position.y;
            assert!((0.78..0.94).contains(&hips), "{name}: hips at {hips}");
            for side in Side::BOTH {
                let foot = clip.skeleton.foot(side);
                for point in [
                    model.point(side.foot(), foot.heel),
                    model.point(side.toes(), foot.toe_tip),
                ] {
                    assert!(point.y > -0.005, "{name}: the sole is at {}", point.y);
                }
                let shin = model.position(side.foot()) - model.position(side.lower_leg());
                let shin = model.rotation(side.upper_leg()).inverse() * shin;
                assert!(shin.z < 5e-3, "{name}: a knee bends forwards");
                let bend = shin.angle_between(Vec3::NEG_Y).to_degrees();
                assert!(bend < 110.0, "{name}: a knee bends by {bend}");
            }
        }
    }
}

#[test]
fn standing_and_single_steps_are_refused() {
    let mut clip = walker(RATE_HZ, 120);
    clip.poses.truncate(40);
    let contacts = detect_contacts(&clip, &ContactConfig::from_frame(0));
    let walks = segment_walks(&clip, &contacts);
    let sheet = StyleSheet::parse(shipped::text("sad").unwrap()).unwrap();
    let error = design(&clip, &contacts, &walks, &sheet, 1).unwrap_err();
    assert!(matches!(error, DesignError::TooFewSteps { .. }), "{error}");
}
