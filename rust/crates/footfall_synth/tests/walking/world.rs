//! Walkers under test, and checks that hold for any walk.

use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_model::{DynamicsModel, GaitModel};
use footfall_synth::{Controls, Footstep, GaitGenerator, GeneratorConfig, StyleSpace, SynthError};
use glam::{Quat, Vec3};
use std::sync::{Arc, OnceLock};

pub(crate) const DT: f32 = 1.0 / 60.0;

pub(crate) fn model() -> Arc<GaitModel> {
    static MODEL: OnceLock<Arc<GaitModel>> = OnceLock::new();
    let load = || {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../../addons/footfall/models/locomotion.footfall"
        );
        Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap())
    };
    Arc::clone(MODEL.get_or_init(load))
}

pub(crate) fn space() -> Arc<StyleSpace> {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    Arc::clone(SPACE.get_or_init(|| Arc::new(StyleSpace::new(&model(), &[]).unwrap())))
}

pub(crate) fn config(seed: u64) -> GeneratorConfig {
    GeneratorConfig {
        seed,
        phase: 0.0,
        variation: 1.0,
    }
}

pub(crate) fn switching_model() -> Arc<DynamicsModel> {
    static MODEL: OnceLock<Arc<DynamicsModel>> = OnceLock::new();
    let load = || {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../../addons/footfall/models/walk.footdyn"
        );
        Arc::new(DynamicsModel::from_bytes(&std::fs::read(path).unwrap()).unwrap())
    };
    Arc::clone(MODEL.get_or_init(load))
}

/// Source of a walker's steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Styled,
    Switching,
}

pub(crate) const KINDS: [Kind; 2] = [Kind::Styled, Kind::Switching];

pub(crate) fn walker(
    kind: Kind,
    skeleton: &Skeleton,
    config: &GeneratorConfig,
) -> Result<GaitGenerator, SynthError> {
    match kind {
        Kind::Styled => GaitGenerator::new(&space(), &[], skeleton, config),
        Kind::Switching => GaitGenerator::switching(&switching_model(), skeleton, config),
    }
}

pub(crate) fn generator(kind: Kind, seed: u64) -> GaitGenerator {
    walker(kind, &Skeleton::standard(), &config(seed)).unwrap()
}

pub(crate) fn walking(speed_mps: f32) -> Controls {
    Controls {
        speed_mps,
        ..Controls::STAND
    }
}

/// A frame in the space where the walk began.
pub(crate) struct Frame {
    pub(crate) model: ModelPose,
    pub(crate) contact: [bool; 2],
    pub(crate) heading: f32,
    pub(crate) place: Vec3,
}

pub(crate) fn run(
    generator: &mut GaitGenerator,
    skeleton: &Skeleton,
    controls: &Controls,
    frames: usize,
) -> (Vec<Frame>, Vec<Footstep>) {
    let mut pose = Pose::default();
    let mut footsteps = Vec::new();
    let frames = (0..frames)
        .map(|_| {
            generator.step(DT, controls, &mut pose);
            footsteps.extend_from_slice(generator.footsteps());
            let place = generator.start_from_character();
            let level = Quat::from_rotation_y(place.heading);
            pose.root_position = place.position + level * pose.root_position;
            pose.rotations[0] = level * pose.rotations[0];
            let mut model = ModelPose::default();
            forward_kinematics(skeleton, &pose, &mut model);
            Frame {
                model,
                contact: generator.feet_in_contact(),
                heading: place.heading,
                place: place.position,
            }
        })
        .collect();
    (frames, footsteps)
}

/// Heel, ball and toe tip of a foot.
pub(crate) fn sole(skeleton: &Skeleton, frame: &Frame, side: Side) -> [Vec3; 3] {
    let foot = skeleton.foot(side);
    [
        frame.model.point(side.foot(), foot.heel),
        frame.model.point(side.toes(), foot.ball),
        frame.model.point(side.toes(), foot.toe_tip),
    ]
}

/// Flexion of a knee, degrees.
pub(crate) fn knee(frame: &Frame, side: Side) -> f32 {
    let [hip, knee, ankle] =
        [side.upper_leg(), side.lower_leg(), side.foot()].map(|joint| frame.model.position(joint));
    (knee - hip).angle_between(ankle - knee).to_degrees()
}

/// Flexion of the knees in the frames in which their feet land, degrees.
pub(crate) fn landing_knees(frames: &[Frame]) -> Vec<f32> {
    let landings = frames.windows(2).flat_map(|pair| {
        let lands = |side: &Side| pair[1].contact[side.index()] && !pair[0].contact[side.index()];
        Side::BOTH
            .into_iter()
            .filter(lands)
            .map(|side| knee(&pair[1], side))
    });
    landings.collect()
}

/// Height of the lowest of these points, metres.
pub(crate) fn lowest(points: &[Vec3]) -> f32 {
    let heights = points.iter().map(|point| point.y);
    heights.fold(f32::INFINITY, f32::min)
}

/// A standing foot keeps one of heel, ball and toe tip where it is; nothing sinks.
pub(crate) fn assert_planted(skeleton: &Skeleton, frames: &[Frame]) {
    assert_planted_within(skeleton, frames, 0.02);
}

/// The same, where the point that moves least does so at this speed at most, m/s: a foot that rolls from the heel to the ball changes over between two frames.
pub(crate) fn assert_planted_within(skeleton: &Skeleton, frames: &[Frame], most: f32) {
    let mut standing = 0;
    for (index, pair) in frames.windows(2).enumerate() {
        for side in Side::BOTH {
            let (then, now) = (
                sole(skeleton, &pair[0], side),
                sole(skeleton, &pair[1], side),
            );
            let lowest = lowest(&now);
            assert!(lowest > -0.002, "sole {lowest} m below the ground");
            if pair[0].contact[side.index()] && pair[1].contact[side.index()] {
                standing += 1;
                let moved = then.iter().zip(&now).map(|(then, now)| then.distance(*now));
                let slip = moved.fold(f32::INFINITY, f32::min) / DT;
                assert!(
                    slip < most,
                    "standing {side:?} foot slips at {slip} m/s in frame {index}: {then:?} {now:?}"
                );
                assert!(lowest < 0.004, "standing foot {lowest} m above the ground");
            }
        }
    }
    assert!(
        standing > frames.len() / 2,
        "feet stood in only {standing} frames"
    );
}

pub(crate) fn assert_continuous(kind: Kind, frames: &[Frame]) {
    // 120 m/s² at 60 fps: an impact of the toes is below it, a pop is not. Two systems straighten a knee harder.
    let most = match kind {
        Kind::Styled => 0.034,
        Kind::Switching => 0.04,
    };
    assert_smooth(frames, most);
}

/// No joint's velocity changes by more than this between two frames, metres a frame.
pub(crate) fn assert_smooth(frames: &[Frame], most: f32) {
    for (index, triple) in frames.windows(3).enumerate() {
        for joint in Joint::ALL {
            let [a, b, c] = [&triple[0], &triple[1], &triple[2]].map(|f| f.model.position(joint));
            let jump = (a - 2.0 * b + c).length();
            assert!(jump < most, "{joint:?} jumps by {jump} m in frame {index}");
        }
    }
}
