//! Steps that hardly pitch the foot: in turns, sideways, on the spot, and the half step before standing.
//!
//! The foot moves between two rests, and no swing was found in its pitch. It lands where the ground jolts it most. It is lifted where the heel has risen
//! fastest, or, lifted flat, where it has begun to move.

use crate::filter::{frames_of, means_around, strongest};
use core::ops::Range;
use glam::Vec3;

/// A foot rests while it turns more slowly than this, root mean square over a time to either side, seconds.
const REST_RADPS: f32 = 0.5;
const REST_REACH_SECS: f64 = 0.03;

/// Shorter rests do not count, seconds.
const LEAST_REST_SECS: f64 = 0.08;

/// Least duration of the foot's motion in a step, seconds, and least sum of its rotations, radians.
const LEAST_SECS: f64 = 0.2;
const LEAST_TURN: f32 = 0.6;

/// Least time from the beginning of a step to its landing, and least time in the air, seconds.
const LANDS_AFTER_SECS: f64 = 0.1;
const LEAST_SWING_SECS: f64 = 0.12;

/// A heel rises where the foot turns about its axis of pitch for this share of all its turning, and at least so fast, rad/s.
const RISE_SHARE: f32 = 0.7;
const LEAST_RISE_RADPS: f32 = 0.3;

/// A foot that is lifted flat has begun to move at this share of its fastest turning.
const LIFTED_SHARE: f32 = 0.35;

/// Terminal and initial contact, as samples, of the flat steps among samples in which no swing of `swings` falls, in order.
pub(super) fn flat_steps(
    rates: &[Vec3],
    pitch: &[f32],
    jolts: &[f32],
    swings: &[[usize; 2]],
    rate_hz: f64,
) -> Vec<[usize; 2]> {
    let squares: Vec<f32> = rates.iter().map(|rate| rate.length_squared()).collect();
    let turning: Vec<f32> = means_around(&squares, frames_of(REST_REACH_SECS, rate_hz))
        .into_iter()
        .map(f32::sqrt)
        .collect();
    let free = |bout: &Range<usize>| {
        swings
            .iter()
            .all(|swing| swing[0] > bout.end || swing[1] < bout.start)
    };
    bouts(&turning, rate_hz)
        .into_iter()
        .filter(free)
        .filter_map(|bout| {
            let turned = turning[bout.clone()].iter().sum::<f32>() / rate_hz as f32;
            if bout.len() < frames_of(LEAST_SECS, rate_hz) || turned < LEAST_TURN {
                return None;
            }
            let initial = strongest(
                jolts,
                bout.start + frames_of(LANDS_AFTER_SECS, rate_hz)..bout.end,
            );
            let terminal = lifted(rates, pitch, &turning, &bout);
            (terminal + frames_of(LEAST_SWING_SECS, rate_hz) <= initial)
                .then_some([terminal, initial])
        })
        .collect()
}

/// When a foot leaves the ground in a bout of motion.
fn lifted(rates: &[Vec3], pitch: &[f32], turning: &[f32], bout: &Range<usize>) -> usize {
    let push = strongest(pitch, bout.start..bout.start + bout.len() / 2);
    if pitch[push] > LEAST_RISE_RADPS.max(RISE_SHARE * rates[push].length()) {
        return push;
    }
    let begun = LIFTED_SHARE * turning[strongest(turning, bout.clone())];
    bout.clone()
        .find(|&n| turning[n] >= begun)
        .unwrap_or(bout.start)
}

/// Stretches in which a foot moves, each between two rests or an end of the recording.
fn bouts(turning: &[f32], rate_hz: f64) -> Vec<Range<usize>> {
    let least_rest = frames_of(LEAST_REST_SECS, rate_hz);
    let mut bouts: Vec<Range<usize>> = Vec::new();
    for n in (0..turning.len()).filter(|n| turning[*n] > REST_RADPS) {
        match bouts.last_mut() {
            Some(bout) if n - bout.end < least_rest => bout.end = n + 1,
            _ => bouts.push(n..n + 1),
        }
    }
    bouts
}
