//! The average walk from labelled clips, as one function.

use crate::average::{AverageWalk, EmConfig};
use crate::average_body::average_body;
use crate::contexts::{self, ContextReport};
use crate::dataset::{EncodeConfig, encode_clip};
use crate::differences;
use crate::error::TrainError;
use crate::fine_motion;
use crate::progress::{Progress, advance};
use crate::sequence::Sequence;
use crate::walker_adaptive::{self, WalkerAdaptive, WalkerTransform};
use footfall_core::{Clip, Side, StepPosition};
use footfall_model::{FEATURE_COUNT, GaitModel, GlobalVarianceModel, Provenance, StepModel};
use footfall_motion::corpus::CorpusClip;
use footfall_motion::retarget::Retargeted;
use footfall_motion::steps::{Walk, running_parts};
use footfall_prob::windows::Windows;

/// Least spread (relative to the mean, squared) of the global variance: a corpus of few walks knows it badly.
const GLOBAL_VARIANCE_SPREAD: f64 = 0.01;

/// Least global variance of a feature, rad².
const GLOBAL_VARIANCE_FLOOR: f64 = 1e-7;

/// A clip on the canonical body with its steps marked.
#[derive(Clone, Debug)]
pub struct TrainingClip {
    /// Who walks.
    pub subject: String,
    /// The motion.
    pub clip: Clip,
    /// Leading frames to leave out: an artificial T-pose, for example.
    pub skip_frames: usize,
    /// The walks in the clip, in its own frames.
    pub walks: Vec<Walk>,
    /// Number of times that the clip shows the same steps: more than once for a loop that was unrolled.
    pub repeats: usize,
}

impl TrainingClip {
    /// Reads of a recording what training needs.
    pub fn new(subject: &str, motion: &Retargeted, walks: &[Walk]) -> Self {
        Self {
            subject: subject.to_owned(),
            clip: motion.clip.clone(),
            skip_frames: motion.first_frame,
            walks: walks.to_vec(),
            repeats: motion.report.repeats,
        }
    }

    /// The same recording for who learns from it how people run.
    #[must_use]
    pub fn running(mut self) -> Self {
        self.walks = running_parts(&self.clip, &self.walks);
        self
    }
}

impl From<&CorpusClip> for TrainingClip {
    fn from(clip: &CorpusClip) -> Self {
        Self::new(clip.row.subject(), &clip.retargeted, &clip.walks)
    }
}

/// Settings of training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainConfig {
    /// Frames per second of the model.
    pub frame_rate_hz: f64,
    /// Time differences of the observations.
    pub windows: Windows,
    /// Whether every walk is also used with left and right exchanged, which makes the average walk symmetric.
    pub mirror: bool,
    /// When to stop.
    pub em: EmConfig,
}

/// A trained model and how training went.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The average walk.
    pub model: GaitModel,
    /// Total log-likelihood of the corpus at every iteration; never falls.
    pub log_likelihoods: Vec<f64>,
    /// Log-likelihood of the corpus as recorded, the walkers' transforms counted, after every round in which they were estimated anew.
    pub adaptive_log_likelihoods: Vec<f64>,
    /// Which of the ten contexts of a step share a model.
    pub contexts: ContextReport,
    /// Frames that were trained on, mirrored ones included.
    pub frames: usize,
}

/// Trains the average walk. `provenance` gets the counts of clips, subjects and steps filled in.
///
/// # Errors
/// [`TrainError`] when the clips hold too few steps or cannot be explained.
pub fn train_average(
    clips: &[TrainingClip],
    config: &TrainConfig,
    provenance: Provenance,
    progress: &mut dyn Progress,
) -> Result<Trained, TrainError> {
    let (corpus, _) = encode(clips, config)?;
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
    let (whole, counts) = encode_all(clips, config, Clone::clone)?;
    let (middles, _) = encode_all(clips, config, steady_part)?;
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
    Ok(Trained {
        model,
        log_likelihoods: walk.log_likelihoods.clone(),
        adaptive_log_likelihoods,
        contexts: context_report,
        frames: corpus.iter().map(Sequence::frames).sum(),
    })
}

pub(crate) struct Counts {
    pub(crate) clips: usize,
    pub(crate) subjects: usize,
    pub(crate) steps: usize,
}

/// The steady walks of a corpus.
///
/// A clip that shows how a walk starts or ends is short of steady steps: it teaches the ends, and only where there is no
/// other also the middle.
pub(crate) fn encode(
    clips: &[TrainingClip],
    config: &TrainConfig,
) -> Result<(Vec<Sequence>, Counts), TrainError> {
    let (steady, edges) = split(clips);
    let found = encode_walks(&steady, config, Clone::clone)?;
    if found.0.is_empty() {
        return encode_walks(&edges, config, steady_part);
    }
    Ok(found)
}

/// A part of all walks; walkers have the numbers that they have in [`encode`].
fn encode_all(
    clips: &[TrainingClip],
    config: &TrainConfig,
    part: fn(&Walk) -> Walk,
) -> Result<(Vec<Sequence>, Counts), TrainError> {
    let (steady, edges) = split(clips);
    encode_walks(&[steady, edges].concat(), config, part)
}

/// The clips whose walks are steady throughout, and those that show an end.
fn split(clips: &[TrainingClip]) -> (Vec<&TrainingClip>, Vec<&TrainingClip>) {
    let is_steady = |walk: &Walk| steady_part(walk).steps.len() == walk.steps.len();
    clips
        .iter()
        .partition(|clip| clip.walks.iter().all(is_steady))
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

/// The part of every walk that `part` cuts out, and its mirror image if the settings ask for it.
fn encode_walks(
    clips: &[&TrainingClip],
    config: &TrainConfig,
    part: fn(&Walk) -> Walk,
) -> Result<(Vec<Sequence>, Counts), TrainError> {
    let encoding = EncodeConfig {
        frame_rate_hz: config.frame_rate_hz,
        windows: config.windows,
    };
    let mut subjects: Vec<&str> = Vec::new();
    let mut corpus = Vec::new();
    let mut used = 0;
    for clip in clips {
        let walker = subjects
            .iter()
            .position(|subject| *subject == clip.subject)
            .unwrap_or_else(|| {
                subjects.push(&clip.subject);
                subjects.len() - 1
            });
        let walks: Vec<Walk> = clip.walks.iter().map(part).collect();
        let sequences = encode_clip(&clip.clip, clip.skip_frames, &walks, 2 * walker, &encoding)?;
        used += usize::from(!sequences.is_empty());
        for sequence in sequences {
            if config.mirror {
                corpus.push(sequence.mirrored(2 * walker + 1));
            }
            corpus.push(sequence);
        }
    }
    let original = corpus.iter().filter(|sequence| sequence.walker % 2 == 0);
    let counts = Counts {
        clips: used,
        subjects: subjects.len(),
        steps: original.map(|sequence| sequence.steps.len()).sum(),
    };
    Ok((corpus, counts))
}

/// A walk without the steps in which it starts and stops.
pub(crate) fn steady_part(walk: &Walk) -> Walk {
    let is_edge = |position| matches!(position, StepPosition::First | StepPosition::Last);
    Walk {
        steps: walk
            .steps
            .iter()
            .filter(|step| !is_edge(step.position))
            .copied()
            .collect(),
    }
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
