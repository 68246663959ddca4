//! The loops over all frames of a model, in forms that compilers turn into vector instructions.

use multiversion::multiversion;

/// Adds a weighted row.
pub(crate) fn add(weight: f32, row: &[f32], out: &mut [f32]) {
    for (out, value) in out.iter_mut().zip(row) {
        *out += weight * value;
    }
}

/// Frames that are looked at side by side.
pub(crate) const BLOCK: usize = 8;

/// Weighted square of the distance of each frame from a measurement; returns the least.
///
/// `rows` holds, for each block of frames, the first of `columns` numbers of all its frames, then the second; those beyond the measured ones do not count. A block in which no value exceeds `limit` is passed
/// over: its distances are infinite.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2+fma", "aarch64+neon"))]
pub(crate) fn distances(
    rows: &[f32],
    columns: usize,
    [measured, weights]: [&[f32]; 2],
    values: &[f32],
    limit: f32,
    out: &mut [f32],
) -> f32 {
    let mut nearest = [f32::INFINITY; BLOCK];
    let blocks = rows.chunks_exact(BLOCK * columns);
    let blocks = blocks.zip(values.chunks_exact(BLOCK));
    for (out, (rows, values)) in out.chunks_exact_mut(BLOCK).zip(blocks) {
        let mut any = false;
        for value in values {
            any |= *value > limit;
        }
        if !any {
            out.fill(f32::INFINITY);
            continue;
        }
        let mut sums = [0.0; BLOCK];
        let numbers = measured.iter().zip(weights);
        for (row, (measured, weight)) in rows.chunks_exact(BLOCK).zip(numbers) {
            for lane in 0..BLOCK {
                let apart = row[lane] - measured;
                sums[lane] += weight * apart * apart;
            }
        }
        out.copy_from_slice(&sums);
        for lane in 0..BLOCK {
            nearest[lane] = if sums[lane] < nearest[lane] {
                sums[lane]
            } else {
                nearest[lane]
            };
        }
    }
    nearest.into_iter().fold(f32::INFINITY, f32::min)
}

/// `out = values * e^(scale * (distance - nearest))`; returns the sum. `scale` must be negative. No distance counts as farther than `farthest`; where it is infinite, nothing is left.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2+fma", "aarch64+neon"))]
pub(crate) fn weigh(
    values: &[f32],
    distance: &[f32],
    scale: f32,
    [nearest, farthest]: [f32; 2],
    out: &mut [f32],
) -> f32 {
    let mut sums = [0.0; BLOCK];
    let blocks = values.chunks_exact(BLOCK).zip(distance.chunks_exact(BLOCK));
    for (out, (values, distance)) in out.chunks_exact_mut(BLOCK).zip(blocks) {
        if distance[0] == f32::INFINITY {
            out.fill(0.0);
            continue;
        }
        for lane in 0..BLOCK {
            let distance = if distance[lane] < farthest {
                distance[lane]
            } else {
                farthest
            };
            out[lane] = values[lane] * exp_below(scale * (distance - nearest));
            sums[lane] += out[lane];
        }
    }
    sums.into_iter().sum()
}

/// Multiplies all.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2+fma", "aarch64+neon"))]
pub(crate) fn scale(values: &mut [f32], factor: f32) {
    for value in values {
        *value *= factor;
    }
}

/// e^x for x up to 0, to within 0.004 %; what is less than e^-60 is e^-60.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "only what is inlined into the dispatched function is compiled for its instruction set"
)]
fn exp_below(x: f32) -> f32 {
    let power = if x < -60.0 { -60.0 } else { x } * core::f32::consts::LOG2_E;
    // The whole part goes into the exponent's bits; rounding towards zero leaves a rest in (-1, 0].
    let whole = power as i32;
    let rest = (power - whole as f32) * core::f32::consts::LN_2;
    let horner = [
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ];
    let series = horner.into_iter().fold(0.0, |sum, term| sum * rest + term);
    f32::from_bits(((whole + 127) as u32) << 23) * series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_each_frame() {
        // Two blocks of frames with three numbers each; the second block holds nothing.
        let number = |frame: usize, n: usize| (frame * 3 + n) as f32 * 0.1;
        let mut rows = Vec::new();
        for block in 0..2 {
            for n in 0..3 {
                rows.extend((0..BLOCK).map(|lane| number(block * BLOCK + lane, n)));
            }
        }
        let (measured, weights) = ([0.3, 0.1, 0.9], [1.0, 2.0, 0.5]);
        let values: Vec<f32> = (0..2 * BLOCK)
            .map(|n| f32::from(u8::from(n < BLOCK)))
            .collect();
        let mut out = vec![0.0; 2 * BLOCK];
        let nearest = distances(&rows, 3, [&measured, &weights], &values, 0.5, &mut out);
        for frame in 0..BLOCK {
            let terms = (0..3).map(|n| weights[n] * (number(frame, n) - measured[n]).powi(2));
            let exact: f32 = terms.sum();
            assert!(
                (out[frame] - exact).abs() < 1e-5,
                "{} is not {exact}",
                out[frame]
            );
            assert!(nearest <= out[frame]);
        }
        assert!(out[BLOCK..].iter().all(|distance| distance.is_infinite()));
        let all = out.clone();
        distances(&rows, 3, [&measured[..2], &weights], &values, 0.5, &mut out);
        for frame in 0..BLOCK {
            let third = weights[2] * (number(frame, 2) - measured[2]).powi(2);
            assert!((all[frame] - out[frame] - third).abs() < 1e-5);
        }
    }

    #[test]
    fn weights_are_exponentials() {
        let distance: Vec<f32> = (0..96).map(|n| n as f32 * 0.9).collect();
        let values = vec![0.5; 96];
        let mut out = vec![0.0; 96];
        let sum = weigh(&values, &distance, -0.5, [0.0, 70.0], &mut out);
        assert!((sum - out.iter().sum::<f32>()).abs() < 1e-4);
        for (out, distance) in out.iter().zip(&distance) {
            let exact = 0.5 * (-0.5 * distance.min(70.0)).exp();
            assert!((out / exact - 1.0).abs() < 4e-5, "{out} is not {exact}");
        }
        assert!(exp_below(-1e30) > 0.0 && exp_below(-1e30) < 1e-25);
    }
}
