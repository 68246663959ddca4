//! Trajectory generation against dense linear algebra, jbonsai and slow optimisation.

mod bad_problems;
mod case;
mod global_variance;
mod peer;

use case::{BOTH, Case, dense, largest_difference};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Pull, mlpg};
use proptest::prelude::*;

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
