//! Folds of people: those learned from, and those judged.

use super::classifiers::Classifier;
use crate::evaluate::EvaluateError;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Every so manieth seed is judged in a fold, the others are learned from.
const SEED_FOLDS: usize = 8;
/// Number of divisions of people into two halves.
const DIVISIONS: u64 = 8;

/// A stride of one person or walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Whose it is: a number for each person or seed.
    pub walker: usize,
    /// See [`features`](super::features::of).
    pub features: Vec<f64>,
}

/// Balanced accuracies of one classifier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Mean over the folds.
    pub mean: f64,
    /// Least of the divisions of people; the mean where there is one.
    pub least: f64,
    /// Greatest of the divisions of people; the mean where there is one.
    pub greatest: f64,
}

/// Balanced accuracies, by [`Classifier::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Of the logistic regression and of the trees.
    pub accuracies: [Accuracy; 2],
}

/// Accuracy with which captured strides are told from generated ones, each of people and seeds that the classifier has not seen. A fold leaves out
/// one captured person and every eighth seed; balanced accuracy is the mean over folds of the share of captured strides that
/// are taken for captured and of generated strides that are not, halved.
///
/// # Errors
/// Errors of the classifiers.
pub fn judge(captured: &[Sample], generated: &[Sample]) -> Result<Verdict, EvaluateError> {
    let accuracies = accuracies(captured, generated, |sample| sample.walker % SEED_FOLDS)?;
    Ok(Verdict {
        accuracies: accuracies.map(|mean| Accuracy {
            mean,
            least: mean,
            greatest: mean,
        }),
    })
}

/// Scores of people in the generator's place: half of them are called generated, their folds by stride, the others' by person.
/// `None` with fewer than four people.
///
/// # Errors
/// Errors of the classifiers.
pub fn people_apart(captured: &[Sample]) -> Result<Option<Verdict>, EvaluateError> {
    let people: BTreeSet<usize> = captured.iter().map(|sample| sample.walker).collect();
    if people.len() < 4 {
        return Ok(None);
    }
    let divided = (0..DIVISIONS)
        .into_par_iter()
        .map(|division| {
            let mut order: Vec<usize> = people.iter().copied().collect();
            order.shuffle(&mut ChaCha8Rng::seed_from_u64(division));
            let (first, _) = order.split_at(order.len().div_ceil(2));
            let (own, others): (Vec<Sample>, Vec<Sample>) = captured
                .iter()
                .cloned()
                .partition(|sample| first.contains(&sample.walker));
            // As seeds are all of one generator, each stride of the others is in the place of a seed.
            let others: Vec<Sample> = others
                .into_iter()
                .enumerate()
                .map(|(walker, sample)| Sample { walker, ..sample })
                .collect();
            accuracies(&own, &others, |sample| sample.walker % SEED_FOLDS)
        })
        .collect::<Result<Vec<[f64; 2]>, EvaluateError>>()?;
    let of = |classifier: usize| {
        let values = || divided.iter().map(|accuracies| accuracies[classifier]);
        Accuracy {
            mean: values().sum::<f64>() / divided.len() as f64,
            least: values().fold(f64::MAX, f64::min),
            greatest: values().fold(f64::MIN, f64::max),
        }
    };
    Ok(Some(Verdict {
        accuracies: [of(0), of(1)],
    }))
}

fn accuracies(
    captured: &[Sample],
    generated: &[Sample],
    fold_of: impl Fn(&Sample) -> usize + Sync,
) -> Result<[f64; 2], EvaluateError> {
    let people: BTreeSet<usize> = captured.iter().map(|sample| sample.walker).collect();
    let folds: Vec<(usize, usize)> = people.into_iter().enumerate().collect();
    let judged = folds
        .par_iter()
        .map(|(fold, person)| {
            let (own, others) = divide(captured, |sample| sample.walker == *person);
            let (made, other_made) =
                divide(generated, |sample| fold_of(sample) == fold % SEED_FOLDS);
            let judged: Vec<&[f64]> = own.iter().chain(&made).copied().collect();
            let mut scores = [0.0; 2];
            for (score, classifier) in scores.iter_mut().zip(Classifier::ALL) {
                let answers = classifier.judge(&others, &other_made, &judged)?;
                let (of_captured, of_made) = answers.split_at(own.len());
                *score = 0.5 * (share(of_captured, true) + share(of_made, false));
            }
            Ok(scores)
        })
        .collect::<Result<Vec<[f64; 2]>, EvaluateError>>()?;
    let mean = |index: usize| {
        let sum: f64 = judged.iter().map(|scores| scores[index]).sum();
        sum / judged.len().max(1) as f64
    };
    Ok([mean(0), mean(1)])
}

/// Features of the samples that meet a condition, and of the others.
fn divide(samples: &[Sample], is_in: impl Fn(&Sample) -> bool) -> (Vec<&[f64]>, Vec<&[f64]>) {
    let (mut inside, mut outside) = (Vec::new(), Vec::new());
    for sample in samples {
        if is_in(sample) {
            inside.push(sample.features.as_slice());
        } else {
            outside.push(sample.features.as_slice());
        }
    }
    (inside, outside)
}

/// Share of answers that are right; half where there is none to judge.
fn share(answers: &[bool], right: bool) -> f64 {
    if answers.is_empty() {
        return 0.5;
    }
    answers.iter().filter(|answer| **answer == right).count() as f64 / answers.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt as _;

    /// Strides of people, each of whom differs from the others by a manner of this size.
    fn strides(people: usize, manner: f64) -> Vec<Sample> {
        let mut chance = ChaCha8Rng::seed_from_u64(3);
        let mut all = Vec::new();
        for walker in 0..people {
            let own: [f64; 3] = core::array::from_fn(|_| manner * chance.random_range(-1.0..1.0));
            for _ in 0..10 {
                let features = own.map(|own| own + chance.random_range(-1.0..1.0));
                all.push(Sample {
                    walker,
                    features: features.to_vec(),
                });
            }
        }
        all
    }

    #[test]
    fn people_who_walk_alike_are_not_told_apart_and_those_with_manners_are() {
        let scores = |manner: f64| {
            let verdict = people_apart(&strides(6, manner)).expect("sound features");
            verdict.expect("enough people").accuracies
        };
        for (alike, apart) in scores(0.0).into_iter().zip(scores(6.0)) {
            assert!((0.4..0.6).contains(&alike.mean), "{alike:?}");
            assert!(apart.mean > 0.65, "{apart:?}");
            assert!(apart.least < apart.mean && apart.mean < apart.greatest);
        }
    }

    #[test]
    fn three_people_are_too_few_to_be_halved() {
        let verdict = people_apart(&strides(3, 1.0)).expect("sound features");
        assert_eq!(verdict, None);
    }
}
