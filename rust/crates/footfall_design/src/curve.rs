//! Smooth curves through given points.

use core::f32::consts::TAU;
use footfall_core::ease::hermite;

/// A curve over the gait cycle, 0 to 1, that closes without a kink.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicCurve {
    points: Vec<(f32, f32)>,
}

impl PeriodicCurve {
    /// Through these points: phase in 0..1, rising, and value. At least one.
    pub(crate) fn new(points: Vec<(f32, f32)>) -> Self {
        Self { points }
    }

    /// The points: phase in cycles, and value.
    pub(crate) fn points(&self) -> &[(f32, f32)] {
        &self.points
    }

    /// The same curve with all values times `factor`.
    #[must_use]
    pub(crate) fn scaled(&self, factor: f32) -> Self {
        Self::new(self.points.iter().map(|(x, y)| (*x, y * factor)).collect())
    }

    /// The value at a phase in cycles, by cubic pieces with level tangents at local extremes.
    pub fn at(&self, phase: f32) -> f32 {
        let n = self.points.len().cast_signed();
        let phase = phase.rem_euclid(1.0);
        let point = |index: isize| {
            let (x, y) = self.points[index.rem_euclid(n).cast_unsigned()];
            (x + index.div_euclid(n) as f32, y)
        };
        let after = self
            .points
            .partition_point(|(x, _)| *x <= phase)
            .cast_signed();
        let [p0, p1, p2, p3] = [after - 2, after - 1, after, after + 1].map(point);
        let slope = |a: (f32, f32), b: (f32, f32)| (b.1 - a.1) / (b.0 - a.0).max(1e-6);
        let width = p2.0 - p1.0;
        let from = limited(slope(p0, p1), slope(p1, p2)) * width;
        let to = limited(slope(p1, p2), slope(p2, p3)) * width;
        hermite(p1.1, from, p2.1, to, (phase - p1.0) / width.max(1e-6))
    }
}

/// A rising function through points, smooth, and straight beyond its ends (Fritsch and Carlson 1980).
#[derive(Clone, Debug)]
pub(crate) struct Monotone {
    points: Vec<(f64, f64)>,
    slopes: Vec<f64>,
}

impl Monotone {
    /// Through at least two points whose x and y both rise.
    pub(crate) fn new(points: Vec<(f64, f64)>) -> Self {
        let secants: Vec<f64> = points
            .windows(2)
            .map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0).max(1e-9))
            .collect();
        let slopes = (0..points.len())
            .map(|n| {
                match (
                    n.checked_sub(1).and_then(|n| secants.get(n)),
                    secants.get(n),
                ) {
                    // The harmonic mean keeps the curve rising.
                    (Some(before), Some(after)) => {
                        2.0 * before * after / (before + after).max(1e-12)
                    }
                    (Some(only), None) | (None, Some(only)) => *only,
                    (None, None) => 1.0,
                }
            })
            .collect();
        Self { points, slopes }
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        let last = self.points.len() - 1;
        let index = self.points.partition_point(|point| point.0 <= x);
        if index == 0 {
            return self.points[0].1 + self.slopes[0] * (x - self.points[0].0);
        }
        if index > last {
            return self.points[last].1 + self.slopes[last] * (x - self.points[last].0);
        }
        let (from, to) = (self.points[index - 1], self.points[index]);
        let width = to.0 - from.0;
        let s = (x - from.0) / width;
        let (s2, s3) = (s * s, s * s * s);
        from.1 * (2.0 * s3 - 3.0 * s2 + 1.0)
            + self.slopes[index - 1] * width * (s3 - 2.0 * s2 + s)
            + to.1 * (3.0 * s2 - 2.0 * s3)
            + self.slopes[index] * width * (s3 - s2)
    }
}

/// A tangent between two slopes: level where they differ in sign, so that nothing overshoots.
fn limited(before: f32, after: f32) -> f32 {
    if before * after <= 0.0 {
        0.0
    } else {
        2.0 * before * after / (before + after)
    }
}

/// +1 in the middle of the left foot's stance, -1 in the middle of the right one's, for a phase in strides since the left
/// foot landed.
pub(crate) fn stance_wave(phase: f32) -> f32 {
    ((phase - 0.3) * TAU).cos()
}

/// Weighted mean over neighbours, Gaussian, `sigma` in frames. The ends go on as their own point mirror image, so a steady
/// trend is kept to the last frame.
pub(crate) fn smoothed<T>(values: &[T], sigma: f32) -> Vec<T>
where
    T: Copy
        + core::ops::Mul<f32, Output = T>
        + core::ops::Add<Output = T>
        + core::ops::Sub<Output = T>,
{
    let radius = (3.0 * sigma).ceil() as isize;
    let last = values.len().cast_signed() - 1;
    if radius < 1 || last < 1 {
        return values.to_vec();
    }
    let at = |index: isize| {
        if index < 0 {
            values[0] * 2.0 - values[(-index).min(last) as usize]
        } else if index > last {
            values[last as usize] * 2.0 - values[(2 * last - index).max(0) as usize]
        } else {
            values[index as usize]
        }
    };
    let weight = |offset: isize| (-0.5 * (offset as f32 / sigma).powi(2)).exp();
    let total: f32 = (-radius..=radius).map(weight).sum();
    (0..=last)
        .map(|center| {
            let mut sum = at(center) * (1.0 / total);
            for offset in (-radius..=radius).filter(|offset| *offset != 0) {
                sum = sum + at(center + offset) * (weight(offset) / total);
            }
            sum
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_periodic_curve_meets_its_points_and_closes() {
        let curve = PeriodicCurve::new(vec![(0.1, 5.0), (0.5, -5.0), (0.8, 0.0)]);
        for (x, y) in [
            (0.1, 5.0),
            (0.5, -5.0),
            (0.8, 0.0),
            (1.1, 5.0),
            (-0.5, -5.0),
        ] {
            assert!((curve.at(x) - y).abs() < 1e-4);
        }
        let mut previous = curve.at(-0.001);
        for n in 0..=1000 {
            let value = curve.at(n as f32 * 0.001);
            assert!((value - previous).abs() < 0.1 && value.abs() < 5.001);
            previous = value;
        }
    }

    #[test]
    fn a_monotone_curve_rises_and_goes_on_straight() {
        let curve = Monotone::new(vec![(0.0, 0.0), (1.0, 4.0), (3.0, 5.0), (4.0, 9.0)]);
        assert!((curve.at(3.0) - 5.0).abs() < 1e-9 && (curve.at(-1.0) + 4.0).abs() < 1e-9);
        let values: Vec<f64> = (-20..100).map(|n| curve.at(f64::from(n) * 0.05)).collect();
        assert!(values.windows(2).all(|pair| pair[1] > pair[0]));
    }

    #[test]
    fn smoothing_keeps_a_trend() {
        let line: Vec<f32> = (0..50).map(|n| n as f32).collect();
        for (n, value) in smoothed(&line, 6.0).into_iter().enumerate() {
            assert!((value - n as f32).abs() < 1e-3);
        }
    }
}
