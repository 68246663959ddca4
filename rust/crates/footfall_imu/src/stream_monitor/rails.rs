//! Axes that reach the end of the sensor's range: several samples in a row have one large value, which comes again and is never exceeded.

use super::CHANNELS;
use super::fault::{NAMES, StreamFault};

/// Least size of a value that may be the end of a range: ±2 g of a sensor whose gravity is 5 % off, and ±250 °/s, m/s² and rad/s.
const LEAST: [f32; 2] = [18.0, 4.1];

/// Samples in a row that make the end of a range out of a peak.
const ROW: u32 = 3;

/// Number of times that the end is reached before it is reported, and the seconds within which these must lie.
const TIMES: u32 = 3;
const WITHIN_SECS: f32 = 4.0;

/// A value is beyond the end of the range when it is larger by this factor.
const BEYOND: f32 = 1.005;

/// The value before the row is smaller than this share of the end: a peak that a converter's steps flatten is approached more gently.
const APPROACH: f32 = 0.98;

#[derive(Clone, Copy, Debug)]
struct Rail {
    last: f32,
    /// The value before those that are the same.
    before: f32,
    row: u32,
    /// The end of the range, as far as it is known; and how often and how long ago it was reached.
    end: f32,
    times: u32,
    since_secs: f32,
}

impl Rail {
    const NONE: Self = Self {
        last: f32::NAN,
        before: f32::NAN,
        row: 1,
        end: 0.0,
        times: 0,
        since_secs: 0.0,
    };

    fn step(&mut self, value: f32, least: f32, dt_secs: f32) {
        self.since_secs += dt_secs;
        if self.since_secs > WITHIN_SECS {
            self.times = 0;
        }
        if value.abs() > BEYOND * self.end.abs() && self.times > 0 {
            self.times = 0;
        }
        let same = value.to_bits() == self.last.to_bits();
        if same {
            self.row += 1;
        } else {
            (self.row, self.before) = (1, self.last);
        }
        self.last = value;
        let steep = self.before / value < APPROACH;
        if self.row == ROW && steep && value.abs() > least {
            // Both ends of a range are as far from zero as each other, give or take the sensor's calibration.
            let again = (value.abs() / self.end.abs() - 1.0).abs() < BEYOND - 1.0;
            self.times = if again { self.times + 1 } else { 1 };
            (self.end, self.since_secs) = (value, 0.0);
        }
    }
}

/// Ranges of the six axes, as far as they are known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rails {
    rails: [Rail; CHANNELS],
}

impl Rails {
    pub(super) const NONE: Self = Self {
        rails: [Rail::NONE; CHANNELS],
    };

    /// The next sample does not follow the last.
    pub(super) fn pause(&mut self) {
        self.rails.iter_mut().for_each(|rail| rail.row = 0);
    }

    pub(super) fn step(&mut self, row: &[f32; CHANNELS], dt_secs: f32) {
        for (n, (rail, value)) in self.rails.iter_mut().zip(row).enumerate() {
            rail.step(*value, LEAST[n / 3], dt_secs);
        }
    }

    pub(super) fn fault(&self) -> Option<StreamFault> {
        let n = self.rails.iter().position(|rail| rail.times >= TIMES)?;
        Some(StreamFault::Saturated {
            axis: NAMES[n],
            value: self.rails[n].end,
        })
    }
}
