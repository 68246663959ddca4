//! HSMM inference against the enumeration of all segmentations, and EM on sampled data.

use footfall_prob::ProbError;
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::gaussian::{DiagonalGaussian, log_densities};
use footfall_prob::hsmm::{
    Boundary, ChainState, Edge, HsmmStats, hsmm_forward_backward, hsmm_viterbi,
};

/// A small deterministic generator (`SplitMix64`), so that tests need no random crate.
struct Rng(u64);

impl Rng {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    fn duration(&mut self, dist: &DurationDist) -> usize {
        let mut left = self.uniform();
        for d in 1..=dist.max_duration() {
            left -= dist.log_pmf(d).exp();
            if left < 0.0 {
                return d;
            }
        }
        dist.max_duration()
    }
}

const BOUNDARIES: [Boundary; 4] = [
    Boundary {
        start: Edge::Complete,
        end: Edge::Complete,
    },
    Boundary {
        start: Edge::Complete,
        end: Edge::Censored,
    },
    Boundary {
        start: Edge::Censored,
        end: Edge::Complete,
    },
    Boundary {
        start: Edge::Censored,
        end: Edge::Censored,
    },
];

/// Everything that the enumeration finds out. The durations of the outermost segments are
/// enumerated whole, with the frames outside the recording, so no censoring formula is reused.
struct Truth {
    likelihood: f64,
    state_probs: Vec<Vec<f64>>,
    duration_probs: Vec<Vec<f64>>,
    best: (f64, Vec<usize>),
}

fn enumerate(
    log_emissions: &[f64],
    n_emissions: usize,
    chain: &[ChainState],
    durations: &[DurationDist],
    boundary: Boundary,
) -> Truth {
    let n_frames = log_emissions.len() / n_emissions;
    let n_segments = chain.len();
    let max = durations
        .iter()
        .map(DurationDist::max_duration)
        .max()
        .unwrap_or(0);
    let mut truth = Truth {
        likelihood: 0.0,
        state_probs: vec![vec![0.0; n_segments]; n_frames],
        duration_probs: vec![vec![0.0; max]; n_segments],
        best: (0.0, Vec::new()),
    };
    let mut seen = vec![1; n_segments];
    loop {
        if seen.iter().sum::<usize>() == n_frames {
            let mut joint = 0.0;
            let mut whole = vec![vec![0.0; max]; n_segments];
            let mut emission = 1.0;
            let mut t = 0;
            for (k, state) in chain.iter().enumerate() {
                for _ in 0..seen[k] {
                    emission *= log_emissions[t * n_emissions + state.emission].exp();
                    t += 1;
                }
            }
            // Hidden frames before the first and after the last segment.
            let before = if boundary.start == Edge::Censored {
                max
            } else {
                0
            };
            let after = if boundary.end == Edge::Censored {
                max
            } else {
                0
            };
            for hidden_before in 0..=before {
                for hidden_after in 0..=after {
                    let mut weight = emission;
                    let mut lengths = seen.clone();
                    lengths[0] += hidden_before;
                    lengths[n_segments - 1] += hidden_after;
                    for (state, length) in chain.iter().zip(&lengths) {
                        weight *= durations[state.duration].log_pmf(*length).exp();
                    }
                    if boundary.start == Edge::Censored {
                        weight /= durations[chain[0].duration].mean();
                    }
                    joint += weight;
                    for (k, length) in lengths.iter().enumerate() {
                        if *length <= max {
                            whole[k][length - 1] += weight;
                        }
                    }
                }
            }
            truth.likelihood += joint;
            let mut t = 0;
            for k in 0..n_segments {
                for d in 0..max {
                    truth.duration_probs[k][d] += whole[k][d];
                }
                for _ in 0..seen[k] {
                    truth.state_probs[t][k] += joint;
                    t += 1;
                }
            }
            if joint > truth.best.0 {
                let mut boundaries = vec![0];
                for d in &seen {
                    boundaries.push(boundaries[boundaries.len() - 1] + d);
                }
                truth.best = (joint, boundaries);
            }
        }
        let Some(k) = (0..n_segments).find(|k| seen[*k] < n_frames) else {
            break;
        };
        seen[..k].fill(1);
        seen[k] += 1;
    }
    truth
        .state_probs
        .iter_mut()
        .flatten()
        .for_each(|p| *p /= truth.likelihood);
    truth
        .duration_probs
        .iter_mut()
        .flatten()
        .for_each(|p| *p /= truth.likelihood);
    truth
}

#[test]
fn agrees_with_enumeration() {
    let mut rng = Rng(7);
    let mut compared = 0;
    for n_frames in 1..=8 {
        for n_segments in 1..=3 {
            for boundary in BOUNDARIES {
                let n_emissions = 2;
                let log_emissions: Vec<f64> = (0..n_frames * n_emissions)
                    .map(|_| 3.0 * rng.normal())
                    .collect();
                let durations: Vec<DurationDist> = (0..2)
                    .map(|i| {
                        let parameters = GaussianDuration {
                            mean: 1.0 + 4.0 * rng.uniform(),
                            variance: 0.5 + 3.0 * rng.uniform(),
                        };
                        parameters.discretise(4 + 3 * i).expect("valid duration")
                    })
                    .collect();
                let chain: Vec<ChainState> = (0..n_segments)
                    .map(|k| ChainState {
                        emission: k % 2,
                        duration: (k + 1) % 2,
                    })
                    .collect();
                let longest: usize = chain
                    .iter()
                    .map(|s| durations[s.duration].max_duration())
                    .sum();
                let result = hsmm_forward_backward(
                    &log_emissions,
                    n_emissions,
                    &chain,
                    &durations,
                    boundary,
                );
                if n_frames < n_segments || n_frames > longest {
                    assert!(result.is_err());
                    continue;
                }
                let posterior = result.expect("solvable");
                let truth = enumerate(&log_emissions, n_emissions, &chain, &durations, boundary);
                assert!((posterior.log_likelihood - truth.likelihood.ln()).abs() < 1e-10);
                for t in 0..n_frames {
                    for k in 0..n_segments {
                        assert!(
                            (posterior.state_prob(t, k) - truth.state_probs[t][k]).abs() < 1e-10
                        );
                    }
                }
                for k in 0..n_segments {
                    for (found, expected) in posterior.segments[k]
                        .duration_probs
                        .iter()
                        .zip(&truth.duration_probs[k])
                    {
                        assert!(
                            (found - expected).abs() < 1e-10,
                            "T {n_frames} K {n_segments} {boundary:?} segment {k}"
                        );
                    }
                }
                let path = hsmm_viterbi(&log_emissions, n_emissions, &chain, &durations, boundary)
                    .expect("solvable");
                assert_eq!(path.boundaries, truth.best.1);
                assert!((path.log_probability - truth.best.0.ln()).abs() < 1e-10);
                compared += 1;
            }
        }
    }
    assert!(compared > 60, "only {compared} cases were solvable");
}

#[test]
fn posteriors_sum_to_one_and_long_sequences_stay_finite() {
    let mut rng = Rng(3);
    let n_frames = 10_000;
    // Densities of a 162-dimensional Gaussian swing by hundreds of nats from frame to frame.
    let log_emissions: Vec<f64> = (0..n_frames * 5)
        .map(|_| -300.0 + 200.0 * rng.normal())
        .collect();
    let durations = [GaussianDuration {
        mean: 12.0,
        variance: 20.0,
    }
    .discretise(30)
    .expect("valid")];
    let chain: Vec<ChainState> = (0..800)
        .map(|k| ChainState {
            emission: k % 5,
            duration: 0,
        })
        .collect();
    for boundary in [BOUNDARIES[0], BOUNDARIES[3]] {
        let posterior = hsmm_forward_backward(&log_emissions, 5, &chain, &durations, boundary)
            .expect("solvable");
        assert!(posterior.log_likelihood.is_finite());
        let mut per_frame = vec![0.0; n_frames];
        for segment in &posterior.segments {
            for (t, p) in segment.frames().zip(&segment.state_probs) {
                assert!((0.0..=1.0).contains(p));
                per_frame[t] += p;
            }
            assert!((segment.duration_probs.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
        assert!(per_frame.iter().all(|p| (p - 1.0).abs() < 1e-9));
        // Expected duration equals expected occupancy where the segment is seen whole.
        for segment in &posterior.segments[1..799] {
            let duration: f64 = (1..)
                .zip(&segment.duration_probs)
                .map(|(d, p)| f64::from(d) * p)
                .sum();
            assert!((duration - segment.state_probs.iter().sum::<f64>()).abs() < 1e-6);
        }
        let path = hsmm_viterbi(&log_emissions, 5, &chain, &durations, boundary).expect("solvable");
        assert!(path.log_probability <= posterior.log_likelihood + 1e-6);
        assert_eq!(path.boundaries.len(), 801);
        assert!(path.boundaries.windows(2).all(|w| w[0] < w[1]));
    }
}

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
