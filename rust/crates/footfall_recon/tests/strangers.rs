//! Wearers who move like people in a model, and strangers.

use footfall_core::{Behaviour, PhaseKind, PhaseStart, Side, Site, Skeleton};
use footfall_model::imu_model::{BODY_COUNT, HEIGHT, MAX_WIDTH, SENSOR_COUNT, Segment};
use footfall_model::{ImuModel, Provenance};
use footfall_recon::{Measurement, Prepared, Published, StridePhase, Tracker, TrackerConfig};
use std::sync::Arc;

const FRAMES: usize = 4;
const SEGMENTS: usize = 6;

/// A number that a sensor measures in a frame of a walk.
fn wave(frame: usize) -> f32 {
    (frame as f32 * std::f32::consts::TAU / (2 * FRAMES) as f32).sin() * 2.0
}

/// Walks of two people whose thighs measure nearly the same: all joints of the first are at 0, of the second at 1.
fn model() -> ImuModel {
    let kind = |side| PhaseKind {
        behaviour: Behaviour::Walk,
        start: PhaseStart::Landing,
        side,
    };
    let frames = || (0..2 * SEGMENTS * FRAMES).map(|n| (n / (SEGMENTS * FRAMES), n));
    ImuModel {
        frame_rate_hz: 30.0,
        sites: vec![Site::RightThigh],
        skeleton: Skeleton::standard(),
        phases: vec![kind(Side::Left), kind(Side::Right)],
        next: vec![0.0, 1.0, 1.0, 0.0],
        subjects: 2,
        segments: (0..2 * SEGMENTS)
            .map(|n| Segment {
                phase: (n % 2) as u16,
                subject: (n / SEGMENTS) as u16,
                frames: FRAMES as u16,
                follows: n % SEGMENTS > 0,
            })
            .collect(),
        sensor: frames()
            .flat_map(|(person, n)| measured(n, 1.6 * person as f32))
            .collect(),
        body: frames()
            .flat_map(|(person, _)| {
                let mut row = [0.0; BODY_COUNT];
                row[..HEIGHT].fill(person as f32);
                row
            })
            .collect(),
        deviations: vec![1.0; SENSOR_COUNT],
        regressions: vec![Vec::new(); 2],
        provenance: Provenance::default(),
    }
}

/// Numbers of a frame, of whom the third is somebody's own.
fn measured(frame: usize, own: f32) -> [f32; SENSOR_COUNT] {
    let mut row = [0.0; SENSOR_COUNT];
    (row[0], row[1], row[2]) = (wave(frame), wave(frame + 1), own);
    row
}

/// A joint after a walk of the first person, or of somebody whose sensor measures so much beside theirs.
fn shown(prepared: Prepared, beside: f32) -> f32 {
    let mut tracker = Tracker::new(&Arc::new(prepared), TrackerConfig::default());
    let mut joint = 0.0;
    for n in 0..90 {
        let mut values = [0.0; MAX_WIDTH];
        values[..SENSOR_COUNT].copy_from_slice(&measured(n, 0.0));
        values[3] = beside;
        let sensor = Measurement {
            values,
            weights: [1.0; MAX_WIDTH],
            stride: StridePhase::default(),
        };
        tracker.step(Some(&sensor));
        joint = tracker.body(Some(&sensor)).body[0];
    }
    joint
}

#[test]
fn people_in_the_model_are_shown_as_they_are_and_strangers_like_several() {
    let prepare = || Prepared::new(Arc::new(model())).expect("a model that fits together");
    let known = shown(prepare(), 0.0);
    assert!(known < 0.05, "{known}");
    let stranger = shown(prepare(), 2.0);
    assert!((0.3..0.4).contains(&stranger), "{stranger}");
    // Half a stranger is shown half like several people.
    let half = shown(prepare(), 1.36);
    assert!((0.1..0.25).contains(&half), "{half}");
    let published = Published::prepare(&[Published::Manner], prepare());
    let published = shown(published, 2.0);
    assert!(published < 0.05, "{published}");
}
