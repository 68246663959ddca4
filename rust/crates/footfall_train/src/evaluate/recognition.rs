//! Division of strides into those seen in training and those judged.

use super::lda::{Labelled, Lda, Shrinkage};
use super::stride_features::{LEAST_SPREAD, Stride};
use super::{Confusion, EvaluateError, Split, Take};
use rayon::prelude::*;

/// One classifier's diet.
pub(super) struct Fold<'a> {
    training: Vec<Labelled<'a>>,
    unseen: Vec<Labelled<'a>>,
}

/// Answers of the classifiers.
pub(super) struct Judged {
    pub(super) real: Confusion,
    pub(super) synthesised: Option<Confusion>,
    /// Mean over the folds.
    pub(super) shrinkage: f64,
}

/// Actual and named class of each stride.
type Answers = Vec<(usize, usize)>;

/// Trains a classifier for each fold; it judges the fold's unseen strides and all synthesised ones.
pub(super) fn recognise(
    folds: &[Fold<'_>],
    synthesised: Option<&[Take]>,
    names: &[String],
) -> Result<Judged, EvaluateError> {
    let synthetic: Option<Vec<Labelled<'_>>> =
        synthesised.map(|recordings| recordings.iter().flat_map(super::labelled).collect());
    let answers: Vec<(f64, Answers, Answers)> = folds
        .par_iter()
        .map(|fold| {
            let lda = Lda::fit(
                &fold.training,
                names.len(),
                LEAST_SPREAD,
                Shrinkage::Automatic,
            )?;
            let judge = |strides: &[Labelled<'_>]| -> Answers {
                let named = |stride: &Labelled<'_>| (stride.class, lda.classify(stride.features));
                strides.iter().map(named).collect()
            };
            let synthetic = synthetic.as_deref().map(judge).unwrap_or_default();
            Ok((lda.shrinkage(), judge(&fold.unseen), synthetic))
        })
        .collect::<Result<_, EvaluateError>>()?;
    let mut judged = Judged {
        real: Confusion::new(names.to_vec()),
        synthesised: synthesised.map(|_| Confusion::new(names.to_vec())),
        shrinkage: 0.0,
    };
    for (shrinkage, real, synthetic) in answers {
        judged.shrinkage += shrinkage / folds.len() as f64;
        for (actual, named) in real {
            judged.real.add(actual, named);
        }
        if let Some(confusion) = &mut judged.synthesised {
            for (actual, named) in synthetic {
                confusion.add(actual, named);
            }
        }
    }
    Ok(judged)
}

/// Fold k leaves out the k-th take of every style that has one.
pub(super) fn take_folds<'a>(
    real: &'a [Take],
    names: &[String],
) -> Result<Vec<Fold<'a>>, EvaluateError> {
    for (style, name) in names.iter().enumerate() {
        if real.iter().filter(|one| one.style == style).count() < 2 {
            return Err(EvaluateError::Split {
                style: name.clone(),
                reason: "it has one take with strides, and none would be left to learn from; use --split half".to_owned(),
            });
        }
    }
    let takes = real.iter().map(|one| one.number + 1).max().unwrap_or(0);
    let strides = |keep: &dyn Fn(usize) -> bool| -> Vec<Labelled<'a>> {
        real.iter()
            .filter(|one| keep(one.number))
            .flat_map(super::labelled)
            .collect()
    };
    Ok((0..takes)
        .map(|left_out| Fold {
            training: strides(&|take| take != left_out),
            unseen: strides(&|take| take == left_out),
        })
        .collect())
}

/// Fold 0 sees the first half of every recording, fold 1 the second.
pub(super) fn half_folds<'a>(
    real: &'a [Take],
    names: &[String],
) -> Result<Vec<Fold<'a>>, EvaluateError> {
    let halves = |part: usize| -> Vec<Labelled<'a>> {
        real.iter()
            .flat_map(|one| {
                let (first, second) = halves_of(&one.strides);
                [first, second][part]
                    .iter()
                    .map(|stride| Labelled {
                        features: &stride.features,
                        class: one.style,
                    })
                    .collect::<Vec<_>>()
            })
            .collect()
    };
    let parts = [halves(0), halves(1)];
    for (style, name) in names.iter().enumerate() {
        if parts
            .iter()
            .any(|part| !part.iter().any(|stride| stride.class == style))
        {
            return Err(EvaluateError::Split {
                style: name.clone(),
                reason: "its recordings are too short to be halved; give it recordings of six steps or more".to_owned(),
            });
        }
    }
    let [first, second] = parts;
    Ok(vec![
        Fold {
            training: first.clone(),
            unseen: second.clone(),
        },
        Fold {
            training: second,
            unseen: first,
        },
    ])
}

/// First and second half of a recording; a stride that reaches from one into the other is in neither.
fn halves_of(strides: &[Stride]) -> (&[Stride], &[Stride]) {
    let Some(middle) = strides.get(strides.len() / 2) else {
        return (&[], &[]);
    };
    let first = strides
        .iter()
        .take_while(|stride| stride.end <= middle.first)
        .count();
    (&strides[..first], &strides[strides.len() / 2..])
}

/// Two parts of a style's recordings, one list of strides for each recording.
pub(super) fn two_parts<'r>(
    real: &[&'r Take],
    split: Split,
) -> (Vec<Vec<&'r Stride>>, Vec<Vec<&'r Stride>>) {
    match split {
        Split::Take => {
            let takes = |rest: usize| {
                let some = real.iter().filter(|one| one.number % 2 == rest);
                some.map(|one| one.strides.iter().collect()).collect()
            };
            (takes(0), takes(1))
        }
        Split::Half => real
            .iter()
            .map(|one| {
                let (first, second) = halves_of(&one.strides);
                (first.iter().collect(), second.iter().collect())
            })
            .unzip(),
    }
}
