//! Against Bayes' rule with dense Gaussians, and on data that is separable and not separable.

use super::*;
use proptest::prelude::*;

/// A small deterministic stream of standard normal values (Box and Muller on a linear congruential generator).
struct Normals(u64);

impl Normals {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (core::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Correlated samples of three classes whose means are `apart` from each other.
fn toy(seed: u64, per_class: usize, width: usize, apart: f64) -> Vec<(Vec<f64>, usize)> {
    let mut normals = Normals(seed);
    let mut samples = Vec::new();
    for index in 0..3 * per_class {
        let class = index % 3;
        let shared = normals.next();
        let features = (0..width)
            .map(|feature| {
                let mean = if feature % 3 == class { apart } else { 0.0 };
                mean + (1.0 + feature as f64) * normals.next() + shared
            })
            .collect();
        samples.push((features, class));
    }
    samples
}

fn labelled(samples: &[(Vec<f64>, usize)]) -> Vec<Labelled<'_>> {
    samples
        .iter()
        .map(|(features, class)| Labelled {
            features,
            class: *class,
        })
        .collect()
}

/// Bayes' rule with one dense covariance, inverted as it stands.
fn dense_log_posteriors(samples: &[(Vec<f64>, usize)], at: &[f64]) -> Vec<f64> {
    let width = at.len();
    let mut means = vec![DVector::zeros(width); 3];
    let mut counts = [0.0; 3];
    for (features, class) in samples {
        means[*class] += DVector::from_column_slice(features);
        counts[*class] += 1.0;
    }
    for (mean, count) in means.iter_mut().zip(counts) {
        *mean /= count;
    }
    let mut covariance = DMatrix::zeros(width, width);
    for (features, class) in samples {
        let residual = DVector::from_column_slice(features) - &means[*class];
        covariance += &residual * residual.transpose();
    }
    covariance /= samples.len() as f64 - 3.0;
    let inverse = covariance.try_inverse().unwrap();
    let densities: Vec<f64> = means
        .iter()
        .map(|mean| {
            let offset = DVector::from_column_slice(at) - mean;
            (-0.5 * (offset.transpose() * &inverse * &offset)[0]).exp()
        })
        .collect();
    let total: f64 = densities.iter().sum();
    densities
        .iter()
        .map(|density| (density / total).ln())
        .collect()
}

#[test]
fn without_shrinkage_it_is_the_textbook_s() {
    let samples = toy(1, 20, 4, 2.0);
    let lda = Lda::fit(&labelled(&samples), 3, 1e-9, Shrinkage::Fixed(0.0)).unwrap();
    for (features, _) in &samples {
        let expected = dense_log_posteriors(&samples, features);
        for (ours, reference) in lda.log_posteriors(features).iter().zip(expected) {
            assert!((ours - reference).abs() < 1e-9, "{ours} is not {reference}");
        }
    }
}

#[test]
fn what_lies_apart_is_told_apart_with_more_features_than_samples() {
    let training = toy(2, 6, 60, 200.0);
    let lda = Lda::fit(&labelled(&training), 3, 1e-9, Shrinkage::Automatic).unwrap();
    assert!((0.5..0.8).contains(&lda.shrinkage()));
    for (features, class) in &toy(3, 30, 60, 200.0) {
        assert_eq!(lda.classify(features), *class);
    }
}

#[test]
fn what_is_alike_is_guessed() {
    let training = toy(4, 60, 6, 0.0);
    let lda = Lda::fit(&labelled(&training), 3, 1e-9, Shrinkage::Automatic).unwrap();
    let unseen = toy(5, 400, 6, 0.0);
    let right = unseen
        .iter()
        .filter(|(features, class)| lda.classify(features) == *class)
        .count();
    let rate = right as f64 / unseen.len() as f64;
    assert!((0.27..0.40).contains(&rate), "{rate} of chance 0.333");
}

#[test]
fn the_formula_shrinks_noise_and_keeps_true_correlation() {
    let mut normals = Normals(6);
    let mut shrinkage_of = |weight: f64| {
        let samples: Vec<(Vec<f64>, usize)> = (0..300)
            .map(|index| {
                let shared = weight * normals.next();
                let features = (0..8).map(|_| shared + normals.next()).collect();
                (features, index % 3)
            })
            .collect();
        Lda::fit(&labelled(&samples), 3, 1e-9, Shrinkage::Automatic)
            .unwrap()
            .shrinkage()
    };
    let (alone, together) = (shrinkage_of(0.0), shrinkage_of(2.0));
    assert!(alone > 0.5, "{alone}");
    assert!(together < 0.05, "{together}");
}

#[test]
fn bad_samples_are_errors() {
    let samples = toy(7, 4, 3, 1.0);
    let fit = |samples: &[(Vec<f64>, usize)], classes| {
        Lda::fit(&labelled(samples), classes, 1e-9, Shrinkage::Automatic)
    };
    assert!(matches!(
        fit(&samples, 4),
        Err(EvaluateError::EmptyClass { class: 3 })
    ));
    assert!(matches!(
        fit(&samples[..3], 3),
        Err(EvaluateError::TooFewSamples { .. })
    ));
    let mut broken = samples.clone();
    broken[1].0[2] = f64::NAN;
    assert!(matches!(fit(&broken, 3), Err(EvaluateError::Features)));
    let repeated: Vec<_> = samples
        .iter()
        .map(|(features, class)| (vec![features[0], features[0]], *class))
        .collect();
    let textbook = Lda::fit(&labelled(&repeated), 3, 1e-9, Shrinkage::Fixed(0.0));
    assert!(matches!(textbook, Err(EvaluateError::Singular)));
    fit(&repeated, 3).unwrap();
}

proptest! {
    #[test]
    fn units_do_not_matter(seed in 0_u64..1000, scale in 0.01_f64..100.0, shift in -10.0_f64..10.0) {
        let samples = toy(seed, 8, 5, 3.0);
        let changed: Vec<_> = samples
            .iter()
            .map(|(features, class)| (features.iter().map(|value| value * scale + shift).collect::<Vec<_>>(), *class))
            .collect();
        let lda = Lda::fit(&labelled(&samples), 3, 1e-12, Shrinkage::Automatic).unwrap();
        let other = Lda::fit(&labelled(&changed), 3, 1e-12, Shrinkage::Automatic).unwrap();
        for ((features, _), (same, _)) in samples.iter().zip(&changed) {
            let posteriors = lda.log_posteriors(features);
            prop_assert!((posteriors.iter().map(|value| value.exp()).sum::<f64>() - 1.0).abs() < 1e-9);
            for (a, b) in posteriors.iter().zip(other.log_posteriors(same)) {
                prop_assert!((a - b).abs() < 1e-5 * (1.0 + a.abs()), "{} is not {}", a, b);
            }
        }
    }
}
