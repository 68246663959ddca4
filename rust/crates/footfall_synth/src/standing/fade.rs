//! Fading in and out of motion that shows while a walker stands.

use footfall_core::ease::settled;

/// Rates at which a motion fades in and out, those of a critically damped spring, 1/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    pub(super) rise: f32,
    pub(super) fall: f32,
}

/// Returns the share of a motion, 0 to 1, and its rate, 1/s, after this time of a walker that stands or walks throughout.
pub(super) fn faded([share, speed]: [f32; 2], rates: Rates, stands: bool, secs: f32) -> [f32; 2] {
    let (target, rate) = if stands {
        (1.0, rates.rise)
    } else {
        (0.0, rates.fall)
    };
    let (away, speed) = settled(share - target, speed, rate, secs);
    [target + away, speed]
}
