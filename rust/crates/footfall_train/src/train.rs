//! Training of the average walk, as one function.

use crate::average::{AverageWalk, EmConfig};
use crate::average_body::average_body;
use crate::contexts::{self, ContextReport};
use crate::differences;
use crate::encoded::{EncodedCorpus, steady_part};
use crate::error::TrainError;
use crate::fine_motion;
use crate::level_heads;
use crate::progress::{Progress, advance};
use crate::sequence::Sequence;
use crate::walker_adaptive::{self, WalkerAdaptive, WalkerTransform};
use footfall_core::Side;
use footfall_model::{FEATURE_COUNT, GaitModel, GlobalVarianceModel, Provenance, StepModel};
use footfall_motion::recording::Recording;
use footfall_prob::windows::Windows;

/// Smallest relative variance of the global variance: a small corpus does not determine it.
const GLOBAL_VARIANCE_SPREAD: f64 = 0.01;

/// Least global variance of a feature, rad².
const GLOBAL_VARIANCE_FLOOR: f64 = 1e-7;

/// Settings of training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainConfig {
    /// Frames per second of the model.
    pub frame_rate_hz: f64,
    /// Time differences of the observations.
    pub windows: Windows,
    /// True when every walk is also used with left and right exchanged, which makes the average walk symmetric.
    pub mirror: bool,
    /// Criterion to stop.
    pub em: EmConfig,
}

/// A trained model, and measures of its training.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The average walk.
    pub model: GaitModel,
    /// Total log-likelihood of the corpus at every iteration; never falls.
    pub log_likelihoods: Vec<f64>,
    /// Log-likelihood of the corpus as recorded, the walkers' transforms counted, after every round in which they were estimated anew.
    pub adaptive_log_likelihoods: Vec<f64>,
    /// Contexts of a step, of ten, that share a model.
    pub contexts: ContextReport,
    /// Frames that were trained on, mirrored ones included.
    pub frames: usize,
}

/// Trains the average walk. `provenance` gets the counts of clips, subjects and steps filled in.
///
/// # Errors
/// [`TrainError`] when the clips hold too few steps or cannot be explained.
pub fn train_average(
    clips: &[Recording],
    config: &TrainConfig,
    provenance: Provenance,
    progress: &mut dyn Progress,
) -> Result<Trained, TrainError> {
    let mut trained = train_gait(clips, config, provenance, progress)?;
    if let Some(fine) = &mut trained.model.fine {
        fine_motion::restore_edges(fine);
    }
    Ok(trained)
}

/// Trains as [`train_average`] does, but leaves the fine motion as estimated. Runs need that: stronger detail of their trunks throws their heads.
pub(crate) fn train_gait(
    clips: &[Recording],
    config: &TrainConfig,
    provenance: Provenance,
    progress: &mut dyn Progress,
) -> Result<Trained, TrainError> {
    let recorded: Vec<Recording> = clips.iter().map(Recording::with_head_as_recorded).collect();
    let encoded = EncodedCorpus::of(&recorded, config)?;
    let (corpus, _) = encoded.steady();
    if corpus.is_empty() {
        return Err(TrainError::NoSteps);
    }
    let WalkerAdaptive {
        walk,
        aligned,
        transforms,
        log_likelihoods: adaptive_log_likelihoods,
    } = walker_adaptive::train(&corpus, &config.em, progress)?;
    let step = |side| -> Result<StepModel, TrainError> {
        Ok(StepModel {
            states: walk.states(side)?,
            other_terminal: mean_terminal(&corpus, side),
        })
    };
    let steps = [step(Side::Left)?, step(Side::Right)?];
    advance(progress, "differences between walkers", 0, 0)?;
    let boundaries: Vec<Vec<usize>> = aligned
        .iter()
        .map(|sequence| walk.align(sequence))
        .collect::<Result<_, _>>()?;
    let differences = differences::estimate(&steps, &corpus, &boundaries, config.frame_rate_hz);
    let (speed, variation) = (differences.speed, differences.variation);
    let (whole, counts) = encoded.all(Clone::clone);
    let (middles, _) = encoded.all(steady_part);
    let whole = as_average_walkers(&walk, &transforms, &corpus, &middles, &whole)?;
    advance(progress, "ends of walks", 0, 0)?;
    let (contexts, context_report) = contexts::estimate(&walk, &steps, &speed, &whole)?;
    let mut model = GaitModel {
        frame_rate_hz: config.frame_rate_hz,
        skeleton: average_body(clips, config.mirror),
        windows: config.windows,
        steps,
        global_variance: global_variance(&corpus),
        speed,
        variation,
        contexts,
        fine: None,
        standing: None,
        running: None,
        jump: None,
        crouch: None,
        provenance: Provenance {
            clips: counts.clips,
            subjects: counts.subjects,
            steps: counts.steps,
            ..provenance
        },
    };
    advance(progress, "fine motion", 0, 0)?;
    model.fine = fine_motion::estimate(&model, &corpus, &boundaries, &differences.walker_weights)?;
    level_heads::level(&mut model, clips);
    Ok(Trained {
        model,
        log_likelihoods: walk.log_likelihoods.clone(),
        adaptive_log_likelihoods,
        contexts: context_report,
        frames: corpus.iter().map(Sequence::frames).sum(),
    })
}

/// Sequences as those of the average walker; the transform of a walker whom `trained` does not show is estimated from the
/// middles of the walks.
fn as_average_walkers(
    walk: &AverageWalk,
    transforms: &[WalkerTransform],
    trained: &[Sequence],
    middles: &[Sequence],
    sequences: &[Sequence],
) -> Result<Vec<Sequence>, TrainError> {
    let walkers = sequences.iter().map(|s| s.walker + 1).max().unwrap_or(0);
    let mut aligned = Vec::with_capacity(sequences.len());
    for walker in 0..walkers {
        let of_walker = |sequences: &[Sequence]| -> Vec<Sequence> {
            let own = sequences.iter().filter(|s| s.walker == walker);
            own.cloned().collect()
        };
        let is_known = trained.iter().any(|s| s.walker == walker);
        let transform = match transforms.get(walker) {
            Some(transform) if is_known => transform.clone(),
            _ => WalkerTransform::of_newcomer(walk, &of_walker(middles))?,
        };
        aligned.extend(
            of_walker(sequences)
                .iter()
                .map(|sequence| transform.apply(sequence)),
        );
    }
    Ok(aligned)
}

pub(crate) fn mean_terminal(corpus: &[Sequence], side: Side) -> f64 {
    let fractions: Vec<f64> = corpus
        .iter()
        .flat_map(|sequence| &sequence.steps)
        .filter(|step| step.side == side)
        .filter_map(|step| step.other_terminal)
        .collect();
    // A fifth of a step is what people do: what is left when no clip shows a foot leaving the ground.
    if fractions.is_empty() {
        return 0.2;
    }
    fractions.iter().sum::<f64>() / fractions.len() as f64
}

/// The average walk swings as far as walks do on average: a mean of variances would be that of the few who swing farthest.
fn global_variance(corpus: &[Sequence]) -> GlobalVarianceModel {
    let rows: Vec<Vec<f64>> = corpus.iter().map(Sequence::variance).collect();
    let count = rows.len() as f64;
    let mean: Vec<f64> = (0..FEATURE_COUNT)
        .map(|dim| {
            let sum: f64 = rows.iter().map(|row| row[dim].sqrt()).sum();
            (sum / count).powi(2).max(GLOBAL_VARIANCE_FLOOR)
        })
        .collect();
    let variance = (0..FEATURE_COUNT)
        .map(|dim| {
            let sum: f64 = rows.iter().map(|row| (row[dim] - mean[dim]).powi(2)).sum();
            (sum / count).max(GLOBAL_VARIANCE_SPREAD * mean[dim] * mean[dim])
        })
        .collect();
    GlobalVarianceModel { mean, variance }
}
