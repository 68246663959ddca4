//! Inference kernels, and jbonsai's MLPG on the same data.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use footfall_prob::duration::GaussianDuration;
use footfall_prob::hsmm::{Boundary, ChainState, hsmm_forward_backward};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Real, mlpg};
use footfall_prob::windows::Windows;
use footfall_prob::workload::MlpgWorkload;
use jbonsai::mlpg_adjust::MlpgAdjust;
use jbonsai::model::{MeanVari, ModelStream, StreamParameter};

fn ours<R: Real>(c: &mut Criterion, name: &str, windows: Windows, workload: &MlpgWorkload) {
    let narrow = |values: &[f64]| values.iter().map(|v| R::narrow(*v)).collect::<Vec<R>>();
    let (means, precisions) = (narrow(&workload.means), narrow(&workload.precisions()));
    let state_of_frame = workload.state_of_frame();
    let problem = MlpgProblem {
        windows,
        dim: workload.dim,
        means: &means,
        precisions: &precisions,
        state_of_frame: &state_of_frame,
        n_fixed: 0,
        pull: None,
    };
    let mut workspace = MlpgWorkspace::new();
    let mut trajectory = vec![R::default(); workload.n_frames() * workload.dim];
    c.bench_function(name, |b| {
        b.iter(|| {
            mlpg(
                black_box(&problem),
                &mut workspace,
                black_box(&mut trajectory),
            )
        });
    });
}

fn mlpg_kernels(c: &mut Criterion) {
    let workload = MlpgWorkload::reference();
    ours::<f64>(
        c,
        "mlpg f64, paper windows, 1000 x 54",
        Windows::Paper,
        &workload,
    );
    ours::<f32>(
        c,
        "mlpg f32, paper windows, 1000 x 54",
        Windows::Paper,
        &workload,
    );
    ours::<f64>(
        c,
        "mlpg f64, compact windows, 1000 x 54",
        Windows::Compact,
        &workload,
    );
    ours::<f32>(
        c,
        "mlpg f32, compact windows, 1000 x 54",
        Windows::Compact,
        &workload,
    );
    ours::<f32>(
        c,
        "mlpg f32, compact windows, 60 x 54",
        Windows::Compact,
        &MlpgWorkload::new(60, 10, 54),
    );

    let windows = jbonsai::model::Windows::new(
        [
            vec![1.0],
            vec![-0.5, 0.0, 0.5],
            vec![0.25, 0.0, -0.5, 0.0, 0.25],
        ]
        .map(jbonsai::model::voice::window::Window::new)
        .to_vec(),
    );
    let states = workload
        .means
        .chunks(3 * workload.dim)
        .zip(workload.variances.chunks(3 * workload.dim));
    let stream = states
        .map(|(means, variances)| {
            (
                means
                    .iter()
                    .zip(variances)
                    .map(|(m, v)| MeanVari(*m, *v))
                    .collect(),
                1.0,
            )
        })
        .collect();
    let adjust = MlpgAdjust::new(
        0.0,
        0.5,
        ModelStream {
            vector_length: workload.dim,
            stream: StreamParameter::new(stream),
            gv: None,
            windows: &windows,
        },
    );
    c.bench_function("mlpg f64, jbonsai, 1000 x 54", |b| {
        b.iter(|| adjust.create(black_box(&workload.durations)));
    });
}

/// Eight steps of five states each, 60 frames a step: the paper's 1325 steps are 166 of these.
fn hsmm_kernels(c: &mut Criterion) {
    let n_frames = 480;
    let n_emissions = 10;
    let durations = [GaussianDuration {
        mean: 12.0,
        variance: 9.0,
    }
    .discretise(60)
    .expect("valid duration")];
    let chain: Vec<ChainState> = (0..40)
        .map(|k| ChainState {
            emission: k % n_emissions,
            duration: 0,
        })
        .collect();
    let log_emissions: Vec<f64> = (0..n_frames * n_emissions)
        .map(|i| {
            let (t, e) = (i / n_emissions, i % n_emissions);
            let right = (t / 12) % n_emissions == e;
            200.0 * (i as f64 * 2.414).sin() + if right { 0.0 } else { -150.0 }
        })
        .collect();
    c.bench_function(
        "hsmm_forward_backward, 480 frames, 40 segments, 60 durations",
        |b| {
            b.iter(|| {
                hsmm_forward_backward(
                    black_box(&log_emissions),
                    n_emissions,
                    &chain,
                    &durations,
                    Boundary::default(),
                )
            });
        },
    );
}

criterion_group!(kernels, mlpg_kernels, hsmm_kernels);
criterion_main!(kernels);
