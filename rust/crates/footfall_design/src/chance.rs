//! Chance that repeats exactly: the same seed, the same walk.

use core::f32::consts::TAU;

/// A number that looks drawn from the standard normal distribution, fixed by seed, stream and index.
pub(crate) fn normal(seed: u64, stream: u64, index: u64) -> f32 {
    let first = hash(seed ^ hash(stream ^ hash(index)));
    let second = hash(first);
    let unit = |bits: u64| ((bits >> 40) as f32 + 0.5) / (1_u64 << 24) as f32;
    // Clipped: one step in a thousand must not tear the legs apart.
    ((-2.0 * unit(first).ln()).sqrt() * (TAU * unit(second)).cos()).clamp(-2.5, 2.5)
}

/// The same as a smooth function of time, with a new draw each unit of it.
pub(crate) fn drift(seed: u64, stream: u64, time: f32) -> f32 {
    let base = time.floor();
    let s = time - base;
    // A cubic B-spline over draws is smooth to its second derivative; its variance is brought back to about one.
    let weights = [
        (1.0 - s).powi(3),
        3.0 * s.powi(3) - 6.0 * s * s + 4.0,
        -3.0 * s.powi(3) + 3.0 * s * s + 3.0 * s + 1.0,
        s.powi(3),
    ];
    let sum: f32 = weights
        .iter()
        .enumerate()
        .map(|(n, weight)| {
            weight / 6.0
                * normal(
                    seed,
                    stream,
                    (base as i64)
                        .wrapping_add_unsigned(n as u64)
                        .cast_unsigned(),
                )
        })
        .sum();
    sum * 1.45
}

/// `SplitMix64` (Steele et al. 2014).
const fn hash(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_standard_and_drift_is_smooth() {
        let draws: Vec<f32> = (0..4000).map(|n| normal(7, 1, n)).collect();
        let mean = draws.iter().sum::<f32>() / 4000.0;
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f32>() / 4000.0;
        assert!(
            mean.abs() < 0.06 && (variance - 1.0).abs() < 0.1,
            "{mean} {variance}"
        );
        let path: Vec<f32> = (0..40_000).map(|n| drift(7, 2, n as f32 * 0.01)).collect();
        let variance = path.iter().map(|x| x * x).sum::<f32>() / 40_000.0;
        assert!((variance - 1.0).abs() < 0.25, "{variance}");
        let bend = |w: &[f32]| (w[0] - 2.0 * w[1] + w[2]).abs();
        assert!(path.windows(3).all(|w| bend(w) < 2e-3));
    }
}
