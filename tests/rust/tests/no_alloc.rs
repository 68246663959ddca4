//! Absence of allocation in everything that runs in every frame, whatever it is asked to do.
#![expect(unsafe_code, reason = "counting allocations takes an allocator")]

use footfall_core::{Pose, Skeleton};
use footfall_ik::handover::{Handover, Moving};
use footfall_ik::placement::PlacementConfig;
use footfall_imu::ImuSample;
use footfall_model::{DynamicsModel, GaitModel, ImuModel};
use footfall_recon::{Prepared, ReconConfig, Reconstructor};
use footfall_synth::replica::{Followed, WalkFollower, WalkSender};
use footfall_synth::{
    Controls, CrowdWalker, Detail, GaitGenerator, GeneratorConfig, GroundTransform, StyleSpace,
    StyledBody, Workshop,
};
use footfall_tests::data::repository;
use footfall_tests::terrain::{PlacedWalker, Relief};
use glam::Vec3;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

const CONFIG: GeneratorConfig = GeneratorConfig {
    seed: 3,
    phase: 0.3,
    variation: 1.0,
};

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

fn count() {
    // Gone while a thread ends; nothing is counted then.
    let _counted = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
}

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps `alloc`'s contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps `dealloc`'s contract.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller keeps `realloc`'s contract.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn allocations() -> usize {
    ALLOCATIONS.with(Cell::get)
}

/// A body that a sensor drives: samples in time, late, missing and not finite, then silence.
fn assert_driving_allocates_nothing(mut body: Reconstructor) {
    let mut pose = Pose::default();
    let mut reported = 0;
    let before = allocations();
    for n in 0..2000_u32 {
        let time = f64::from(n) * 0.01;
        let phase = time as f32 * 6.0;
        let sample = ImuSample {
            time_secs: if n % 97 == 0 { time - 0.5 } else { time },
            force: Vec3::new(0.0, 9.8 + phase.sin(), 2.0 * phase.cos()),
            rate: Vec3::new(
                if n % 89 == 0 {
                    f32::NAN
                } else {
                    4.0 * phase.sin()
                },
                0.1,
                0.0,
            ),
        };
        if n % 300 < 200 {
            body.push(0, sample);
        }
        body.step(0.01, &mut pose);
        reported += u32::from(body.problem(0).is_some());
        assert!(
            pose.rotations.iter().all(|turn| turn.is_finite()),
            "at {time} s"
        );
    }
    assert_eq!(allocations(), before, "a driven body allocates");
    assert!(reported > 100, "an axis with a constant value is reported");
}

/// Faster and slower, left and right, small and large steps in time, and nonsense.
fn assert_no_allocation(mut generator: GaitGenerator, seed: u64) {
    let mut pose = Pose::default();
    for frame in 0..3000_u16 {
        let wave = (f32::from(frame) * 0.01).sin();
        let controls = Controls {
            speed_mps: if frame == 2000 {
                f32::NAN
            } else {
                1.2 + 1.5 * wave
            },
            turn_rate_radps: 2.0 * wave,
            direction_rad: 4.0 * wave,
            gait: footfall_synth::GaitChoice::Auto,
            crouch: wave.max(0.0),
        };
        if frame % 150 == 0 {
            generator.jump(0.3);
        }
        let dt_secs = if frame % 1000 == 999 { 3.0 } else { 1.0 / 60.0 };
        let before = allocations();
        generator.step(dt_secs, &controls, &mut pose);
        assert_eq!(allocations() - before, 0, "seed {seed}, frame {frame}");
        assert!(generator.footsteps().len() <= 64);
    }
    assert!(pose.root_position.is_finite());
}

/// Feet on stairs, with known footholds and without.
fn assert_placing_allocates_nothing(generator: GaitGenerator) {
    let mut terrain = Relief::still(|_, z| (z / 0.4).floor().clamp(0.0, 20.0) * 0.15);
    let mut walker = PlacedWalker::new(generator, &PlacementConfig::default());
    let controls = Controls {
        speed_mps: 0.9,
        ..Controls::STAND
    };
    for frame in 0..900 {
        let before = allocations();
        walker.step(1.0 / 60.0, controls, &mut terrain, frame < 450);
        assert_eq!(allocations() - before, 0, "placing, frame {frame}");
    }
}

/// A walk that goes over into its rest pose, with steps of its own.
fn assert_going_over_allocates_nothing(mut generator: GaitGenerator, skeleton: &Skeleton) {
    const DT_SECS: f32 = 1.0 / 60.0;
    let controls = Controls {
        speed_mps: 1.3,
        ..Controls::STAND
    };
    let (mut before, mut now) = (Pose::default(), Pose::default());
    for frame in 0..120 {
        core::mem::swap(&mut before, &mut now);
        generator.step(DT_SECS, &controls, &mut now);
        let rest = Pose::rest(skeleton);
        let allocated = allocations();
        let from = Moving {
            before: &before,
            now: &now,
            stands: generator.feet_in_contact(),
        };
        let to = Moving {
            before: &rest,
            now: &rest,
            stands: [true; 2],
        };
        let mut handover = Handover::new(skeleton, &from, &to, DT_SECS, 0.3);
        for _ in 0..90 {
            let mut pose = rest.clone();
            handover.step(DT_SECS, [true; 2], true, &mut pose);
        }
        assert_eq!(allocations() - allocated, 0, "going over, frame {frame}");
        assert!(handover.is_over());
    }
}

/// A walker that follows another: joined late, led back to its place, teleported, and sent nonsense.
#[expect(clippy::unwrap_used, reason = "tests may fail")]
fn assert_following_allocates_nothing(mut walker: GaitGenerator, mut other: GaitGenerator) {
    const DT_SECS: f32 = 1.0 / 60.0;
    let mut sender = WalkSender::new();
    let identity = sender.identity(&walker).unwrap();
    let mut follower = WalkFollower::new(&identity);
    let (mut pose, mut shown) = (Pose::default(), Pose::default());
    let (mut start, mut other_start) = (GroundTransform::default(), GroundTransform::default());
    for frame in 0..3000_u16 {
        let wave = (f32::from(frame) * 0.02).sin();
        let controls = Controls {
            speed_mps: (1.2 + 1.9 * wave).max(0.0),
            turn_rate_radps: wave,
            ..Controls::STAND
        };
        if frame % 400 == 399 {
            start.position.x += 0.4;
        }
        if frame == 2000 {
            start.position.x += 2.0;
        }
        let before = allocations();
        walker.step(DT_SECS, &controls, &mut pose);
        sender.step(DT_SECS);
        if frame % 3 == 0 && frame > 300 {
            let update = sender.update(&walker, &start).unwrap();
            follower.hear(&update, &other).ok();
            follower.hear(&update[..9], &other).unwrap_err();
        }
        let followed = follower.step(DT_SECS, &mut other, &other_start, &mut shown);
        if let Followed::Anew(anew) = followed {
            other_start = anew;
        }
        assert_eq!(allocations() - before, 0, "following, frame {frame}");
    }
    assert!(shown.root_position.is_finite() && !other.is_standing());
}

/// A walker of a crowd allocates only for a step that is longer than any before and for its first rest: slow ones in full detail come first.
fn assert_crowds_allocate_nothing(mut walker: CrowdWalker, workshop: &mut Workshop) {
    for frame in 0..3000 {
        walker.set_repeating(frame % 1000 > 700);
        if frame > 600 {
            walker.set_detail(Detail::Quarter);
        }
        let controls = Controls {
            speed_mps: match frame {
                200..330 | 1500..1900 => 0.0,
                0..600 => 0.4,
                _ => 1.3,
            },
            turn_rate_radps: 0.2,
            ..Controls::STAND
        };
        let before = allocations();
        walker.step(1.0 / 60.0, controls, workshop);
        if frame > 600 {
            assert_eq!(allocations() - before, 0, "crowd, frame {frame}");
        }
    }
}

#[test]
fn a_step_of_the_generator_allocates_nothing() {
    // Without fine motion, with it, with standing that lives, and with runs, jumps and crouches.
    for name in ["v1.footfall", "v3.footfall", "v4.footfall", "v6.footfall"] {
        let read = |name: &str| std::fs::read(repository().join("tests/model_versions").join(name));
        let model = Arc::new(GaitModel::from_bytes(&read(name).unwrap()).unwrap());
        let switching = Arc::new(DynamicsModel::from_bytes(&read("v1.footdyn").unwrap()).unwrap());
        let skeleton = model.skeleton.clone();
        let space = Arc::new(StyleSpace::new(&model, &[]).unwrap());
        for seed in 0..24 {
            let config = GeneratorConfig {
                seed,
                phase: 0.3,
                variation: 1.0,
            };
            let styled = GaitGenerator::new(&space, &[], &skeleton, &config).unwrap();
            assert_no_allocation(styled, seed);
            let walker = GaitGenerator::switching(&switching, &skeleton, &config).unwrap();
            // One that goes on from a state too.
            let mut other = GaitGenerator::switching(&switching, &skeleton, &config).unwrap();
            other.restore(&walker.state()).unwrap();
            assert_no_allocation(walker, seed);
            assert_no_allocation(other, seed);
        }
        assert_placing_allocates_nothing(
            GaitGenerator::new(&space, &[], &skeleton, &CONFIG).unwrap(),
        );
        assert_going_over_allocates_nothing(
            GaitGenerator::new(&space, &[], &skeleton, &CONFIG).unwrap(),
            &skeleton,
        );
        assert_following_allocates_nothing(
            GaitGenerator::new(&space, &[], &skeleton, &CONFIG).unwrap(),
            GaitGenerator::new(&space, &[], &skeleton, &CONFIG).unwrap(),
        );
        let styled = StyledBody::new(&space, &[], &skeleton).unwrap();
        let mut workshop = Workshop::new(&styled);
        let walker = CrowdWalker::new(&styled, &CONFIG, false, &mut workshop).unwrap();
        assert_crowds_allocate_nothing(walker, &mut workshop);
    }
    // The counter counts.
    let before = allocations();
    drop(std::hint::black_box(vec![0_u8; 100]));
    assert!(allocations() > before);
}

#[test]
fn a_body_that_sensors_drive_allocates_nothing() {
    let bytes = std::fs::read(repository().join("tests/model_versions/v1.footimu")).unwrap();
    let model = Arc::new(ImuModel::from_bytes(&bytes).unwrap());
    let skeleton = model.skeleton.clone();
    let prepared = Arc::new(Prepared::new(model).unwrap());
    let body = Reconstructor::new(&prepared, &skeleton, &ReconConfig::default()).unwrap();
    assert_driving_allocates_nothing(body);
}
