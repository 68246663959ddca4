//! Axes that are stuck: the same value to the bit, or next to nothing, while the sensor moves.

use super::CHANNELS;
use super::fault::{NAMES, StreamFault};
use crate::sample::GRAVITY_MPS2;
use glam::Vec3;

/// Angular rate, rad/s, and deviation of the specific force from gravity, m/s², beyond either of which the sensor moves.
const MOVES_RADPS: f32 = 0.5;
const MOVES_MPS2: f32 = 1.5;

/// Movement over which an axis that keeps one value is stuck, seconds.
const SAME_SECS: f32 = 1.5;

/// Movement over which an axis that keeps one value may be stuck, seconds: an axis that works changes with every sample or two.
const SUSPECTED_SECS: f32 = 0.1;

/// Movement over which axes are compared, seconds.
const COMPARED_SECS: f32 = 3.0;

/// An axis is dead when it deviates by less than this from its mean, m/s² and rad/s, and by less than this share of the axis that deviates most.
const DEAD: [f32; 2] = [0.05, 0.02];
const DEAD_SHARE: f32 = 0.01;

/// One axis: the value that it keeps, and how it deviates over the movement that is compared.
#[derive(Clone, Copy, Debug)]
struct Axis {
    value: f32,
    /// Movement since the value changed.
    same_secs: f32,
    /// Sums over the movement that is compared, of differences from its first value.
    first: f32,
    sum: f32,
    squares: f32,
}

impl Axis {
    const NONE: Self = Self {
        value: f32::NAN,
        same_secs: 0.0,
        first: 0.0,
        sum: 0.0,
        squares: 0.0,
    };

    fn deviation(&self, secs: f32) -> f32 {
        let mean = self.sum / secs;
        (self.squares / secs - mean * mean).max(0.0).sqrt()
    }
}

/// State of the six axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct StuckAxes {
    axes: [Axis; CHANNELS],
    compared_secs: f32,
    /// Axis that was dead when the axes were last compared, and its mean.
    dead: Option<(usize, f32)>,
}

impl StuckAxes {
    pub(super) const NONE: Self = Self {
        axes: [Axis::NONE; CHANNELS],
        compared_secs: 0.0,
        dead: None,
    };

    pub(super) fn step(&mut self, row: &[f32; CHANNELS], dt_secs: f32) {
        let (force, rate) = (Vec3::from_slice(&row[..3]), Vec3::from_slice(&row[3..]));
        let moves =
            rate.length() > MOVES_RADPS || (force.length() - GRAVITY_MPS2).abs() > MOVES_MPS2;
        let begins = self.compared_secs <= 0.0;
        for (axis, value) in self.axes.iter_mut().zip(row) {
            if axis.value.to_bits() != value.to_bits() {
                (axis.value, axis.same_secs) = (*value, 0.0);
            } else if moves {
                axis.same_secs += dt_secs;
            }
            if begins {
                (axis.first, axis.sum, axis.squares) = (*value, 0.0, 0.0);
            }
            if moves {
                let off = value - axis.first;
                axis.sum += off * dt_secs;
                axis.squares += off * off * dt_secs;
            }
        }
        if moves {
            self.compared_secs += dt_secs;
        }
        if self.compared_secs > COMPARED_SECS {
            self.compare();
            self.compared_secs = 0.0;
        }
    }

    /// Looks for an axis that hardly changes beside the two of its kind.
    fn compare(&mut self) {
        let secs = self.compared_secs;
        self.dead = None;
        for (kind, least) in DEAD.into_iter().enumerate() {
            let own = &self.axes[3 * kind..3 * kind + 3];
            let deviations = own.iter().map(|axis| axis.deviation(secs));
            let most = deviations.clone().fold(0.0, f32::max);
            let limit = least.min(DEAD_SHARE * most);
            if let Some(n) = deviations.clone().position(|deviation| deviation < limit) {
                self.dead = Some((3 * kind + n, own[n].first + own[n].sum / secs));
            }
        }
    }

    /// Returns true while an axis may be stuck, or is.
    pub(super) fn are_suspected(&self) -> bool {
        self.axes.iter().any(|axis| axis.same_secs > SUSPECTED_SECS)
    }

    pub(super) fn fault(&self) -> Option<StreamFault> {
        let same = self.axes.iter().position(|a| a.same_secs > SAME_SECS);
        let same = same.map(|n| (n, self.axes[n].value));
        let (n, value) = same.or(self.dead)?;
        Some(StreamFault::StuckAxis {
            axis: NAMES[n],
            value,
        })
    }
}
