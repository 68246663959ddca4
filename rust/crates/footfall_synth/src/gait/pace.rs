//! Conversion of a requested speed to a pace of the model, by a table of measured paces.

use super::direction::overstep;
use glam::Vec2;

/// Tempo up to which steps have all of their fine motion.
const UNHURRIED_TEMPO: f64 = 1.3;

/// Number of measured paces.
pub(crate) const SAMPLES: usize = 7;

/// Largest factor by which tempo and stride together exceed the measured range.
const MAX_RESIDUAL: f64 = 1.6;

/// Least factor on the tempo: slower walks take shorter strides instead.
const MIN_TEMPO: f64 = 0.8;

/// Largest factor on the tempo of the briskest walk, for steps to the side and backwards.
const MOST_QUICKER: f64 = 1.9;

/// Increment of the search for a walk with short enough steps, m/s.
const BRISKER_MPS: f64 = 0.05;

/// Pace of a step: where a speed lies on the model's speed response, and factors for speeds beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Place on the model's speed response, m/s.
    pub(crate) covariate_mps: f64,
    /// Factor on the rate at which states pass.
    pub(crate) tempo: f64,
    /// Factor on the legs' reach forwards and backwards.
    pub(crate) stride: f64,
}

impl Pace {
    /// Returns the sum of the differences from another pace, m/s and factors alike.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let covariate = (self.covariate_mps - other.covariate_mps).abs();
        covariate + (self.tempo - other.tempo).abs() + (self.stride - other.stride).abs()
    }

    /// Returns the share of the fine motion in steps of this pace. It goes with the phase of the step, so that the accelerations of a quick one would grow with the square of the tempo.
    pub(crate) fn fine_share(&self) -> f32 {
        (UNHURRIED_TEMPO / self.tempo).powi(2).min(1.0) as f32
    }

    /// Returns the pace of the same speed with steps that are quicker, and shorter, by this factor.
    pub(crate) fn quicker(self, factor: f64) -> Self {
        Self {
            tempo: self.tempo * factor,
            stride: self.stride / factor,
            ..self
        }
    }
}

/// Speeds of one walker at the paces of the model.
#[derive(Clone, Debug)]
pub(crate) struct PaceTable {
    /// Covariate and resulting speed, both rising, m/s, and duration of a step, seconds.
    samples: [[f64; 3]; SAMPLES],
    leg_length: f32,
    /// Heading under which the walk goes along +Z, radians.
    pub(crate) facing: f32,
}

impl PaceTable {
    /// Makes a table of measured samples: covariate and resulting speed, m/s, and duration of a step, seconds.
    pub(crate) fn new(mut samples: [[f64; 3]; SAMPLES], leg_length: f32, facing: f32) -> Self {
        for index in 1..SAMPLES {
            // A corpus of one speed has a flat response: the order must still be strict.
            samples[index][1] = samples[index][1].max(samples[index - 1][1] + 1e-4);
        }
        Self {
            samples,
            leg_length,
            facing,
        }
    }

    /// Returns the pace for a speed forwards. Beyond the measured range, tempo and stride share the missing factor.
    pub(crate) fn pace(&self, speed_mps: f64) -> Pace {
        self.pace_and_secs(speed_mps).0
    }

    /// Returns the pace for a velocity to the left and forwards. If its steps would be too long, a brisker walk with shorter steps is chosen,
    /// and a quicker tempo beyond that.
    pub(crate) fn pace_towards(&self, velocity_mps: Vec2) -> Pace {
        let speed = f64::from(velocity_mps.length());
        let fastest = self.samples[SAMPLES - 1][1];
        let mut brisk = speed;
        loop {
            let (mut pace, secs) = self.pace_and_secs(brisk);
            let over = f64::from(overstep(velocity_mps, secs as f32, self.leg_length));
            if over <= 1.0 || brisk >= fastest {
                let quicker = over.clamp(1.0, MOST_QUICKER);
                pace.tempo *= quicker;
                pace.stride *= (speed / (brisk.max(speed) * quicker)).min(1.0);
                return pace;
            }
            brisk = (brisk + BRISKER_MPS).min(fastest);
        }
    }

    /// Returns the pace with its tempo raised so that steps last at most `most_secs`.
    pub(crate) fn within(&self, mut pace: Pace, most_secs: f64) -> Pace {
        pace.tempo = pace.tempo.max(self.unhurried_secs(pace) / most_secs);
        pace
    }

    /// Returns the pace with its tempo lowered so that steps last at least `least_secs`.
    pub(crate) fn lasting(&self, mut pace: Pace, least_secs: f64) -> Pace {
        pace.tempo = pace.tempo.min(self.unhurried_secs(pace) / least_secs);
        pace
    }

    /// Duration of a step of this pace at a tempo of 1, seconds.
    fn unhurried_secs(&self, pace: Pace) -> f64 {
        let speed = self
            .samples
            .iter()
            .find(|sample| sample[0] >= pace.covariate_mps);
        let [_, _, secs] = speed.copied().unwrap_or(self.samples[SAMPLES - 1]);
        secs
    }

    /// Returns the pace for a speed forwards, and the duration of its steps, seconds.
    fn pace_and_secs(&self, speed_mps: f64) -> (Pace, f64) {
        let (first, last) = (self.samples[0], self.samples[SAMPLES - 1]);
        let within = speed_mps.clamp(first[1], last[1]);
        let above = self.samples.iter().position(|sample| within <= sample[1]);
        let above = above.unwrap_or(SAMPLES - 1).max(1);
        let pair = &self.samples[above - 1..=above];
        let share = (within - pair[0][1]) / (pair[1][1] - pair[0][1]);
        let between = |column: usize| pair[0][column] + share * (pair[1][column] - pair[0][column]);
        let residual = (speed_mps / within.max(1e-3)).clamp(0.0, MAX_RESIDUAL);
        let (tempo, stride) = tempo_and_stride(residual);
        let pace = Pace {
            covariate_mps: between(0),
            tempo,
            stride,
        };
        (pace, between(2) / tempo)
    }
}

/// Returns the tempo and the stride that share a factor on the speed.
pub(crate) fn tempo_and_stride(factor: f64) -> (f64, f64) {
    let tempo = factor.sqrt().max(MIN_TEMPO);
    (tempo, factor / tempo)
}
