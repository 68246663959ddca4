//! Smoothing without delay, means over windows, and the axis of most rotation.

use core::ops::Range;
use glam::{Mat3, Vec3};

/// A second-order Butterworth low-pass, run forwards and backwards: no delay, and the ends held.
pub fn low_pass(values: &[Vec3], rate_hz: f64, cut_off_hz: f64) -> Vec<Vec3> {
    if values.len() < 2 || cut_off_hz >= 0.45 * rate_hz {
        return values.to_vec();
    }
    let k = (core::f64::consts::PI * cut_off_hz / rate_hz).tan();
    let norm = 1.0 / (1.0 + core::f64::consts::SQRT_2 * k + k * k);
    let gain = (k * k * norm) as f32;
    let feedback = [
        (2.0 * (k * k - 1.0) * norm) as f32,
        ((1.0 - core::f64::consts::SQRT_2 * k + k * k) * norm) as f32,
    ];
    let mut smooth = values.to_vec();
    for _ in 0..2 {
        // At rest at the first value: a constant passes unchanged.
        let (mut inputs, mut outputs) = ([smooth[0]; 2], [smooth[0]; 2]);
        for value in &mut smooth {
            let input = *value;
            let output = (input + inputs[0] * 2.0 + inputs[1]) * gain
                - outputs[0] * feedback[0]
                - outputs[1] * feedback[1];
            inputs = [input, inputs[0]];
            outputs = [output, outputs[0]];
            *value = output;
        }
        smooth.reverse();
    }
    smooth
}

/// Moving average over `reach` values on both sides; at the ends over the existing ones.
pub(crate) fn means_around(values: &[f32], reach: usize) -> Vec<f32> {
    let around = |n: usize| {
        let window = &values[n.saturating_sub(reach)..(n + reach + 1).min(values.len())];
        window.iter().sum::<f32>() / window.len() as f32
    };
    (0..values.len()).map(around).collect()
}

/// Samples of a time, one at least.
pub(crate) fn frames_of(secs: f64, rate_hz: f64) -> usize {
    ((secs * rate_hz).round() as usize).max(1)
}

/// The sample of the largest value; the first of the range where it is empty.
pub(crate) fn strongest(values: &[f32], range: Range<usize>) -> usize {
    let first = range.start;
    (first..range.end.min(values.len()))
        .max_by(|a, b| values[*a].total_cmp(&values[*b]))
        .unwrap_or(first)
}

/// The axis along which vectors are longest, sum of squares: the first eigenvector of their second moments, by powers.
pub(crate) fn principal_axis<'a>(vectors: impl Iterator<Item = &'a Vec3>) -> Vec3 {
    let mut moments = Mat3::ZERO;
    for vector in vectors {
        moments += Mat3::from_cols(*vector * vector.x, *vector * vector.y, *vector * vector.z);
    }
    let mut power = moments;
    for _ in 0..12 {
        let size = power
            .to_cols_array()
            .into_iter()
            .map(f32::abs)
            .fold(0.0, f32::max);
        if size <= 0.0 {
            return Vec3::X;
        }
        power *= 1.0 / size;
        power *= power;
    }
    let columns = [power.x_axis, power.y_axis, power.z_axis];
    let longest = columns
        .into_iter()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    longest.unwrap_or(Vec3::X).normalize_or(Vec3::X)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_passes_without_delay_and_fast_does_not() {
        let wave = |hz: f32| -> Vec<Vec3> {
            (0..400)
                .map(|n| Vec3::X * (n as f32 * 0.01 * core::f32::consts::TAU * hz).sin())
                .collect()
        };
        let (slow, fast) = (wave(1.0), wave(40.0));
        let passed = low_pass(&slow, 100.0, 12.0);
        let apart = slow[50..350].iter().zip(&passed[50..350]);
        assert!(apart.clone().all(|(a, b)| a.distance(*b) < 0.01));
        let stopped = low_pass(&fast, 100.0, 12.0);
        assert!(stopped[50..350].iter().all(|value| value.length() < 0.02));
    }

    #[test]
    fn the_principal_axis_is_that_of_most_motion() {
        let axis = Vec3::new(0.6, -0.48, 0.64);
        let vectors: Vec<Vec3> = (0..100)
            .map(|n| {
                axis * (n as f32 * 0.7).sin() * 3.0 + Vec3::new((n as f32).cos(), 0.3, 0.1) * 0.3
            })
            .collect();
        assert!(principal_axis(vectors.iter()).dot(axis).abs() > 0.99);
        assert_eq!(principal_axis([].iter()), Vec3::X);
    }
}
