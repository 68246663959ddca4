//! Walkers of a crowd walk as a generator of their seed does, and not in step with each other.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

mod far;

use core::f32::consts::TAU;
use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::GaitModel;
use footfall_synth::{
    Controls, CrowdPose, CrowdWalker, Detail, GaitGenerator, GeneratorConfig, StyleSpace,
    StyledBody, Workshop,
};
use glam::Vec3;
use std::sync::{Arc, OnceLock};

pub(crate) const DT: f32 = 1.0 / 60.0;

pub(crate) fn space() -> &'static Arc<StyleSpace> {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    SPACE.get_or_init(|| {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../../addons/footfall/models/locomotion.footfall"
        );
        let model = GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
        Arc::new(StyleSpace::new(&Arc::new(model), &[]).unwrap())
    })
}

pub(crate) fn styled() -> StyledBody {
    StyledBody::new(space(), &[], &Skeleton::standard()).unwrap()
}

pub(crate) fn config(seed: u64, phase: f32, variation: f32) -> GeneratorConfig {
    GeneratorConfig {
        seed,
        phase,
        variation,
    }
}

/// Walks, stops, stands, turns in place and walks on.
fn asked(frame: usize) -> Controls {
    let (speed_mps, turn_rate_radps) = match frame {
        0..300 => (1.3, 0.0),
        300..600 => (0.9, 0.5),
        600..800 => (0.0, 0.0),
        800..1000 => (0.0, 0.8),
        _ => (1.5, 0.0),
    };
    Controls {
        speed_mps,
        turn_rate_radps,
        ..Controls::STAND
    }
}

#[test]
fn a_walker_of_a_crowd_walks_as_a_generator_does() {
    let skeleton = Skeleton::standard();
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    // Paces are measured on the average walker, so only that one is the same to the millimetre.
    for config in [config(1, 0.0, 0.0), config(2, 0.7, 0.0)] {
        let mut generator = GaitGenerator::new(space(), &[], &skeleton, &config).unwrap();
        let mut walker = CrowdWalker::new(&styled, &config, false, &mut workshop).unwrap();
        let mut stranger =
            CrowdWalker::new(&styled, &self::config(9, 0.3, 1.0), false, &mut workshop).unwrap();
        let mut pose = Pose::default();
        let mut model = ModelPose::default();
        let mut joints = CrowdPose::default();
        let mut controls = asked(0);
        for frame in 0..1300 {
            // A generator replans within a step, a crowd waits for the next one: controls change as a step begins.
            let lands = generator.next_footstep();
            if lands.is_none_or(|(_, secs)| secs < DT) {
                controls = asked(frame);
            }
            generator.step(DT, &controls, &mut pose);
            walker.step(DT, controls, &mut workshop);
            // Somebody else may use the workshop in between.
            stranger.step(DT, controls, &mut workshop);
            walker.pose(&mut joints);
            let (a, b) = (
                generator.start_from_character(),
                walker.start_from_character(),
            );
            assert!(
                a.position.distance(b.position) < 2e-3,
                "frame {frame}: {a:?} {b:?}"
            );
            assert!((a.heading - b.heading).abs() < 2e-3, "frame {frame}");
            assert_eq!(
                generator.footsteps().is_empty(),
                walker.footstep().is_none()
            );
            assert_eq!(generator.is_standing(), walker.is_standing());
            forward_kinematics(&skeleton, &pose, &mut model);
            for joint in Joint::ALL {
                let place = joints.position(joint);
                let off = place.distance(model.position(joint));
                assert!(off < 4e-3, "frame {frame}: {joint:?} is {off} m off");
            }
        }
    }
}

#[test]
fn a_crowd_does_not_march_in_step() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    let count = 200;
    let mut walkers: Vec<CrowdWalker> = (0..count)
        .map(|index| {
            let phase = (index as f32 * 0.618_034).fract();
            CrowdWalker::new(&styled, &config(index, phase, 1.0), false, &mut workshop).unwrap()
        })
        .collect();
    // How much phases agree: the length of their mean as points of a circle. By chance it is 1 / √N, about.
    let chance = 1.0 / (count as f32).sqrt();
    let mut sum = 0.0;
    let frames = 1800;
    for frame in 0..frames {
        let mut mean = [0.0, 0.0];
        for walker in &mut walkers {
            walker.step(DT, asked(0), &mut workshop);
            let (sine, cosine) = (TAU * walker.phase()).sin_cos();
            mean[0] += cosine / count as f32;
            mean[1] += sine / count as f32;
        }
        if frame >= 600 {
            sum += mean[0].hypot(mean[1]) / (frames - 600) as f32;
        }
    }
    assert!(
        sum < 1.5 * chance,
        "phases agree by {sum}, by chance {chance}"
    );
}

#[test]
fn less_detail_stays_on_the_way() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    let mut walkers = Detail::ALL.map(|detail| {
        let mut walker =
            CrowdWalker::new(&styled, &config(4, 0.0, 1.0), false, &mut workshop).unwrap();
        walker.set_detail(detail);
        walker
    });
    for _ in 0..1200 {
        for walker in &mut walkers {
            walker.step(DT, asked(0), &mut workshop);
        }
    }
    let [full, half, quarter] = walkers.map(|walker| walker.start_from_character().position);
    assert!(full.length() > 20.0);
    assert!(full.distance(half) < 0.05 * full.length());
    assert!(full.distance(quarter) < 0.05 * full.length());
}

#[test]
fn repeated_steps_go_on_where_the_last_one_ended_and_so_do_new_ones() {
    let styled = styled();
    let mut workshop = Workshop::new(&styled);
    let config = config(6, 0.0, 1.0);
    let mut walker = CrowdWalker::new(&styled, &config, false, &mut workshop).unwrap();
    let mut joints = CrowdPose::default();
    let mut before: Option<(Vec3, f32, [Vec3; 2])> = None;
    let mut landings = 0;
    for frame in 0..1800 {
        // Far for a while, near for a while.
        walker.set_repeating(frame / 200 % 2 == 1);
        let controls = Controls {
            speed_mps: 1.25,
            turn_rate_radps: if frame < 900 { 0.0 } else { 0.3 },
            ..Controls::STAND
        };
        walker.step(DT, controls, &mut workshop);
        walker.pose(&mut joints);
        let place = walker.start_from_character();
        let turn = footfall_core::rotation::from_heading(place.heading);
        let feet = [Joint::LeftFoot, Joint::RightFoot]
            .map(|joint| place.position + turn * joints.position(joint));
        if let Some(footstep) = walker.footstep() {
            landings += 1;
            let ankle = feet[footstep.side.index()];
            let apart = (ankle - footstep.position).with_y(0.0).length();
            assert!(
                apart < 0.1,
                "frame {frame}: a foot lands {apart} m from where it is said to"
            );
        }
        if let Some((position, heading, feet_before)) = before {
            let speed = place.position.distance(position) / DT;
            assert!((0.6..2.2).contains(&speed), "frame {frame}: {speed} m/s");
            let turned = footfall_core::rotation::wrap_angle(place.heading - heading);
            assert!(turned.abs() < 0.05, "frame {frame}: turned by {turned}");
            for (now, then) in feet.iter().zip(feet_before) {
                assert!(
                    now.distance(then) < 0.1,
                    "frame {frame}: a foot jumps by {}",
                    now.distance(then)
                );
            }
        }
        before = Some((place.position, place.heading, feet));
    }
    assert!(walker.start_from_character().position.length() > 10.0);
    // About two steps a second, near or far.
    assert!((45..70).contains(&landings), "{landings} landings");
}
