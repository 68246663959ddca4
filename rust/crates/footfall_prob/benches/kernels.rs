//! Inference kernels, and jbonsai's MLPG on the same data.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use footfall_prob::duration::GaussianDuration;
use footfall_prob::hsmm::{Boundary, ChainState, hsmm_forward_backward};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Real, mlpg};
use footfall_prob::subspace::{IdentifyConfig, Refinement, identify, refine};
use footfall_prob::switching::{ProjectionResidual, StreamingResidual};
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

/// Ten segments of 34 frames × 8 outputs, and 400 frames × 4 outputs: what a switching model of gait is fitted to and found in.
fn switching_kernels(c: &mut Criterion) {
    let wave = |length: usize, seed: f64| -> Vec<f64> {
        let value = |index: usize| {
            let (frame, channel) = ((index / 8) as f64, (index % 8) as f64);
            (0.2 * frame + seed + channel).sin() + 0.3 * (0.55 * frame - channel * seed).cos()
        };
        (0..length).map(value).collect()
    };
    let segments: Vec<Vec<f64>> = (0..10).map(|k| wave(34 * 8, f64::from(k))).collect();
    let views: Vec<&[f64]> = segments.iter().map(Vec::as_slice).collect();
    let config = IdentifyConfig {
        order: 12,
        window: 4,
    };
    c.bench_function("identify, 10 segments of 34 x 8, order 12", |b| {
        b.iter(|| identify(black_box(&views), 8, &config));
    });
    let system = identify(&views, 8, &config).expect("segments of a system");
    c.bench_function("refine, the same, 20 steps", |b| {
        b.iter(|| refine(&system, black_box(&views), Refinement::Simulation, 20));
    });
    let angles = wave(400 * 4, 0.7);
    c.bench_function("projection residual, 400 x 4, window 2", |b| {
        b.iter(|| ProjectionResidual::new(black_box(&angles), 4, 2).map(|r| r.norms()));
    });
    let mut live = StreamingResidual::new(4, 2).expect("channels and a window");
    c.bench_function("streaming residual, 400 frames of 4, window 2", |b| {
        b.iter(|| {
            for frame in angles.chunks_exact(4) {
                black_box(live.push(black_box(frame)));
            }
        });
    });
}

criterion_group!(kernels, mlpg_kernels, hsmm_kernels, switching_kernels);
criterion_main!(kernels);
