//! Problems without a solution.

use crate::case::Case;
use footfall_prob::ProbError;
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Pull, mlpg};
use footfall_prob::windows::Windows;

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
