//! Flags from two signals with hysteresis, and runs of flags.

use super::signals::PointSignal;
use footfall_core::FrameSpan;

/// Limits of one point: heights in metres, speeds as shares of the swing's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    pub(super) height_on: f32,
    pub(super) height_off: f32,
    pub(super) speed_on: f32,
    pub(super) speed_off: f32,
}

/// Contact with hysteresis: on from a frame below both lower limits, off from one above either upper limit; `swing_speed` is that around each frame.
pub(super) fn gate(signal: &PointSignal, swing_speed: &[f32], limits: &Gate) -> Vec<bool> {
    let mut is_on = false;
    signal
        .height
        .iter()
        .zip(signal.speed.iter().zip(&signal.settling))
        .zip(swing_speed)
        .map(|((&height, (&speed, &settling)), swing)| {
            is_on = if is_on {
                height < limits.height_off && speed < limits.speed_off * swing
            } else {
                height < limits.height_on && settling < limits.speed_on * swing
            };
            is_on
        })
        .collect()
}

/// Sets the flags in gaps of fewer than `least` frames between set ones.
pub(super) fn close_gaps(flags: &mut [bool], least: usize) {
    let runs = FrameSpan::runs(flags);
    for pair in runs.windows(2) {
        if pair[1].first - pair[0].last - 1 < least {
            flags[pair[0].last..pair[1].first].fill(true);
        }
    }
}

/// Clears runs of fewer than `least` frames, except at the ends, where the clip may have cut them.
pub(super) fn drop_short(flags: &mut [bool], least: usize) {
    let end = flags.len();
    for span in FrameSpan::runs(flags) {
        if span.frames() < least && span.first > 0 && span.last + 1 < end {
            flags[span.first..=span.last].fill(false);
        }
    }
}
