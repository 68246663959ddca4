//! HSMM inference against the enumeration of all segmentations, and EM on sampled data.

mod chance;
mod enumeration;
mod expectation;

use footfall_prob::ProbError;
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::hsmm::{Boundary, ChainState, hsmm_forward_backward, hsmm_viterbi};

#[test]
fn bad_input_is_named() {
    let durations = [GaussianDuration {
        mean: 2.0,
        variance: 1.0,
    }
    .discretise(3)
    .expect("valid")];
    let chain = [ChainState {
        emission: 0,
        duration: 0,
    }; 2];
    let run = |log_emissions: &[f64], n_emissions, chain: &[ChainState]| {
        let forward_backward = hsmm_forward_backward(
            log_emissions,
            n_emissions,
            chain,
            &durations,
            Boundary::default(),
        );
        let viterbi = hsmm_viterbi(
            log_emissions,
            n_emissions,
            chain,
            &durations,
            Boundary::default(),
        );
        let error = forward_backward.expect_err("refused");
        // As text, because NaN differs from itself.
        assert_eq!(viterbi.expect_err("refused").to_string(), error.to_string());
        error
    };
    assert!(matches!(
        run(&[0.0], 1, &chain),
        ProbError::SequenceTooShort {
            frames: 1,
            segments: 2
        }
    ));
    assert!(matches!(
        run(&[], 1, &chain),
        ProbError::SequenceTooShort {
            frames: 0,
            segments: 2
        }
    ));
    assert!(matches!(
        run(&[0.0; 7], 1, &chain),
        ProbError::SequenceTooLong {
            frames: 7,
            longest: 6
        }
    ));
    assert!(matches!(
        run(&[0.0, f64::NAN, 0.0], 1, &chain),
        ProbError::NotFinite { index: 1, .. }
    ));
    assert!(matches!(
        run(&[0.0, f64::NEG_INFINITY, 0.0], 1, &chain),
        ProbError::NotFinite { index: 1, .. }
    ));
    assert!(matches!(run(&[0.0; 5], 2, &chain), ProbError::Shape { .. }));
    assert!(matches!(run(&[0.0; 5], 0, &chain), ProbError::Empty { .. }));
    assert!(matches!(run(&[0.0; 5], 1, &[]), ProbError::Empty { .. }));
    let elsewhere = ChainState {
        emission: 1,
        duration: 0,
    };
    assert!(matches!(
        run(&[0.0; 5], 1, &[elsewhere]),
        ProbError::IndexOutOfRange { value: 1, .. }
    ));
    let elsewhere = ChainState {
        emission: 0,
        duration: 4,
    };
    assert!(matches!(
        run(&[0.0; 5], 1, &[elsewhere]),
        ProbError::IndexOutOfRange { value: 4, .. }
    ));
    let impossible = [DurationDist::from_log_weights(vec![f64::NEG_INFINITY, 0.0]).expect("valid")];
    let odd = hsmm_forward_backward(&[0.0; 3], 1, &chain, &impossible, Boundary::default());
    assert!(matches!(odd, Err(ProbError::NoSegmentation { frames: 3 })));
}
