//! Gain of walker-adaptive training: sharper states, and walkers that it has not seen explained better.

use crate::average::AverageWalk;
use crate::encoded::{EncodedCorpus, number_of};
use crate::error::TrainError;
use crate::progress::Progress;
use crate::sequence::Sequence;
use crate::train::TrainConfig;
use crate::walker_adaptive::{self, WalkerTransform};
use footfall_motion::recording::Recording;
use footfall_prob::gaussian::DiagonalGaussian;
use serde::Serialize;

/// Plain against walker-adaptive training of the same corpus.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainingComparison {
    /// Mean ln variance of the states' Gaussians, plain and walker-adaptive.
    pub log_variance: [f64; 2],
    /// Every walker in turn unseen. Walkers with one recording only are left out.
    pub held_out: Vec<HeldOutWalker>,
}

/// An unseen walker: mean log density of its frames, as recorded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeldOutWalker {
    /// The person.
    pub subject: String,
    /// Number of frames that were scored.
    pub frames: usize,
    /// Under plain training.
    pub plain: f64,
    /// Under plain training, with a transform estimated from the walker's other recordings.
    pub plain_adapted: f64,
    /// Under walker-adaptive training, with a transform estimated in the same way.
    pub adaptive: f64,
}

/// Trains with and without transforms of walkers, on all walkers and with each in turn left out.
///
/// # Errors
/// As [`train_average`](crate::train_average).
pub fn compare_training(
    clips: &[Recording],
    config: &TrainConfig,
    progress: &mut dyn Progress,
) -> Result<TrainingComparison, TrainError> {
    let (corpus, _) = EncodedCorpus::of(clips, config)?.steady();
    let plain = AverageWalk::train(&corpus, &config.em, progress)?;
    let adaptive = walker_adaptive::train(&corpus, &config.em, progress)?.walk;
    let mut held_out = Vec::new();
    for (walker, subject) in subjects(clips).into_iter().enumerate() {
        // A mirrored walk belongs to the same person as its original.
        let is_own = |sequence: &&Sequence| sequence.walker / 2 == walker;
        let own: Vec<Sequence> = corpus
            .iter()
            .filter(|s| is_own(s) && s.walker % 2 == 0)
            .cloned()
            .collect();
        if own.len() < 2 {
            continue;
        }
        let others: Vec<Sequence> = corpus.iter().filter(|s| !is_own(s)).cloned().collect();
        let plain = AverageWalk::train(&others, &config.em, progress)?;
        let adaptive = walker_adaptive::train(&others, &config.em, progress)?.walk;
        let frames: usize = own.iter().map(Sequence::frames).sum();
        let mean = |score: f64| score / frames as f64;
        held_out.push(HeldOutWalker {
            subject: subject.to_owned(),
            frames,
            plain: mean(plain.expect(&own, &own)?.log_likelihood),
            plain_adapted: mean(adapted_score(&plain, &own)?),
            adaptive: mean(adapted_score(&adaptive, &own)?),
        });
    }
    Ok(TrainingComparison {
        log_variance: [mean_log_variance(&plain), mean_log_variance(&adaptive)],
        held_out,
    })
}

/// The subjects in the order in which [`EncodedCorpus`] numbers them.
fn subjects(clips: &[Recording]) -> Vec<&str> {
    let mut subjects: Vec<&str> = Vec::new();
    for clip in clips {
        number_of(clip.subject(), &mut subjects);
    }
    subjects
}

fn mean_log_variance(walk: &AverageWalk) -> f64 {
    let variances = || walk.gaussians().iter().flat_map(DiagonalGaussian::variance);
    variances().map(|variance| variance.ln()).sum::<f64>() / variances().count() as f64
}

/// Log-likelihood of a walker's recordings, each under the transform estimated from the others.
fn adapted_score(walk: &AverageWalk, own: &[Sequence]) -> Result<f64, TrainError> {
    let mut score = 0.0;
    for (unseen, sequence) in own.iter().enumerate() {
        let others: Vec<Sequence> = own
            .iter()
            .enumerate()
            .filter(|(index, _)| *index != unseen)
            .map(|(_, other)| other.clone())
            .collect();
        let transform = WalkerTransform::of_newcomer(walk, &others)?;
        let moved = [transform.apply(sequence)];
        score += walk.expect(&moved, &moved)?.log_likelihood
            + sequence.frames() as f64 * transform.log_determinant();
    }
    Ok(score)
}
