//! Linear-regression transforms against slow references.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use footfall_prob::ProbError;
use footfall_prob::gaussian::{DiagonalGaussian, GaussianStats};
use footfall_prob::regression::{
    LinearTransform, RegressionMember, RegressionStats, TransformPrior, estimate_transform,
    map_estimate, transform_objective,
};
use proptest::prelude::*;

/// Standard normal numbers from a seed (splitmix64, then Box and Muller).
struct Normals(u64);

impl Normals {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A model, frames that truly belong to its Gaussians after x = A y + b, and the true feature-space map.
struct Scene {
    dim: usize,
    gaussians: Vec<DiagonalGaussian>,
    frames: Vec<Vec<Vec<f64>>>,
    stats: Vec<RegressionStats>,
    truth: LinearTransform,
}

fn scene(dim: usize, states: usize, frames_each: usize, seed: u64) -> Scene {
    let mut random = Normals(seed);
    let gaussians: Vec<DiagonalGaussian> = (0..states)
        .map(|_| {
            let mean = (0..dim).map(|_| 2.0 * random.normal()).collect();
            let variance = (0..dim).map(|_| 0.05 + random.uniform()).collect();
            DiagonalGaussian::new(mean, variance).unwrap()
        })
        .collect();
    // F is near the identity, unit lower times unit upper triangular: its inverse needs two substitutions only.
    let mut rows = LinearTransform::identity(dim).rows().to_vec();
    for i in 0..dim {
        rows[i * (dim + 1)] = random.normal();
        for j in 0..dim {
            rows[i * (dim + 1) + 1 + j] += 0.25 * random.normal() / (dim as f64).sqrt();
        }
    }
    let truth = LinearTransform::from_rows(dim, rows.clone()).unwrap();
    let matrix = nalgebra::DMatrix::from_fn(dim, dim, |i, j| rows[i * (dim + 1) + 1 + j]);
    let inverse = matrix.try_inverse().unwrap();
    let mut frames = vec![vec![]; states];
    let mut stats = vec![RegressionStats::new(dim); states];
    for (state, gaussian) in gaussians.iter().enumerate() {
        for _ in 0..frames_each {
            let mapped = nalgebra::DVector::from_fn(dim, |d, _| {
                gaussian.mean()[d] + gaussian.variance()[d].sqrt() * random.normal()
                    - rows[d * (dim + 1)]
            });
            let frame: Vec<f64> = (&inverse * mapped).iter().copied().collect();
            stats[state].add(&frame, 1.0);
            frames[state].push(frame);
        }
    }
    Scene {
        dim,
        gaussians,
        frames,
        stats,
        truth,
    }
}

impl Scene {
    fn members(&self) -> Vec<RegressionMember<'_>> {
        let pairs = self.gaussians.iter().zip(&self.stats);
        pairs
            .map(|(gaussian, stats)| RegressionMember { gaussian, stats })
            .collect()
    }

    /// The log-likelihood frame by frame: what the statistics stand for.
    fn slow_log_likelihood(&self, transform: &LinearTransform) -> f64 {
        let matrix = nalgebra::DMatrix::from_fn(self.dim, self.dim, |i, j| {
            transform.rows()[i * (self.dim + 1) + 1 + j]
        });
        let log_det = matrix.determinant().abs().ln();
        let mut mapped = vec![0.0; self.dim];
        let mut sum = 0.0;
        for (gaussian, frames) in self.gaussians.iter().zip(&self.frames) {
            for frame in frames {
                transform.apply(frame, &mut mapped);
                sum += gaussian.log_density(&mapped) + log_det;
            }
        }
        sum
    }
}

fn nudged(transform: &LinearTransform, index: usize, by: f64) -> LinearTransform {
    let mut rows = transform.rows().to_vec();
    rows[index] += by;
    LinearTransform::from_rows(transform.dim(), rows).unwrap()
}

#[test]
fn the_objective_is_the_log_likelihood_of_the_frames() {
    let scene = scene(5, 3, 20, 1);
    for transform in [LinearTransform::identity(5), scene.truth.clone()] {
        let fast = transform_objective(&scene.members(), None, &transform).unwrap();
        let slow = scene.slow_log_likelihood(&transform);
        assert!((fast - slow).abs() < 1e-8 * slow.abs(), "{fast} {slow}");
    }
}

#[test]
fn nothing_pulls_at_the_optimum() {
    let scene = scene(4, 3, 30, 2);
    let centre = LinearTransform::identity(4);
    let prior = TransformPrior {
        centre: &centre,
        row_precision: &[1.0, 4.0, 0.5, 2.0],
        bias_weight: 2.0,
        matrix_weight: 15.0,
    };
    for prior in [None, Some(&prior)] {
        let members = scene.members();
        let found = estimate_transform(&members, prior, &centre, 400).unwrap();
        let objective = |t: &LinearTransform| transform_objective(&members, prior, t).unwrap();
        for index in 0..found.transform.rows().len() {
            let h = 1e-5;
            let slope = (objective(&nudged(&found.transform, index, h))
                - objective(&nudged(&found.transform, index, -h)))
                / (2.0 * h);
            assert!(slope.abs() < 2e-2, "element {index}: {slope}");
            // And it is a maximum, not a saddle.
            for step in [-1e-2, 1e-2] {
                let near = objective(&nudged(&found.transform, index, step));
                assert!(near < objective(&found.transform), "element {index}");
            }
        }
    }
}

#[test]
fn a_known_transform_is_found_again() {
    let scene = scene(6, 8, 4000, 3);
    let start = LinearTransform::identity(6);
    let found = estimate_transform(&scene.members(), None, &start, 400).unwrap();
    for (found, truth) in found.transform.rows().iter().zip(scene.truth.rows()) {
        assert!((found - truth).abs() < 0.04, "{found} {truth}");
    }
}

#[test]
fn scalars_are_found_in_one_sweep() {
    // With one Gaussian, frames of mean 10 and variance 4 must come out as its mean 3 and variance 1.
    let gaussian = DiagonalGaussian::new(vec![3.0], vec![1.0]).unwrap();
    let mut stats = RegressionStats::new(1);
    for frame in [8.0, 12.0] {
        stats.add(&[frame], 5.0);
    }
    let members = [RegressionMember {
        gaussian: &gaussian,
        stats: &stats,
    }];
    let start = LinearTransform::identity(1);
    let found = estimate_transform(&members, None, &start, 50).unwrap();
    let rows = found.transform.rows();
    assert!(
        (rows[1] - 0.5).abs() < 1e-9 && (rows[0] + 2.0).abs() < 1e-8,
        "{rows:?}"
    );
    let adapted = found.transform.adapt(&[gaussian]).unwrap();
    assert!((adapted[0].mean()[0] - 10.0).abs() < 1e-8);
    assert!((adapted[0].variance()[0] - 4.0).abs() < 1e-8);
}

#[test]
fn without_frames_nothing_moves() {
    let scene = scene(3, 2, 0, 4);
    let start = scene.truth.clone();
    let plain = estimate_transform(&scene.members(), None, &start, 10).unwrap();
    assert_eq!(plain.transform, LinearTransform::identity(3));
    let prior = TransformPrior {
        centre: &scene.truth,
        row_precision: &[1.0; 3],
        bias_weight: 1.0,
        matrix_weight: 1.0,
    };
    let found = estimate_transform(&scene.members(), Some(&prior), &start, 10).unwrap();
    assert_eq!(found.transform, scene.truth);
    let identity = LinearTransform::identity(3);
    assert_eq!(identity.adapt(&scene.gaussians).unwrap(), scene.gaussians);
    let same = map_estimate(&scene.gaussians[0], &GaussianStats::new(3), 5.0).unwrap();
    assert_eq!(same, scene.gaussians[0]);
}

#[test]
fn a_weak_prior_is_no_prior_and_a_strong_one_does_not_let_go() {
    let scene = scene(4, 4, 50, 5);
    let centre = LinearTransform::identity(4);
    let run = |weight: Option<f64>| {
        let prior = weight.map(|weight| TransformPrior {
            centre: &centre,
            row_precision: &[1.0; 4],
            bias_weight: weight,
            matrix_weight: weight,
        });
        estimate_transform(&scene.members(), prior.as_ref(), &centre, 400)
            .unwrap()
            .transform
    };
    let free = run(None);
    let far = |left: &LinearTransform, right: &LinearTransform| {
        let pairs = left.rows().iter().zip(right.rows());
        pairs.map(|(l, r)| (l - r).abs()).fold(0.0, f64::max)
    };
    assert!(far(&run(Some(1e-9)), &free) < 1e-4);
    assert!(far(&run(Some(1e9)), &centre) < 1e-4);
    assert!(far(&run(Some(50.0)), &centre) < far(&free, &centre));
}

#[test]
fn frames_too_few_for_the_transform_need_a_prior() {
    let scene = scene(6, 2, 2, 6);
    let start = LinearTransform::identity(6);
    assert!(matches!(
        estimate_transform(&scene.members(), None, &start, 10),
        Err(ProbError::Degenerate { .. })
    ));
    let prior = TransformPrior {
        centre: &start,
        row_precision: &[1.0; 6],
        bias_weight: 1.0,
        matrix_weight: 10.0,
    };
    let found = estimate_transform(&scene.members(), Some(&prior), &start, 50).unwrap();
    assert!(found.transform.log_determinant().is_finite());
}

#[test]
fn map_lies_between_the_prior_and_the_frames() {
    let prior = DiagonalGaussian::new(vec![0.0], vec![1.0]).unwrap();
    let mut stats = GaussianStats::new(1);
    stats.add(&[3.0], 5.0);
    stats.add(&[5.0], 5.0);
    let found = map_estimate(&prior, &stats, 10.0).unwrap();
    assert!((found.mean()[0] - 2.0).abs() < 1e-12);
    // Half of the prior's 1, half of the frames' 1 + 2² about the new mean.
    assert!((found.variance()[0] - 3.0).abs() < 1e-12);
    assert!(map_estimate(&prior, &stats, 0.0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_sweep_makes_it_worse(seed in any::<u64>(), dim in 1_usize..6, weight in 0.0_f64..20.0) {
        let scene = scene(dim, 3, 12, seed);
        let centre = LinearTransform::identity(dim);
        let precision = vec![1.0; dim];
        let prior = TransformPrior {
            centre: &centre,
            row_precision: &precision,
            bias_weight: weight + 1e-6,
            matrix_weight: weight + 1e-6,
        };
        let found = estimate_transform(&scene.members(), Some(&prior), &centre, 30).unwrap();
        for pair in found.objectives.windows(2) {
            prop_assert!(pair[1] >= pair[0] - 1e-9 * pair[0].abs());
        }
    }
}
