//! Global variance against slow optimisation of its objective.

use crate::case::{BOTH, Case, normal_equations};
use crate::peer::jbonsai;
use footfall_prob::ProbError;
use footfall_prob::global_variance::{
    GlobalVarianceTarget, global_variance, hts_weight, temporal_moments,
};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, mlpg, mlpg_part};
use footfall_prob::windows::Windows;
use nalgebra::{DMatrix, DVector};

/// ω (rᵀc - ½ cᵀRc) - (v - μ)² / (2σ²): equation 15 without constants, and its gradient.
struct Objective {
    r: DMatrix<f64>,
    b: DVector<f64>,
    weight: f64,
    mean: f64,
    variance: f64,
}

impl Objective {
    fn new(problem: &MlpgProblem<'_, f64>, target: &GlobalVarianceTarget<'_>, d: usize) -> Self {
        let (r, b) = normal_equations(problem, d);
        Self {
            r,
            b,
            weight: target.trajectory_weight,
            mean: target.mean[d],
            variance: target.variance[d],
        }
    }

    fn value(&self, c: &DVector<f64>) -> f64 {
        let v = c.add_scalar(-c.mean()).norm_squared() / c.len() as f64;
        self.weight * (self.b.dot(c) - 0.5 * c.dot(&(&self.r * c)))
            - (v - self.mean).powi(2) / (2.0 * self.variance)
    }

    fn gradient(&self, c: &DVector<f64>) -> DVector<f64> {
        let centred = c.add_scalar(-c.mean());
        let n = c.len() as f64;
        let v = centred.norm_squared() / n;
        self.weight * (&self.b - &self.r * c)
            - centred * (2.0 * (v - self.mean) / (self.variance * n))
    }

    /// Slow and sure: dense Newton steps with a growing shift until the objective rises.
    fn climb(&self, mut c: DVector<f64>) -> DVector<f64> {
        let n = c.len();
        for _ in 0..500 {
            let centred = c.add_scalar(-c.mean());
            let v = centred.norm_squared() / n as f64;
            let kappa = 2.0 * (v - self.mean) / (self.variance * n as f64);
            let curvature = 4.0 / (self.variance * (n * n) as f64);
            let hessian = &self.r * self.weight
                + (DMatrix::identity(n, n).add_scalar(-1.0 / n as f64)) * kappa
                + &centred * centred.transpose() * curvature;
            let gradient = self.gradient(&c);
            let mut shift = 0.0;
            let mut rose = false;
            for _ in 0..60 {
                let shifted = &hessian + DMatrix::identity(n, n) * shift;
                if let Some(cholesky) = shifted.cholesky() {
                    let next = &c + cholesky.solve(&gradient);
                    if self.value(&next) > self.value(&c) {
                        c = next;
                        rose = true;
                        break;
                    }
                }
                shift = if shift == 0.0 {
                    1e-6 * self.weight * self.r.trace() / n as f64
                } else {
                    4.0 * shift
                };
            }
            if !rose {
                break;
            }
        }
        c
    }
}

fn column(trajectory: &[f64], dim: usize, d: usize) -> DVector<f64> {
    DVector::from_iterator(
        trajectory.len() / dim,
        trajectory.chunks(dim).map(|frame| frame[d]),
    )
}

#[test]
fn global_variance_finds_the_optimum() {
    for windows in BOTH {
        // Both more and less variance than the plain trajectory has.
        for factor in [0.5, 0.9, 1.0, 1.3, 2.0] {
            let dim = 4;
            let case = Case::new(70, 12, dim);
            let problem = case.problem(windows);
            let plain = case.solve(windows);
            let (means, variances) = temporal_moments(&plain, dim);
            let mean: Vec<f64> = variances.iter().map(|v| factor * v).collect();
            let variance: Vec<f64> = mean.iter().map(|m| (0.2 * m).powi(2)).collect();
            let target = GlobalVarianceTarget {
                mean: &mean,
                variance: &variance,
                trajectory_weight: hts_weight(70),
            };
            let mut found = vec![0.0; plain.len()];
            let fit = global_variance(&problem, &target, &mut found).expect("solvable");
            let (_, reached) = temporal_moments(&found, dim);
            let hts = jbonsai(&case.workload, windows, Some((&mean, &variance)));
            for d in 0..dim {
                let objective = Objective::new(&problem, &target, d);
                let c = column(&found, dim, d);
                let value = objective.value(&c);
                // Central differences of the objective itself, relative to a step of 1e-3 away from the optimum.
                let flat = objective.gradient(&c).norm();
                let off = objective.gradient(&c.map(|x| x * 1.001)).norm();
                assert!(
                    flat < 1e-5 * off,
                    "{windows:?} {factor} d {d}: {flat} {off}"
                );
                for t in (0..70).step_by(9) {
                    let mut moved = c.clone();
                    let slope = [1e-4, -1e-4].map(|step| {
                        moved[t] = c[t] + step;
                        assert!(objective.value(&moved) < value);
                        objective.value(&moved)
                    });
                    assert!(
                        (slope[0] - slope[1]).abs() / 2e-4 < 1e-4 * off.max(1.0),
                        "{slope:?}"
                    );
                }
                let rescale =
                    column(&plain, dim, d).map(|x| means[d] + (x - means[d]) * factor.sqrt());
                assert!(value >= objective.value(&rescale) - 1e-12 * value.abs());
                assert!(value >= objective.value(&column(&hts, dim, d)) - 1e-12 * value.abs());
                let climbed = objective.climb(rescale);
                assert!((value - objective.value(&climbed)).abs() < 1e-9 * value.abs().max(1.0));
                assert!(
                    (&c - &climbed).amax() < 1e-4,
                    "{} {factor}",
                    (&c - &climbed).amax()
                );
                assert!((reached[d] - fit.variance[d]).abs() < 1e-9);
                assert!((fit.towards[d] - c.mean()).abs() < 1e-9);
                let expected =
                    2.0 * (reached[d] - mean[d]) / (target.trajectory_weight * 70.0 * variance[d]);
                assert!((fit.strength[d] - expected).abs() < 1e-4 * (1.0 + expected.abs()));
            }
        }
    }
}

#[test]
fn a_high_weight_reaches_the_target_and_its_pull_reproduces_it() {
    let dim = 54;
    let case = Case::new(300, 50, dim);
    let (_, variances) = temporal_moments(&case.solve(Windows::Paper), dim);
    let mean: Vec<f64> = variances.iter().map(|v| 1.15 * v).collect();
    let variance: Vec<f64> = mean.iter().map(|m| (1e-3 * m).powi(2)).collect();
    let target = GlobalVarianceTarget {
        mean: &mean,
        variance: &variance,
        trajectory_weight: hts_weight(300),
    };
    for (windows, n_fixed) in [
        (Windows::Paper, 0),
        (Windows::Compact, 0),
        (Windows::Paper, 20),
    ] {
        let problem = MlpgProblem {
            n_fixed,
            ..case.problem(windows)
        };
        let mut found = case.solve(windows);
        let mut fit = global_variance(&problem, &target, &mut found).expect("solvable");
        for d in 0..dim {
            assert!(
                (fit.variance[d] / mean[d] - 1.0).abs() < 1e-2,
                "{} {}",
                fit.variance[d],
                mean[d]
            );
        }
        let mut again = found.clone();
        let pulled = MlpgProblem {
            pull: Some(fit.pull()),
            ..problem
        };
        mlpg(&pulled, &mut MlpgWorkspace::new(), &mut again).expect("solvable");
        for (a, b) in again.iter().zip(&found) {
            assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
        fit.limit(&case.precisions, 0.5).expect("fits");
        let least = |d: usize| {
            case.precisions
                .chunks(3 * dim)
                .map(|s| s[d])
                .fold(f64::INFINITY, f64::min)
        };
        assert!((0..dim).all(|d| fit.strength[d] >= -0.5 * least(d)));
    }
}

#[test]
fn the_first_dimensions_can_be_had_alone() {
    let case = Case::new(40, 6, 66);
    for windows in [Windows::Paper, Windows::Compact] {
        let problem = case.problem(windows);
        let whole = case.solve(windows);
        let mut part = vec![9.0; whole.len()];
        mlpg_part(&problem, 61, &mut MlpgWorkspace::new(), &mut part).expect("solvable");
        for (part, whole) in part.chunks(66).zip(whole.chunks(66)) {
            assert_eq!(part[..61], whole[..61]);
            // Eight at a time are solved; the last two need not be.
            assert_eq!(part[64..], [9.0; 2]);
        }
    }
}

#[test]
fn global_variance_of_what_cannot_vary() {
    let case = Case::new(1, 1, 2);
    let target = GlobalVarianceTarget {
        mean: &[1.0; 2],
        variance: &[1.0; 2],
        trajectory_weight: 1.0,
    };
    let mut found = vec![0.0; 2];
    let fit =
        global_variance(&case.problem(Windows::Paper), &target, &mut found).expect("solvable");
    assert_eq!(fit.strength, [0.0; 2]);
    assert_eq!(found, case.solve(Windows::Paper));
    // A flat line has no direction in which to vary: it stays, and stays finite.
    let flat = MlpgProblem {
        means: &[0.3, 0.0, 0.0],
        precisions: &[1.0, 2.0, 3.0],
        dim: 1,
        state_of_frame: &[0; 30],
        ..case.problem(Windows::Paper)
    };
    let target = GlobalVarianceTarget {
        mean: &[1.0],
        variance: &[1.0],
        trajectory_weight: 1.0,
    };
    let mut found = vec![0.0; 30];
    global_variance(&flat, &target, &mut found).expect("solvable");
    assert!(found.iter().all(|c| (c - 0.3).abs() < 1e-6), "{found:?}");
    let bad = GlobalVarianceTarget {
        mean: &[0.0],
        ..target
    };
    assert!(matches!(
        global_variance(&flat, &bad, &mut found),
        Err(ProbError::NotPositive { .. })
    ));
    let bad = GlobalVarianceTarget {
        variance: &[1.0; 2],
        ..target
    };
    assert!(matches!(
        global_variance(&flat, &bad, &mut found),
        Err(ProbError::Shape { .. })
    ));
}
