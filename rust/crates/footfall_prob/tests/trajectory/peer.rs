//! Trajectories of jbonsai for the same problems.

use crate::case::{BOTH, Case};
use footfall_prob::windows::Windows;
use footfall_prob::workload::MlpgWorkload;
use jbonsai::mlpg_adjust::MlpgAdjust;
use jbonsai::model::voice::window::Window;
use jbonsai::model::{MeanVari, ModelStream, StreamParameter};

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
pub(crate) fn jbonsai(
    workload: &MlpgWorkload,
    windows: Windows,
    gv: Option<(&[f64], &[f64])>,
) -> Vec<f64> {
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
