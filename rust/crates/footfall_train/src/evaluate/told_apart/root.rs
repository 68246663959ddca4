//! Surge, limp and bob: harmonics of the hips within a stride.

use super::swings::{PHASES, StrideSwings};
use core::f64::consts::TAU;

/// Harmonics of a stride that are taken together as surge.
const HIGHEST: usize = 8;

/// Mean amplitudes over strides, half peak to peak: of the stride's own frequency, of the step's, and of the third to eighth harmonic
/// together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RootHarmonics {
    /// Amplitudes of the hips' velocity along the stride, m/s. The first is a limp, the last a surge.
    pub speed_mps: [f64; 3],
    /// Amplitudes of the hips' height, metres. The second is the bob.
    pub height_m: [f64; 3],
}

impl RootHarmonics {
    /// Means over strides.
    pub fn of<'a>(strides: impl Iterator<Item = &'a StrideSwings>) -> Self {
        let (mut mean, mut count) = (Self::default(), 0.0);
        for stride in strides {
            let series = |axis: usize| -> Vec<f64> {
                let frames = stride.root.iter();
                frames.map(|root| f64::from(root[axis])).collect()
            };
            for (sum, axis) in [(&mut mean.speed_mps, 0), (&mut mean.height_m, 1)] {
                for (sum, amplitude) in sum.iter_mut().zip(amplitudes(&series(axis))) {
                    *sum += amplitude;
                }
            }
            count += 1.0;
        }
        if count > 0.0 {
            for value in mean.speed_mps.iter_mut().chain(&mut mean.height_m) {
                *value /= count;
            }
        }
        mean
    }
}

/// Amplitudes of a closed cycle; its drift from one end to the other is taken out first.
fn amplitudes(values: &[f64]) -> [f64; 3] {
    let count = values.len();
    let drift = (values[count - 1] - values[0]) / (count - 1) as f64;
    let level: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(n, value)| value - drift * n as f64)
        .collect();
    let of = |harmonics: core::ops::RangeInclusive<usize>| {
        let mut wave = vec![0.0; PHASES];
        for harmonic in harmonics {
            let turn = |n: usize| TAU * (harmonic * n) as f64 / count as f64;
            let sum = |by: fn(f64) -> f64| -> f64 {
                let terms = level.iter().enumerate();
                terms.map(|(n, value)| value * by(turn(n))).sum::<f64>() * 2.0 / count as f64
            };
            let (cosine, sine) = (sum(f64::cos), sum(f64::sin));
            for (n, value) in wave.iter_mut().enumerate() {
                *value += cosine * turn(n).cos() + sine * turn(n).sin();
            }
        }
        let (low, high) = wave
            .iter()
            .fold((f64::MAX, f64::MIN), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
        0.5 * (high - low)
    };
    [of(1..=1), of(2..=2), of(3..=HIGHEST)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amplitudes_of_a_known_sum() {
        let wave = |n: usize| {
            let phase = TAU * n as f64 / PHASES as f64;
            1.3 + 0.02 * phase.sin() + 0.15 * (2.0 * phase + 0.4).cos() + 0.05 * (4.0 * phase).cos()
        };
        let values: Vec<f64> = (0..PHASES).map(wave).collect();
        let found = amplitudes(&values);
        for (found, expected) in found.into_iter().zip([0.02, 0.15, 0.05]) {
            assert!(
                (found - expected).abs() < 0.008,
                "{found} is not {expected}"
            );
        }
    }
}
