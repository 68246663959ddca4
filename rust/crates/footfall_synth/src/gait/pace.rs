//! Conversion of a requested speed to a pace of the model, by a table of measured paces.

use super::direction::overstep;
use glam::Vec2;

/// Number of paces that are measured.
pub(crate) const SAMPLES: usize = 7;

/// Largest factor by which tempo and stride together exceed what was measured.
const MAX_RESIDUAL: f64 = 1.6;

/// Least factor on the tempo: slower walks take shorter strides instead.
const MIN_TEMPO: f64 = 0.8;

/// Factor on the tempo of the briskest walk at which steps to the side and backwards are taken at most.
const MOST_QUICKER: f64 = 1.9;

/// Tolerance of the search for a walk whose steps are quick enough, m/s.
const BRISKER_MPS: f64 = 0.05;

/// Pace of a step: the result of the speed response and the limits of the model for a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Place on the model's speed response, m/s.
    pub(crate) covariate_mps: f64,
    /// Factor on the rate at which states pass.
    pub(crate) tempo: f64,
    /// Factor on the legs' reach forwards and backwards.
    pub(crate) stride: f64,
}

/// Speeds of one walker at the paces of the model.
#[derive(Clone, Debug)]
pub(crate) struct PaceTable {
    /// Covariate and realised speed, both rising, m/s, and how long a step lasts, seconds.
    samples: [[f64; 3]; SAMPLES],
    leg_length: f32,
    /// Heading under which the walk goes along +Z, radians.
    pub(crate) facing: f32,
}

impl PaceTable {
    /// A table of measured samples: covariate and realised speed, m/s, and how long a step lasts, seconds.
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

    /// The pace that gives a speed forwards. Beyond the measured range tempo and stride share what is missing.
    pub(crate) fn pace(&self, speed_mps: f64) -> Pace {
        self.pace_and_secs(speed_mps).0
    }

    /// The pace that gives a velocity to the left and forwards. Where its steps would be too long, they are shorter ones of a brisker walk,
    /// or of a quicker one still.
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

    /// The same pace with a tempo at which its steps last so long at most, seconds.
    pub(crate) fn within(&self, mut pace: Pace, most_secs: f64) -> Pace {
        let speed = self
            .samples
            .iter()
            .find(|sample| sample[0] >= pace.covariate_mps);
        let [_, _, secs] = speed.copied().unwrap_or(self.samples[SAMPLES - 1]);
        pace.tempo = pace.tempo.max(secs / most_secs);
        pace
    }

    /// The pace that gives a speed forwards, and how long its steps last.
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

/// Tempo and stride that share a factor on the speed.
pub(crate) fn tempo_and_stride(factor: f64) -> (f64, f64) {
    let tempo = factor.sqrt().max(MIN_TEMPO);
    (tempo, factor / tempo)
}
