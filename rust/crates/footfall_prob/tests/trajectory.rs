//! Trajectory generation against dense linear algebra, jbonsai and slow optimisation.

use footfall_prob::ProbError;
use footfall_prob::global_variance::{
    GlobalVarianceTarget, global_variance, hts_weight, temporal_moments,
};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Pull, mlpg, mlpg_part};
use footfall_prob::windows::Windows;
use footfall_prob::workload::MlpgWorkload;
use jbonsai::mlpg_adjust::MlpgAdjust;
use jbonsai::model::voice::window::Window;
use jbonsai::model::{MeanVari, ModelStream, StreamParameter};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

const BOTH: [Windows; 2] = [Windows::Paper, Windows::Compact];

/// A workload with the arrays that a problem borrows.
struct Case {
    workload: MlpgWorkload,
    precisions: Vec<f64>,
    state_of_frame: Vec<u32>,
}

impl Case {
    fn new(n_frames: usize, n_states: usize, dim: usize) -> Self {
        let workload = MlpgWorkload::new(n_frames, n_states, dim);
        Self {
            precisions: workload.precisions(),
            state_of_frame: workload.state_of_frame(),
            workload,
        }
    }

    fn problem(&self, windows: Windows) -> MlpgProblem<'_, f64> {
        MlpgProblem {
            windows,
            dim: self.workload.dim,
            means: &self.workload.means,
            precisions: &self.precisions,
            state_of_frame: &self.state_of_frame,
            n_fixed: 0,
            pull: None,
        }
    }

    fn solve(&self, windows: Windows) -> Vec<f64> {
        solve(&self.problem(windows))
    }
}

fn solve(problem: &MlpgProblem<'_, f64>) -> Vec<f64> {
    let mut trajectory = vec![0.0; problem.state_of_frame.len() * problem.dim];
    mlpg(problem, &mut MlpgWorkspace::new(), &mut trajectory).expect("solvable");
    trajectory
}

/// R = Wᵀ P W and r = Wᵀ P m of one dimension, from W itself.
fn normal_equations(problem: &MlpgProblem<'_, f64>, d: usize) -> (DMatrix<f64>, DVector<f64>) {
    let n_frames = problem.state_of_frame.len();
    let mut w = DMatrix::zeros(3 * n_frames, n_frames);
    let mut precision = DVector::zeros(3 * n_frames);
    let mut mean = DVector::zeros(3 * n_frames);
    let (half, quarter) = (0.5, 0.25);
    let offsets: [&[(isize, f64)]; 3] = match problem.windows {
        Windows::Paper => [
            &[(0, 1.0)],
            &[(-1, -half), (1, half)],
            &[(-2, quarter), (0, -half), (2, quarter)],
        ],
        Windows::Compact => [
            &[(0, 1.0)],
            &[(-1, -half), (1, half)],
            &[(-1, 1.0), (0, -2.0), (1, 1.0)],
        ],
    };
    for t in 0..n_frames {
        for (window, offsets) in offsets.iter().enumerate() {
            let inside = |offset: isize| t.checked_add_signed(offset).is_some_and(|s| s < n_frames);
            if offsets.iter().all(|(offset, _)| inside(*offset)) {
                let at = (problem.state_of_frame[t] as usize * 3 + window) * problem.dim + d;
                let row = 3 * t + window;
                precision[row] = problem.precisions[at];
                mean[row] = problem.means[at];
                for (offset, coefficient) in *offsets {
                    w[(row, t.wrapping_add_signed(*offset))] = *coefficient;
                }
            }
        }
    }
    let weighted = DMatrix::from_fn(3 * n_frames, n_frames, |i, j| precision[i] * w[(i, j)]);
    (w.transpose() * &weighted, weighted.transpose() * mean)
}

/// The conditional optimum given the first `n_fixed` frames, by dense Cholesky.
fn dense(problem: &MlpgProblem<'_, f64>, d: usize, fixed: &[f64]) -> Vec<f64> {
    let (mut r, mut b) = normal_equations(problem, d);
    if let Some(pull) = problem.pull {
        for t in 0..b.len() {
            r[(t, t)] += pull.strength[d];
            b[t] += pull.strength[d] * pull.towards[d];
        }
    }
    let (n, f) = (b.len(), fixed.len());
    let given = DVector::from_column_slice(fixed);
    let rhs = b.rows(f, n - f) - r.view((f, 0), (n - f, f)) * &given;
    let free = r
        .view((f, f), (n - f, n - f))
        .into_owned()
        .cholesky()
        .expect("positive definite")
        .solve(&rhs);
    fixed.iter().chain(free.iter()).copied().collect()
}

fn largest_difference(found: &[f64], dim: usize, d: usize, expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len() * dim);
    let pairs = found.chunks(dim).zip(expected);
    // NaN must not slip through a maximum.
    pairs
        .map(|(frame, e)| (frame[d] - e).abs())
        .fold(0.0, |a, b| if b <= a { a } else { b })
}

#[test]
fn banded_equals_dense() {
    for windows in BOTH {
        for (n_frames, dim) in [
            (1, 1),
            (2, 3),
            (3, 8),
            (4, 1),
            (5, 9),
            (6, 2),
            (60, 54),
            (61, 17),
        ] {
            let case = Case::new(n_frames, 1 + n_frames / 6, dim);
            let found = case.solve(windows);
            for d in 0..dim {
                let difference =
                    largest_difference(&found, dim, d, &dense(&case.problem(windows), d, &[]));
                assert!(
                    difference < 1e-9,
                    "{windows:?} T {n_frames} D {dim} d {d}: {difference}"
                );
            }
        }
        let case = Case::new(1000, 165, 10);
        let found = case.solve(windows);
        for d in [0, 9] {
            assert!(
                largest_difference(&found, 10, d, &dense(&case.problem(windows), d, &[])) < 1e-9
            );
        }
    }
}

#[test]
fn given_frames_are_kept_and_the_rest_is_the_conditional_optimum() {
    for windows in BOTH {
        for n_frames in [2, 3, 5, 12, 41] {
            for n_fixed in [1, 2, 3, 4, 5, 7, n_frames] {
                if n_fixed > n_frames {
                    continue;
                }
                let dim = 11;
                let case = Case::new(n_frames, 1 + n_frames / 5, dim);
                let problem = MlpgProblem {
                    n_fixed,
                    ..case.problem(windows)
                };
                let given: Vec<f64> = (0..n_fixed * dim)
                    .map(|i| (i as f64 * 0.37).sin())
                    .collect();
                let mut found = vec![f64::NAN; n_frames * dim];
                found[..given.len()].copy_from_slice(&given);
                mlpg(&problem, &mut MlpgWorkspace::new(), &mut found).expect("solvable");
                assert_eq!(found[..given.len()], given[..]);
                for d in 0..dim {
                    let fixed: Vec<f64> = given.chunks(dim).map(|frame| frame[d]).collect();
                    let difference =
                        largest_difference(&found, dim, d, &dense(&problem, d, &fixed));
                    assert!(
                        difference < 1e-9,
                        "{windows:?} T {n_frames} fixed {n_fixed}: {difference}"
                    );
                }
            }
        }
    }
}

#[test]
fn four_given_frames_continue_a_long_trajectory_exactly() {
    for windows in BOTH {
        let case = Case::new(200, 30, 5);
        let whole = case.solve(windows);
        let start = 90;
        let problem = MlpgProblem {
            state_of_frame: &case.state_of_frame[start..],
            n_fixed: 4,
            ..case.problem(windows)
        };
        let mut rest = whole[start * 5..].to_vec();
        rest[4 * 5..].fill(0.0);
        mlpg(&problem, &mut MlpgWorkspace::new(), &mut rest).expect("solvable");
        for (a, b) in rest.iter().zip(&whole[start * 5..]) {
            assert!((a - b).abs() < 1e-10);
        }
    }
}

fn jbonsai_windows(windows: Windows) -> jbonsai::model::Windows {
    let second = match windows {
        Windows::Paper => vec![0.25, 0.0, -0.5, 0.0, 0.25],
        Windows::Compact => vec![1.0, -2.0, 1.0],
    };
    jbonsai::model::Windows::new(
        [vec![1.0], vec![-0.5, 0.0, 0.5], second]
            .map(Window::new)
            .to_vec(),
    )
}

/// jbonsai's trajectory, T x D; `gv` holds mean and variance per dimension.
fn jbonsai(workload: &MlpgWorkload, windows: Windows, gv: Option<(&[f64], &[f64])>) -> Vec<f64> {
    let windows = jbonsai_windows(windows);
    let states = workload
        .means
        .chunks(3 * workload.dim)
        .zip(workload.variances.chunks(3 * workload.dim));
    let stream = states
        .map(|(m, v)| {
            (
                m.iter().zip(v).map(|(m, v)| MeanVari(*m, *v)).collect(),
                1.0,
            )
        })
        .collect();
    let gv = gv.map(|(mean, variance)| {
        // Its second number is a precision, whatever it is called.
        let parameters = mean
            .iter()
            .zip(variance)
            .map(|(m, v)| MeanVari(*m, v.recip()))
            .collect();
        (parameters, vec![true; workload.durations.len()])
    });
    let stream = ModelStream {
        vector_length: workload.dim,
        stream: StreamParameter::new(stream),
        gv,
        windows: &windows,
    };
    MlpgAdjust::new(1.0, 0.5, stream)
        .create(&workload.durations)
        .concat()
}

#[test]
fn agrees_with_jbonsai() {
    for windows in BOTH {
        for case in [
            Case::new(1000, 165, 54),
            Case::new(33, 5, 3),
            Case::new(5, 2, 2),
        ] {
            let found = case.solve(windows);
            let theirs = jbonsai(&case.workload, windows, None);
            assert_eq!(found.len(), theirs.len());
            for (a, b) in found.iter().zip(&theirs) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }
}

#[test]
fn single_precision_is_close_and_dirty_workspaces_do_not_matter() {
    let mut workspace = MlpgWorkspace::<f32>::new();
    for windows in BOTH {
        for (n_frames, dim) in [(500, 54), (7, 3), (100, 33)] {
            let case = Case::new(n_frames, 1 + n_frames / 6, dim);
            let expected = case.solve(windows);
            let narrow = |values: &[f64]| values.iter().map(|v| *v as f32).collect::<Vec<f32>>();
            let (means, precisions) = (narrow(&case.workload.means), narrow(&case.precisions));
            let problem = MlpgProblem {
                windows,
                dim,
                means: &means,
                precisions: &precisions,
                state_of_frame: &case.state_of_frame,
                n_fixed: 0,
                pull: None,
            };
            let mut found = vec![0.0; n_frames * dim];
            mlpg(&problem, &mut workspace, &mut found).expect("solvable");
            for (a, b) in found.iter().zip(&expected) {
                assert!((f64::from(*a) - b).abs() < 1e-3, "{windows:?} {a} {b}");
            }
        }
    }
}

#[test]
fn bad_problems_are_named() {
    let case = Case::new(10, 3, 2);
    let good = case.problem(Windows::Paper);
    let run = |problem: &MlpgProblem<'_, f64>, len: usize| {
        mlpg(problem, &mut MlpgWorkspace::new(), &mut vec![0.0; len]).expect_err("refused")
    };
    assert!(matches!(
        run(&good, 19),
        ProbError::Shape {
            what: "trajectory",
            ..
        }
    ));
    assert!(matches!(
        run(&MlpgProblem { dim: 0, ..good }, 0),
        ProbError::Empty { .. }
    ));
    assert!(matches!(
        run(
            &MlpgProblem {
                means: &good.means[1..],
                ..good
            },
            20
        ),
        ProbError::Shape { what: "means", .. }
    ));
    assert!(matches!(
        run(
            &MlpgProblem {
                precisions: &[],
                ..good
            },
            20
        ),
        ProbError::Shape {
            what: "precisions",
            ..
        }
    ));
    assert!(matches!(
        run(
            &MlpgProblem {
                n_fixed: 11,
                ..good
            },
            20
        ),
        ProbError::IndexOutOfRange {
            what: "n_fixed",
            ..
        }
    ));
    let states = [0, 0, 0, 0, 0, 0, 0, 0, 0, 3];
    let problem = MlpgProblem {
        state_of_frame: &states,
        ..good
    };
    assert!(matches!(
        run(&problem, 20),
        ProbError::IndexOutOfRange {
            index: 9,
            value: 3,
            len: 3,
            ..
        }
    ));
    for at in [0, 2, 5] {
        let mut means = case.workload.means.clone();
        means[at] = f64::NAN;
        assert!(matches!(
            run(
                &MlpgProblem {
                    means: &means,
                    ..good
                },
                20
            ),
            ProbError::NotFinite { .. }
        ));
    }
    let mut precisions = case.precisions.clone();
    for state in precisions.chunks_mut(6) {
        state[1] = 0.0;
    }
    // Without static precision nothing says where dimension 1 is.
    let flat = MlpgProblem {
        precisions: &precisions,
        state_of_frame: &states[..1],
        ..good
    };
    assert!(matches!(
        run(&flat, 2),
        ProbError::NotPositiveDefinite { dim: 1 }
    ));
    let pull = Pull {
        strength: &[0.0, -1e6],
        towards: &[0.0, 0.0],
    };
    assert!(matches!(
        run(
            &MlpgProblem {
                pull: Some(pull),
                ..good
            },
            20
        ),
        ProbError::NotPositiveDefinite { dim: 1 }
    ));
    let empty = MlpgProblem {
        state_of_frame: &[],
        ..good
    };
    mlpg(&empty, &mut MlpgWorkspace::new(), &mut []).expect("nothing to do");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_state_sequence_solves_as_dense(
        states in prop::collection::vec(0u32..4, 1..40),
        dim in 1usize..20,
        n_fixed in 0usize..6,
        pull in -0.5f64..2.0,
        windows in prop::sample::select(BOTH.to_vec()),
    ) {
        let case = Case::new(8, 4, dim);
        let n_fixed = n_fixed.min(states.len());
        // Relative to the least static precision, so that the problem stays determined.
        let least = case.precisions.iter().copied().fold(f64::INFINITY, f64::min);
        let (strength, towards) = (vec![pull * least; dim], vec![0.2; dim]);
        let problem = MlpgProblem {
            state_of_frame: &states,
            n_fixed,
            pull: Some(Pull { strength: &strength, towards: &towards }),
            ..case.problem(windows)
        };
        let mut found: Vec<f64> = (0..states.len() * dim).map(|i| (i as f64).cos()).collect();
        let d = states.len() % dim;
        let fixed: Vec<f64> = found.chunks(dim).take(n_fixed).map(|frame| frame[d]).collect();
        mlpg(&problem, &mut MlpgWorkspace::new(), &mut found).expect("solvable");
        prop_assert!(largest_difference(&found, dim, d, &dense(&problem, d, &fixed)) < 1e-9);
    }
}

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
