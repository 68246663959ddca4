//! Hip and knee angles, where they put the ankles, and the half cycles in them.

use super::ANGLE_RATE_HZ;
use crate::contacts::body_size;
use footfall_core::rotation::log_map;
use footfall_core::{Clip, Side};
use footfall_prob::switching::median;

/// Hip and knee of both legs.
pub(super) const CHANNELS: usize = 4;

/// Least length of a half cycle, frames.
const LEAST_HALF_CYCLE: usize = 8;

/// Least swing of its ankles, as a share of the usual distance between them: less is standing.
const LEAST_SWING: f64 = 0.25;

/// Least swing of its ankles on the canonical body, metres.
const LEAST_SWING_M: f64 = 0.1;

/// Standard deviation of the window under which half cycles are looked for, frames.
const CYCLE_SMOOTHING: f64 = 2.0;

/// Sagittal angles of hips and knees, radians, at [`ANGLE_RATE_HZ`].
pub(super) struct LegAngles {
    /// Frame by frame: hip left and right, positive when the thigh is behind; knee left and right, positive when bent.
    pub(super) frames: Vec<[f64; CHANNELS]>,
    /// Lengths of left and right thigh and shank, metres.
    bones: [[f64; 2]; 2],
    /// Size of the body: 1 for the canonical one.
    pub(super) size: f64,
}

/// A half cycle: one leg is ahead.
#[derive(Clone, Copy)]
pub(super) struct HalfCycle {
    /// The frame in which the ankles are farthest apart.
    pub(super) frame: usize,
    /// The leg that is ahead.
    pub(super) side: Side,
}

impl LegAngles {
    pub(super) fn of(clip: &Clip, first_frame: usize) -> Self {
        let moving = Clip {
            poses: clip.poses.get(first_frame..).unwrap_or_default().to_vec(),
            ..clip.clone()
        };
        let frames = moving.resampled(ANGLE_RATE_HZ).poses;
        let frames = frames.iter().map(|pose| {
            let angle = |joint| f64::from(log_map(pose.rotation(joint)).x);
            [
                angle(Side::Left.upper_leg()),
                angle(Side::Right.upper_leg()),
                angle(Side::Left.lower_leg()),
                angle(Side::Right.lower_leg()),
            ]
        });
        Self {
            frames: frames.collect(),
            size: f64::from(body_size(clip)),
            bones: Side::BOTH.map(|side| {
                [side.lower_leg(), side.foot()]
                    .map(|joint| f64::from(clip.skeleton.offset(joint).length()))
            }),
        }
    }

    /// Distance of an ankle ahead of its hip in the plane of the angles, metres, and its height above it.
    pub(super) fn ankle(&self, frame: usize, side: Side) -> [f64; 2] {
        let (hip, knee) = (self.frames[frame][side.index()], self.knee(frame, side));
        let [thigh, shank] = self.bones[side.index()];
        [
            -(thigh * hip.sin() + shank * (hip + knee).sin()),
            -(thigh * hip.cos() + shank * (hip + knee).cos()),
        ]
    }

    /// Bend of a knee, radians.
    pub(super) fn knee(&self, frame: usize, side: Side) -> f64 {
        self.frames[frame][2 + side.index()]
    }

    /// Distance of the left ankle ahead of the right one, metres, and its height above it.
    pub(super) fn between_ankles(&self, frame: usize) -> [f64; 2] {
        let [left, right] = Side::BOTH.map(|side| self.ankle(frame, side));
        [left[0] - right[0], left[1] - right[1]]
    }

    /// A signal over all frames under a Gaussian window.
    pub(super) fn smoothed(&self, deviation: f64, signal: impl Fn(usize) -> f64) -> Vec<f64> {
        let values: Vec<f64> = (0..self.frames.len()).map(signal).collect();
        smoothed(&values, deviation)
    }

    /// The runs of frames in which one ankle is ahead, each where it is farthest ahead.
    pub(super) fn half_cycles(&self) -> Vec<HalfCycle> {
        let leads = self.smoothed(CYCLE_SMOOTHING, |frame| self.between_ankles(frame)[0]);
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for frame in 0..leads.len() {
            match runs.last_mut() {
                Some((_, last)) if leads[*last].signum() == leads[frame].signum() => *last = frame,
                _ => runs.push((frame, frame)),
            }
        }
        let peaks: Vec<usize> = runs
            .iter()
            .filter(|(first, last)| last - first + 1 >= LEAST_HALF_CYCLE)
            .map(|&(first, last)| {
                (first..=last).fold(first, |best, frame| {
                    if leads[frame].abs() > leads[best].abs() {
                        frame
                    } else {
                        best
                    }
                })
            })
            .collect();
        let swings: Vec<f64> = peaks.iter().map(|peak| leads[*peak].abs()).collect();
        let least = (LEAST_SWING * median(&swings)).max(LEAST_SWING_M * self.size);
        // A leg that is still moving ahead when the clip ends has not landed in it.
        let seen = |frame: &usize| *frame > 0 && frame + 1 < leads.len();
        peaks
            .into_iter()
            .filter(seen)
            .filter(|peak| leads[*peak].abs() > least)
            .map(|frame| HalfCycle {
                frame,
                side: if leads[frame] > 0.0 {
                    Side::Left
                } else {
                    Side::Right
                },
            })
            .collect()
    }
}

/// Place of a signal's maximum within a window around a frame, interpolated by a parabola.
pub(super) fn greatest(signal: &[f64], around: usize, [before, after]: [usize; 2]) -> f64 {
    let first = around.saturating_sub(before);
    let last = (around + after).min(signal.len() - 1);
    let at = (first..=last).fold(first, |best, frame| {
        if signal[frame] > signal[best] {
            frame
        } else {
            best
        }
    });
    if at == first || at == last {
        return at as f64;
    }
    let [left, top, right] = [signal[at - 1], signal[at], signal[at + 1]];
    let curvature = left - 2.0 * top + right;
    let beyond = if curvature < 0.0 {
        0.5 * (left - right) / curvature
    } else {
        0.0
    };
    at as f64 + beyond
}

/// Values under a Gaussian window, the ends repeated.
pub(super) fn smoothed(values: &[f64], deviation: f64) -> Vec<f64> {
    let reach = (3.0 * deviation).ceil() as isize;
    let last = values.len().cast_signed() - 1;
    let weight = |offset: isize| (-0.5 * (offset as f64 / deviation).powi(2)).exp();
    let total: f64 = (-reach..=reach).map(weight).sum();
    (0..=last)
        .map(|at| {
            let sum: f64 = (-reach..=reach)
                .map(|offset| weight(offset) * values[(at + offset).clamp(0, last) as usize])
                .sum();
            sum / total
        })
        .collect()
}
