//! Seeded random curves over time without memory: every value follows from the walker, the curve and the time.

use crate::hash::mixed;

/// Number of knots that influence a value.
const SUPPORT: usize = 4;

/// Number of values that one call of the generator gives.
pub(crate) const AT_ONCE: usize = 4;

/// Mean over a knot's time of the squared weights of cubic B-splines, 151/315: what the variance of unit weights becomes.
const SPLINE_VARIANCE: f32 = 151.0 / 315.0;

/// Parallel curves of variance 1 at one time: cubic B-splines over independent values.
pub(crate) struct Curves {
    /// The first knot, and the knots' weights.
    knot: i64,
    weights: [f32; SUPPORT],
}

impl Curves {
    /// Evaluates the curves at a time, in knots.
    pub(crate) fn at(time: f64) -> Self {
        let knot = time.floor();
        let s = (time - knot) as f32;
        let scale = (SPLINE_VARIANCE.sqrt() * 6.0).recip();
        let (rest, s2, s3) = (1.0 - s, s * s, s * s * s);
        let weights = [
            rest * rest * rest,
            3.0 * s3 - 6.0 * s2 + 4.0,
            -3.0 * s3 + 3.0 * s2 + 3.0 * s + 1.0,
            s3,
        ];
        Self {
            knot: knot as i64,
            weights: weights.map(|weight| scale * weight),
        }
    }

    /// Returns the values of [`AT_ONCE`] curves, identified by `key`.
    pub(crate) fn values(&self, key: u64) -> [f32; AT_ONCE] {
        let mut sums = [0.0; AT_ONCE];
        for (weight, index) in self.weights.iter().zip(0_i64..) {
            let numbers = numbers(key, self.knot + index);
            for (sum, number) in sums.iter_mut().zip(numbers) {
                *sum += weight * number;
            }
        }
        sums
    }
}

/// Returns independent uniform values of variance 1.
pub(crate) fn numbers(key: u64, index: i64) -> [f32; AT_ONCE] {
    let width = 12.0_f32.sqrt();
    sixteens(mixed(key ^ mixed(index.cast_unsigned()))).map(|part| width * (part - 0.5))
}

/// Returns a nearly normal value of variance 1, at most 3.5 from 0.
pub(crate) fn normal(key: u64, index: i64) -> f32 {
    let numbers = numbers(key, index);
    0.5 * numbers.iter().sum::<f32>()
}

/// Returns a uniform value between 0 and 1.
pub(crate) fn share(key: u64, index: i64) -> f32 {
    sixteens(mixed(key ^ mixed(index.cast_unsigned())))[0]
}

/// Returns a key unique to a part of a walker's chance.
pub(crate) fn key(number: u64, part: u64) -> u64 {
    mixed(number ^ mixed(part))
}

fn sixteens(bits: u64) -> [f32; AT_ONCE] {
    core::array::from_fn(|part| (f32::from((bits >> (16 * part)) as u16) + 0.5) / 65536.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_smooth_and_have_variance_one() {
        let (mut squares, mut together, mut steepest) = (0.0, 0.0, 0.0_f32);
        let count = 200_000;
        let mut before = Curves::at(-0.01).values(7);
        for index in 0..count {
            let values = Curves::at(f64::from(index) * 0.01).values(7);
            squares += f64::from(values[0] * values[0]);
            together += f64::from(values[0] * values[1]);
            steepest = steepest.max((values[0] - before[0]).abs());
            before = values;
        }
        let count = f64::from(count);
        assert!((squares / count - 1.0).abs() < 0.06, "{}", squares / count);
        assert!((together / count).abs() < 0.06, "{}", together / count);
        assert!(steepest < 0.04, "{steepest}");
    }

    #[test]
    fn numbers_of_other_keys_and_moments_are_others() {
        let mut seen: Vec<u64> = (0..50)
            .flat_map(|part| (-50..50).map(move |index| (part, index)))
            .map(|(part, index)| u64::from(normal(key(3, part), index).to_bits()))
            .collect();
        seen.sort_unstable();
        seen.dedup();
        assert!(seen.len() > 4900, "{}", seen.len());
        assert_eq!(
            normal(key(3, 1), 5).to_bits(),
            normal(key(3, 1), 5).to_bits()
        );
    }
}
