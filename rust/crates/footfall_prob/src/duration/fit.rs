//! The M-step of durations: the exact maximum-likelihood Gaussian on 1..=max.
//!
//! On a finite support the best parameters are not the plain moments, and with them the likelihood
//! could fall. As an exponential family, p(d) ∝ exp(η₁ d + η₂ d²), the log-likelihood is concave,
//! so a safeguarded Newton iteration finds the maximum. A segment that was already running at the
//! start of the recording is drawn with probability ∝ d p(d): it has its own normaliser, also log-convex.

use super::GaussianDuration;
use crate::error::{ProbError, check_positive};

/// Expected durations, weighted: the sufficient statistics of a [`GaussianDuration`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DurationStats {
    weight: f64,
    length_biased_weight: f64,
    sum: f64,
    sum_squares: f64,
}

impl DurationStats {
    /// Empty statistics.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a segment of `duration` frames with a weight.
    pub fn add(&mut self, duration: usize, weight: f64) {
        self.weight += weight;
        self.add_moments(duration, weight);
    }

    /// Adds a segment that was running when the recording started, given its whole duration. Such
    /// segments are longer than usual, which the estimate takes into account.
    pub fn add_length_biased(&mut self, duration: usize, weight: f64) {
        self.length_biased_weight += weight;
        self.add_moments(duration, weight);
    }

    fn add_moments(&mut self, duration: usize, weight: f64) {
        let duration = duration as f64;
        self.sum += weight * duration;
        self.sum_squares += weight * duration * duration;
    }

    /// Adds what `other` has seen.
    pub fn merge(&mut self, other: &Self) {
        self.weight += other.weight;
        self.length_biased_weight += other.length_biased_weight;
        self.sum += other.sum;
        self.sum_squares += other.sum_squares;
    }

    /// Sum of all weights: how many segments were seen, in expectation.
    pub fn weight(&self) -> f64 {
        self.weight + self.length_biased_weight
    }

    /// The parameters that make the durations most likely on 1..=`max_duration`, with a variance of
    /// at least `variance_floor` (frames²).
    ///
    /// # Errors
    /// [`ProbError`] when nothing was added, `max_duration` is zero or the floor is not above zero.
    pub fn estimate(
        &self,
        max_duration: usize,
        variance_floor: f64,
    ) -> Result<GaussianDuration, ProbError> {
        check_positive("duration variance floor", &[variance_floor])?;
        let weight = self.weight();
        if weight.is_nan() || weight <= 0.0 {
            return Err(ProbError::NoData { what: "a duration" });
        }
        if max_duration == 0 {
            return Err(ProbError::Empty {
                what: "duration table",
            });
        }
        let problem = Problem {
            biased_share: self.length_biased_weight / weight,
            // Moments about the middle of the support: better conditioned than about zero.
            origin: 0.5 * (max_duration as f64 + 1.0),
            scale: max_duration as f64,
            max_duration,
            first: 0.0,
            second: 0.0,
        };
        let mean = self.sum / weight;
        let square = self.sum_squares / weight;
        let first = (mean - problem.origin) / problem.scale;
        let second =
            (square - 2.0 * problem.origin * mean + problem.origin.powi(2)) / problem.scale.powi(2);
        Ok(Problem {
            first,
            second,
            ..problem
        }
        .solve(
            (square - mean * mean).max(variance_floor),
            mean,
            variance_floor,
        ))
    }
}

/// Maximise η·s - (1-b) ln Σ exp(η·s(d)) - b ln Σ d exp(η·s(d)), with s(d) = (x, x²) and
/// x = (d - origin) / scale, over η₁ and the variance -scale² / (2 η₂) in floor..=widest.
struct Problem {
    biased_share: f64,
    origin: f64,
    scale: f64,
    max_duration: usize,
    first: f64,
    second: f64,
}

/// Value, gradient and the three entries of the negated Hessian.
struct Expansion {
    value: f64,
    gradient: [f64; 2],
    curvature: [f64; 3],
}

impl Problem {
    fn solve(&self, start_variance: f64, start_mean: f64, variance_floor: f64) -> GaussianDuration {
        // Beyond this a Gaussian is flat on the support to 1e-3: a wider one says nothing more.
        let widest = (30.0 * self.scale * self.scale).max(variance_floor);
        let quadratic = |variance: f64| -0.5 * self.scale * self.scale / variance;
        let (low, high) = (quadratic(variance_floor), quadratic(widest));
        let start_quadratic = quadratic(start_variance.clamp(variance_floor, widest));
        let start_x = (start_mean - self.origin) / self.scale;
        let mut eta = [-2.0 * start_quadratic * start_x, start_quadratic];
        let mut at = self.expand(eta);
        for _ in 0..200 {
            let [a, b, c] = at.curvature;
            let [g, h] = at.gradient;
            // On a bound with the gradient pointing outwards, only η₁ may move.
            let pinned = (eta[1] <= low && h <= 0.0) || (eta[1] >= high && h >= 0.0);
            let ridge = 1e-14 * (a + c) + f64::MIN_POSITIVE;
            let determinant = (a + ridge) * (c + ridge) - b * b;
            let step = if pinned || determinant <= 0.0 {
                [g / (a + ridge), 0.0]
            } else {
                [
                    ((c + ridge) * g - b * h) / determinant,
                    ((a + ridge) * h - b * g) / determinant,
                ]
            };
            let slope = if pinned {
                step[0] * g
            } else {
                step[0] * g + step[1] * h
            };
            if slope.abs() < 1e-26 {
                break;
            }
            let mut fraction = 1.0;
            let mut moved = false;
            while fraction > 1e-9 {
                let mut candidate = [eta[0] + fraction * step[0], eta[1] + fraction * step[1]];
                let clamped = candidate[1].clamp(low, high);
                if (clamped - candidate[1]).abs() > 0.0 {
                    // Keep the centre where the step put it, or the bound would drag it along.
                    candidate[0] *= clamped / candidate[1];
                    candidate[1] = clamped;
                }
                let next = self.expand(candidate);
                if next.value > at.value {
                    eta = candidate;
                    at = next;
                    moved = true;
                    break;
                }
                fraction *= 0.5;
            }
            if !moved {
                break;
            }
        }
        let variance = -0.5 * self.scale * self.scale / eta[1];
        GaussianDuration {
            mean: self.origin - 0.5 * self.scale * eta[0] / eta[1],
            variance: variance.clamp(variance_floor, widest),
        }
    }

    fn expand(&self, eta: [f64; 2]) -> Expansion {
        let mut out = Expansion {
            value: eta[0] * self.first + eta[1] * self.second,
            gradient: [self.first, self.second],
            curvature: [0.0; 3],
        };
        for (share, biased) in [(1.0 - self.biased_share, false), (self.biased_share, true)] {
            if share <= 0.0 {
                continue;
            }
            let exponent = |d: usize| {
                let x = (d as f64 - self.origin) / self.scale;
                let bias = if biased { (d as f64).ln() } else { 0.0 };
                (x, eta[0] * x + eta[1] * x * x + bias)
            };
            let max = (1..=self.max_duration)
                .map(|d| exponent(d).1)
                .fold(f64::NEG_INFINITY, f64::max);
            let mut moments = [0.0; 5];
            for d in 1..=self.max_duration {
                let (x, log_weight) = exponent(d);
                let mut term = (log_weight - max).exp();
                for moment in &mut moments {
                    *moment += term;
                    term *= x;
                }
            }
            let [m1, m2, m3, m4] = [1, 2, 3, 4].map(|i| moments[i] / moments[0]);
            out.value -= share * (max + moments[0].ln());
            out.gradient[0] -= share * m1;
            out.gradient[1] -= share * m2;
            out.curvature[0] += share * (m2 - m1 * m1);
            out.curvature[1] += share * (m3 - m1 * m2);
            out.curvature[2] += share * (m4 - m2 * m2);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::duration::DurationDist;

    fn expected_stats(dist: &DurationDist, biased: bool) -> DurationStats {
        let mut stats = DurationStats::new();
        for d in 1..=dist.max_duration() {
            let p = dist.log_pmf(d).exp();
            if biased {
                stats.add_length_biased(d, p * d as f64 / dist.mean());
            } else {
                stats.add(d, p);
            }
        }
        stats
    }

    #[test]
    fn recovers_the_parameters_even_when_cut_hard() {
        for (mean, variance, max) in [
            (12.0, 9.0, 40),
            (1.5, 4.0, 20),
            (18.0, 30.0, 20),
            (6.0, 0.3, 12),
            (25.0, 60.0, 60),
        ] {
            let dist = GaussianDuration { mean, variance }.discretise(max).unwrap();
            let mut both = expected_stats(&dist, true);
            both.merge(&expected_stats(&dist, false));
            for stats in [
                expected_stats(&dist, false),
                expected_stats(&dist, true),
                both,
            ] {
                let found = stats.estimate(max, 1e-3).unwrap();
                assert!(
                    (found.mean - mean).abs() < 1e-4 && (found.variance - variance).abs() < 1e-3,
                    "{mean} {variance} {max}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn is_the_maximum() {
        // Counts that no Gaussian produces: nothing nearby may be likelier.
        let counts = [3.0, 0.0, 5.0, 1.0, 0.5, 0.0, 2.0];
        let mut stats = DurationStats::new();
        (1..).zip(counts).for_each(|(d, w)| stats.add(d, w));
        let likelihood = |g: GaussianDuration| {
            let dist = g.discretise(7).unwrap();
            (1..)
                .zip(counts)
                .map(|(d, w)| w * dist.log_pmf(d))
                .sum::<f64>()
        };
        let best = stats.estimate(7, 0.01).unwrap();
        for (dm, dv) in [(1e-2, 0.0), (-1e-2, 0.0), (0.0, 1e-2), (0.0, -1e-2)] {
            let near = GaussianDuration {
                mean: best.mean + dm,
                variance: best.variance * (1.0 + dv),
            };
            assert!(likelihood(near) < likelihood(best));
        }
    }

    #[test]
    fn bounds_hold() {
        let mut stats = DurationStats::new();
        stats.add(5, 3.0);
        let found = stats.estimate(20, 0.5).unwrap();
        assert!(
            (found.variance - 0.5).abs() < 1e-12 && (found.mean - 5.0).abs() < 1e-3,
            "{found:?}"
        );
        let mut flat = DurationStats::new();
        flat.add(1, 1.0);
        flat.add(20, 1.0);
        let found = flat.estimate(20, 0.5).unwrap();
        assert!(
            found.variance.is_finite()
                && (found.discretise(20).unwrap().mean() - 10.5).abs() < 1e-6,
            "{found:?}"
        );
        assert!(matches!(
            DurationStats::new().estimate(5, 1.0),
            Err(ProbError::NoData { .. })
        ));
    }
}
