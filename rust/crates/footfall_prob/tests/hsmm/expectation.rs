//! Expectation-maximisation on data that a known model made.

use crate::chance::{BOUNDARIES, Rng};
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::gaussian::{DiagonalGaussian, log_densities};
use footfall_prob::hsmm::{Boundary, ChainState, HsmmStats, hsmm_forward_backward};

struct Model {
    gaussians: Vec<DiagonalGaussian>,
    durations: Vec<GaussianDuration>,
}

const MAX_DURATION: usize = 25;

fn sample(model: &Model, chain: &[ChainState], rng: &mut Rng) -> Vec<f64> {
    let mut observations = Vec::new();
    for state in chain {
        let dist = model.durations[state.duration]
            .discretise(MAX_DURATION)
            .expect("valid");
        for _ in 0..rng.duration(&dist) {
            let gaussian = &model.gaussians[state.emission];
            for (mean, variance) in gaussian.mean().iter().zip(gaussian.variance()) {
                observations.push(mean + variance.sqrt() * rng.normal());
            }
        }
    }
    observations
}

fn e_step(model: &Model, chain: &[ChainState], data: &[(Vec<f64>, Boundary)]) -> HsmmStats {
    let durations: Vec<DurationDist> = model
        .durations
        .iter()
        .map(|d| d.discretise(MAX_DURATION).expect("valid"))
        .collect();
    let mut stats = HsmmStats::new(model.gaussians.len(), 2, durations.len());
    let mut log_emissions = Vec::new();
    for (observations, boundary) in data {
        log_densities(&model.gaussians, observations, &mut log_emissions).expect("valid");
        let posterior = hsmm_forward_backward(
            &log_emissions,
            model.gaussians.len(),
            chain,
            &durations,
            *boundary,
        )
        .expect("solvable");
        stats.add(chain, &posterior, observations).expect("fits");
    }
    stats
}

fn m_step(stats: &HsmmStats) -> Model {
    Model {
        gaussians: stats
            .emissions
            .iter()
            .map(|g| g.estimate(&[1e-4; 2]).expect("data"))
            .collect(),
        durations: stats
            .durations
            .iter()
            .map(|d| d.estimate(MAX_DURATION, 0.05).expect("data"))
            .collect(),
    }
}

fn fit(
    mut model: Model,
    chain: &[ChainState],
    data: &[(Vec<f64>, Boundary)],
    iterations: usize,
) -> Model {
    let mut last = f64::NEG_INFINITY;
    for _ in 0..iterations {
        let stats = e_step(&model, chain, data);
        assert!(
            stats.log_likelihood >= last - 1e-8 * last.abs(),
            "fell from {last} to {}",
            stats.log_likelihood
        );
        last = stats.log_likelihood;
        model = m_step(&stats);
    }
    model
}

fn known_model() -> (Model, Vec<ChainState>) {
    let gaussian = |mean: [f64; 2], variance: [f64; 2]| {
        DiagonalGaussian::new(mean.to_vec(), variance.to_vec()).expect("valid")
    };
    let model = Model {
        gaussians: vec![
            gaussian([0.0, 1.0], [0.3, 0.5]),
            gaussian([1.5, 0.0], [0.2, 0.4]),
            gaussian([0.5, -1.5], [0.6, 0.2]),
        ],
        durations: vec![
            GaussianDuration {
                mean: 9.0,
                variance: 5.0,
            },
            GaussianDuration {
                mean: 3.0,
                variance: 2.0,
            },
            GaussianDuration {
                mean: 14.0,
                variance: 9.0,
            },
        ],
    };
    let chain = (0..9)
        .map(|k| ChainState {
            emission: k % 3,
            duration: k % 3,
        })
        .collect();
    (model, chain)
}

fn poor_start() -> Model {
    let gaussian =
        |mean: [f64; 2]| DiagonalGaussian::new(mean.to_vec(), vec![1.0; 2]).expect("valid");
    Model {
        gaussians: vec![
            gaussian([0.3, 0.5]),
            gaussian([1.0, 0.3]),
            gaussian([0.7, -0.8]),
        ],
        durations: vec![
            GaussianDuration {
                mean: 8.0,
                variance: 20.0
            };
            3
        ],
    }
}

#[test]
fn em_recovers_a_known_model() {
    let (truth, chain) = known_model();
    let mut rng = Rng(11);
    let data: Vec<_> = (0..200)
        .map(|_| (sample(&truth, &chain, &mut rng), Boundary::default()))
        .collect();
    let found = fit(poor_start(), &chain, &data, 30);
    for (found, truth) in found.gaussians.iter().zip(&truth.gaussians) {
        for d in 0..2 {
            assert!(
                (found.mean()[d] - truth.mean()[d]).abs() < 0.05,
                "{:?}",
                found.mean()
            );
            assert!(
                (found.variance()[d] / truth.variance()[d] - 1.0).abs() < 0.08,
                "{:?}",
                found.variance()
            );
        }
    }
    for (found, truth) in found.durations.iter().zip(&truth.durations) {
        assert!((found.mean - truth.mean).abs() < 0.35, "{found:?}");
        assert!(
            (found.variance / truth.variance - 1.0).abs() < 0.3,
            "{found:?}"
        );
    }
}

#[test]
fn em_on_censored_recordings_is_not_biased() {
    let (truth, chain) = known_model();
    // One state long and one short, cut at both ends at random: without the censoring terms the
    // outer durations would come out far too short.
    let chain = &chain[..3];
    let mut rng = Rng(5);
    let dists: Vec<DurationDist> = truth
        .durations
        .iter()
        .map(|d| d.discretise(MAX_DURATION).expect("valid"))
        .collect();
    let data: Vec<_> = (0..1500)
        .map(|_| {
            // The first segment is met at a random time, so long ones are met more often.
            let longest = MAX_DURATION as f64;
            let first = loop {
                let d = rng.duration(&dists[0]);
                if rng.uniform() * longest < d as f64 {
                    break d;
                }
            };
            let first_seen = 1 + (rng.uniform() * first as f64) as usize;
            // Stop recording a uniform time after the last boundary: keep only cuts inside the segment.
            let (last_seen, middle) = loop {
                let last = rng.duration(&dists[2]);
                let seen = 1 + (rng.uniform() * 6.0) as usize;
                if seen <= last {
                    break (seen, rng.duration(&dists[1]));
                }
            };
            let mut observations = Vec::new();
            for (k, seen) in [first_seen, middle, last_seen].into_iter().enumerate() {
                let gaussian = &truth.gaussians[k];
                for _ in 0..seen {
                    for d in 0..2 {
                        observations.push(
                            gaussian.mean()[d] + gaussian.variance()[d].sqrt() * rng.normal(),
                        );
                    }
                }
            }
            (observations, BOUNDARIES[3])
        })
        .collect();
    let found = fit(poor_start(), chain, &data, 60);
    assert!(
        (found.durations[0].mean - 9.0).abs() < 0.6,
        "{:?}",
        found.durations
    );
    assert!(
        (found.durations[1].mean - 3.0).abs() < 0.4,
        "{:?}",
        found.durations
    );
    // The last segment is never seen to end: only its survival speaks, so it is merely not too short.
    assert!(found.durations[2].mean > 6.0, "{:?}", found.durations);
}
