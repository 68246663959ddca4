//! `GaitGenerator::step` allocates nothing, whatever it is asked to do.
#![expect(unsafe_code, reason = "counting allocations takes an allocator")]

use footfall_core::Pose;
use footfall_model::{DynamicsModel, GaitModel};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall_tests::data::repository;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

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
        };
        let dt_secs = if frame % 1000 == 999 { 3.0 } else { 1.0 / 60.0 };
        let before = allocations();
        generator.step(dt_secs, &controls, &mut pose);
        assert_eq!(allocations() - before, 0, "seed {seed}, frame {frame}");
        assert!(generator.footsteps().len() <= 64);
    }
    assert!(pose.root_position.is_finite());
}

#[test]
fn a_step_of_the_generator_allocates_nothing() {
    let read = |name: &str| std::fs::read(repository().join("tests/model_versions").join(name));
    let model = Arc::new(GaitModel::from_bytes(&read("v1.footfall").unwrap()).unwrap());
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
    // The counter counts.
    let before = allocations();
    drop(std::hint::black_box(vec![0_u8; 100]));
    assert!(allocations() > before);
}
