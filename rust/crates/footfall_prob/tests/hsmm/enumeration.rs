//! Inference against the enumeration of all segmentations.

use crate::chance::{BOUNDARIES, Rng};
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::hsmm::{Boundary, ChainState, Edge, hsmm_forward_backward, hsmm_viterbi};

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
