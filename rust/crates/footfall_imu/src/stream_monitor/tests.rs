//! Faults that are put into the samples of a swinging limb.

use super::{FaultSpan, StreamFault, StreamMonitor};
use crate::sample::{GRAVITY_MPS2, ImuRecording, ImuSample};
use core::f32::consts::TAU;
use glam::{Quat, Vec3};

const SECS: f64 = 12.0;

/// A limb that rests, and from the third second on swings once a second and is moved about; a pinch of noise on everything.
fn limb(rate_hz: f64) -> ImuRecording {
    let samples = (0..(SECS * rate_hz) as u32).map(|n| {
        let time_secs = f64::from(n) / rate_hz;
        let moves = ((time_secs as f32 - 2.5) * 2.0).clamp(0.0, 1.0);
        let phase = (time_secs % 1.0) as f32 * TAU;
        let noise = |seed: f32| 0.01 * ((n as f32 * 12.9898 + seed).sin() * 43_758.547).fract();
        let swing = moves * 0.7;
        let turn = Quat::from_rotation_x(0.3 + swing * phase.sin());
        let moved = moves * Vec3::new(phase.sin(), 16.0 * phase.cos(), 14.0 * phase.sin());
        let rate = Vec3::new(
            swing * TAU * phase.cos(),
            moves * phase.sin(),
            moves * phase.cos(),
        );
        let noises = |first: f32| Vec3::new(noise(first), noise(first + 1.0), noise(first + 2.0));
        ImuSample {
            time_secs,
            force: turn.inverse() * (moved + Vec3::Y * GRAVITY_MPS2) + noises(0.0),
            rate: rate + noises(3.0),
        }
    });
    ImuRecording {
        samples: samples.collect(),
    }
}

/// Faults of the limb when its samples are changed.
fn faults(change: impl Fn(&mut ImuSample)) -> Vec<FaultSpan> {
    let mut recording = limb(100.0);
    recording.samples.iter_mut().for_each(change);
    StreamMonitor::faults_of(&recording, None)
}

/// Checks that one fault is reported, by this name and text, soon enough.
fn is_told(spans: &[FaultSpan], name: &str, text: &str, by_secs: f64) {
    let first = spans
        .first()
        .unwrap_or_else(|| panic!("{name} is not reported"));
    assert!(
        spans.iter().all(|span| span.fault.name() == name),
        "{spans:?}"
    );
    assert!(first.fault.to_string().contains(text), "{}", first.fault);
    assert!(first.start_secs < by_secs, "{first:?}");
}

#[test]
fn a_sound_sensor_has_no_fault_at_any_rate() {
    for rate_hz in [50.0, 60.0, 100.0, 204.8, 400.0] {
        let spans = StreamMonitor::faults_of(&limb(rate_hz), None);
        assert_eq!(spans, [], "{rate_hz} Hz");
    }
    // A phone's browser: steps of 0.1 m/s² and 0.1 °/s, sixty a second.
    let mut phone = limb(60.0);
    for sample in &mut phone.samples {
        let steps = |vector: Vec3, step: f32| (vector / step).round() * step;
        sample.force = steps(sample.force, 0.1);
        sample.rate = steps(sample.rate, 0.1_f32.to_radians());
    }
    assert_eq!(StreamMonitor::faults_of(&phone, Some(60.0)), []);
}

#[test]
fn a_stuck_axis_is_told_within_two_seconds_of_motion() {
    let from = 6.0;
    let stuck = faults(|sample| {
        if sample.time_secs > from {
            sample.rate.x = 0.25;
        }
    });
    is_told(&stuck, "stuck_axis", "gx stays at 0.25", from + 2.5);
    assert!(stuck[0].start_secs > from);
    // Dead, though its converter is noisy.
    let dead = faults(|sample| {
        if sample.time_secs > 3.0 {
            sample.force.y = 0.02 * (sample.force.y * 1e4).fract();
        }
    });
    is_told(&dead, "stuck_axis", "ay", 9.5);
    // A whole gyroscope.
    let dead = faults(|sample| sample.rate = Vec3::ZERO);
    is_told(&dead, "stuck_axis", "gx", 6.0);
}

#[test]
fn the_end_of_a_range_is_told_when_it_is_reached_again_and_again() {
    let end = 2.0 * GRAVITY_MPS2;
    let clipped =
        faults(|sample| sample.force = sample.force.clamp(Vec3::splat(-end), Vec3::splat(end)));
    is_told(&clipped, "saturated", "ay repeatedly stops at 19.6", 8.0);
    assert!(!clipped[0].fault.is_blinding());
    let wide = faults(|sample| {
        let end = Vec3::splat(4.0 * GRAVITY_MPS2);
        sample.force = sample.force.clamp(-end, end);
    });
    assert_eq!(wide, []);
}

#[test]
fn units_are_told_at_rest_and_in_motion() {
    is_told(
        &faults(|s| s.force /= GRAVITY_MPS2),
        "force_in_g",
        "9.80665",
        2.0,
    );
    is_told(&faults(|s| s.force *= 100.0), "gravity", "98", 2.0);
    let free = faults(|s| {
        if s.time_secs < 2.5 {
            s.force *= 0.001;
        }
    });
    is_told(&free, "gravity", "including gravity", 2.0);
    let degrees = faults(|s| s.rate *= 1_f32.to_degrees());
    is_told(&degrees, "rate_in_degrees", "0.0174533", 4.0);
}

#[test]
fn a_lift_that_starts_and_a_scale_that_is_off_are_no_fault_of_units() {
    let lift = faults(|s| {
        if s.time_secs < 2.0 {
            s.force *= 1.15;
        }
    });
    assert_eq!(lift, []);
}

#[test]
fn a_rate_that_was_not_promised_is_told() {
    let every = |n: usize, promised_hz: Option<f64>| {
        let mut recording = limb(100.0);
        let mut count = 0;
        recording.samples.retain(|_| {
            count += 1;
            count % n == 0
        });
        StreamMonitor::faults_of(&recording, promised_hz)
    };
    is_told(
        &every(2, Some(100.0)),
        "pace",
        "50 samples a second instead of 100",
        3.0,
    );
    is_told(
        &every(1, Some(50.0)),
        "pace",
        "100 samples a second instead of 50",
        3.0,
    );
    is_told(&every(6, None), "slow", "only 17 samples", 3.0);
    assert_eq!(every(1, Some(100.0)), []);
    // One that loses every second sample later on.
    let mut failing = limb(100.0);
    let mut odd = false;
    failing.samples.retain(|sample| {
        odd = !odd;
        sample.time_secs < 6.0 || odd
    });
    let spans = StreamMonitor::faults_of(&failing, None);
    is_told(&spans, "pace", "instead of 100", 10.5);
    assert!(spans[0].start_secs > 6.0);
}

#[test]
fn a_fault_that_ends_is_told_no_longer() {
    let spans = faults(|sample| {
        if (4.0..7.0).contains(&sample.time_secs) {
            sample.force.z = 1.0;
        }
    });
    is_told(&spans, "stuck_axis", "az", 6.5);
    assert!(spans[0].end_secs < 7.1, "{spans:?}");
    let silent = |sample: &ImuSample| !(5.0..8.0).contains(&sample.time_secs);
    let mut paused = limb(100.0);
    paused.samples.retain(silent);
    assert_eq!(
        StreamMonitor::faults_of(&paused, None),
        [],
        "a pause is silence"
    );
}

#[test]
fn nonsense_is_left_out() {
    let mut monitor = StreamMonitor::new(None);
    for sample in &limb(100.0).samples {
        monitor.push(*sample);
        monitor.push(ImuSample {
            force: Vec3::NAN,
            ..*sample
        });
        monitor.push(ImuSample {
            time_secs: sample.time_secs - 0.1,
            rate: Vec3::X * 1e9,
            ..*sample
        });
        monitor.push(ImuSample {
            time_secs: f64::INFINITY,
            ..*sample
        });
    }
    assert_eq!(monitor.fault(), None::<StreamFault>);
}
