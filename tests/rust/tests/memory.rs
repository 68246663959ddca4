//! A walker holds little of its own: what walkers of one model can share, they share.
#![expect(unsafe_code, reason = "counting bytes takes an allocator")]

use footfall_core::Pose;
use footfall_model::{DynamicsModel, GaitModel, GaitStyle};
use footfall_synth::{
    Controls, CrowdWalker, Detail, GaitGenerator, GeneratorConfig, StyleSpace, StyledBody, Workshop,
};
use footfall_tests::data::repository;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

/// Bytes that one walker more may cost. A node of an engine around it has some of its own.
const MOST_BYTES: isize = 52_000;
/// The same for a walker of a switching model, which shares no buffers.
const MOST_SWITCHING_BYTES: isize = 140_000;
const WALKERS: u64 = 100;

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
}

struct Weighing;

fn weigh(bytes: isize) {
    // Gone while a thread ends; nothing is counted then.
    let _counted = HELD.try_with(|held| held.set(held.get() + bytes));
}

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Weighing {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        weigh(layout.size().cast_signed());
        // SAFETY: the caller keeps `alloc`'s contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        weigh(-layout.size().cast_signed());
        // SAFETY: the caller keeps `dealloc`'s contract.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        weigh(size.cast_signed() - layout.size().cast_signed());
        // SAFETY: the caller keeps `realloc`'s contract.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static WEIGHING: Weighing = Weighing;

fn held() -> isize {
    HELD.with(Cell::get)
}

fn config(seed: u64) -> GeneratorConfig {
    GeneratorConfig {
        seed,
        phase: 0.3,
        variation: 1.0,
    }
}

fn walk(walkers: &mut [GaitGenerator]) {
    let mut pose = Pose::default();
    for walker in walkers {
        for frame in 0..300_u16 {
            let controls = Controls {
                speed_mps: f32::from(frame) * 0.01,
                turn_rate_radps: 0.2,
                ..Controls::STAND
            };
            walker.step(1.0 / 60.0, &controls, &mut pose);
        }
    }
}

/// Bytes of one walker beyond the first, when it was made and after it has walked.
fn bytes_of_one_more(make: impl Fn(u64) -> GaitGenerator) -> [isize; 2] {
    let mut first = [make(0)];
    walk(&mut first);
    let before = held();
    let mut walkers: Vec<GaitGenerator> = (1..=WALKERS).map(make).collect();
    let made = held() - before;
    walk(&mut walkers);
    let walked = held() - before;
    [made, walked].map(|bytes| bytes / WALKERS.cast_signed() as isize)
}

#[test]
fn a_walker_more_costs_little_memory() {
    let models = repository().join("addons/footfall/models");
    let read = |name: &str| std::fs::read(models.join(name)).unwrap();
    let model = Arc::new(GaitModel::from_bytes(&read("locomotion.footfall")).unwrap());
    let style = Arc::new(GaitStyle::from_bytes(&read("proud.footstyle")).unwrap());
    let space = Arc::new(StyleSpace::new(&model, &[style]).unwrap());
    let new = |weights: &[f32], seed| {
        GaitGenerator::new(&space, weights, &model.skeleton, &config(seed)).unwrap()
    };
    let plain = bytes_of_one_more(|seed| new(&[], seed));
    let styled = bytes_of_one_more(|seed| new(&[0.7], seed));
    let changed = bytes_of_one_more(|seed| {
        let mut walker = new(&[], seed);
        for change in 0..10_u8 {
            walker.set_style_weights(&[0.1 * f32::from(change)]);
        }
        walker
    });
    println!(
        "bytes when made and when walked: plain {plain:?}, styled {styled:?}, changed {changed:?}"
    );
    for bytes in [plain, styled, changed].concat() {
        assert!(
            (1000..=MOST_BYTES).contains(&bytes),
            "{bytes} bytes a walker"
        );
    }
}

#[test]
fn a_walker_more_of_a_switching_model_costs_little_memory() {
    let bytes = std::fs::read(repository().join("tests/model_versions/v1.footdyn")).unwrap();
    let model = Arc::new(DynamicsModel::from_bytes(&bytes).unwrap());
    let bytes = bytes_of_one_more(|seed| {
        GaitGenerator::switching(&model, &model.skeleton, &config(seed)).unwrap()
    });
    println!("bytes when made and when walked: {bytes:?}");
    for bytes in bytes {
        assert!(
            (1000..=MOST_SWITCHING_BYTES).contains(&bytes),
            "{bytes} bytes a walker"
        );
    }
}

/// Bytes of a crowd's walkers, each: with steps of their own, in shared ones, and near again.
#[test]
fn walkers_far_away_keep_nothing_of_their_own() {
    const CROWD: u64 = 1500;
    let path = repository().join("addons/footfall/models/locomotion.footfall");
    let model = Arc::new(GaitModel::from_bytes(&std::fs::read(path).unwrap()).unwrap());
    let space = Arc::new(StyleSpace::new(&model, &[]).unwrap());
    let styled = StyledBody::new(&space, &[], &model.skeleton).unwrap();
    let before = held();
    let mut workshop = Workshop::new(&styled);
    let walkers = (0..CROWD).map(|seed| CrowdWalker::sharing(&styled, &config(seed)));
    let mut walkers: Vec<CrowdWalker> = walkers.collect();
    let mut bytes = [false, true, false, true].map(|repeats| {
        for walker in &mut walkers {
            walker.set_repeating(repeats);
            walker.set_detail(Detail::Quarter);
            for _ in 0..150 {
                let controls = Controls {
                    speed_mps: 1.2,
                    ..Controls::STAND
                };
                walker.step(1.0 / 60.0, controls, &mut workshop);
            }
        }
        (held() - before) / CROWD.cast_signed() as isize
    });
    drop(workshop);
    bytes[3] = (held() - before) / CROWD.cast_signed() as isize;
    println!("bytes near, far, near and far, without what is kept for others: {bytes:?}");
    let [near, _, again, far] = bytes;
    assert!((3000..14_000).contains(&near), "{near} bytes near");
    assert!(again < near + 200, "own steps are given on: {again} bytes");
    assert!((100..250).contains(&far), "{far} bytes far away");
}
