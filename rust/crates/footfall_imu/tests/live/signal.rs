//! Measurements of a simulated sensor, and the part of them that arrives.

use footfall_imu::ImuSample;
use footfall_imu::live::{Device, Link, LinkState};
use glam::Vec3;
use std::time::{Duration, Instant};

/// A sensor that swings and is shaken, at a time in seconds. Values are exact in every form's steps to about a thousandth.
pub(crate) fn sample(time_secs: f64) -> ImuSample {
    let wave = |rate: f64, shift: f64| (time_secs * rate + shift).sin() as f32;
    ImuSample {
        time_secs,
        force: Vec3::new(
            2.0 * wave(5.0, 0.0),
            9.8 + wave(9.0, 1.0),
            1.5 * wave(7.0, 2.0),
        ),
        rate: Vec3::new(
            1.5 * wave(5.0, 0.3),
            0.4 * wave(3.0, 0.7),
            0.8 * wave(8.0, 0.1),
        ),
    }
}

/// Samples at 100 Hz.
pub(crate) fn samples(count: u32) -> Vec<ImuSample> {
    (0..count).map(|n| sample(f64::from(n) * 0.01)).collect()
}

/// Checks that a sample came through as it was, its time apart.
pub(crate) fn check_same(found: &ImuSample, sent: &ImuSample, tolerance: f32) {
    assert!(
        (found.force - sent.force).abs().max_element() < tolerance * 10.0,
        "{found:?} for {sent:?}"
    );
    assert!(
        (found.rate - sent.rate).abs().max_element() < tolerance,
        "{found:?} for {sent:?}"
    );
}

/// Waits until something holds; `what` names it when it never does.
pub(crate) fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let begin = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(begin.elapsed() < Duration::from_secs(20), "in vain: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

pub(crate) fn wait_for_address(link: &Link) -> std::net::SocketAddr {
    let address = wait_for("the link listens", || {
        assert!(
            !matches!(link.state(), LinkState::Failed(_)),
            "{:?}",
            link.state()
        );
        link.address()
    });
    std::net::SocketAddr::from(([127, 0, 0, 1], address.port()))
}

/// Takes samples until there are so many.
pub(crate) fn wait_for_samples(device: &Device, count: usize) -> Vec<ImuSample> {
    let mut samples = Vec::new();
    let what = format!("{count} samples");
    wait_for(&what, || {
        device.take(|sample| samples.push(sample));
        (samples.len() >= count).then_some(())
    });
    samples
}
