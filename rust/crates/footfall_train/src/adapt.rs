//! A style from a dozen steps (Tilmanne et al. 2012, section 5.1.3).
//!
//! The average walk's means and variances are moved by linear transforms that many states share, so that a few steps
//! determine them: first one transform for all states, then one for each half of a tree of states, held near its parent's
//! ([`footfall_prob::regression`]). Each state's own frames then refine it (maximum a posteriori). Between re-estimations the
//! style's walks are aligned anew with explicit durations: as whole chains while transforms are estimated, then step by step.

mod spread;
mod transforms;

use crate::EmConfig;
use crate::encoded::{EncodedCorpus, steady_part};
use crate::error::TrainError;
use crate::progress::Progress;
use crate::sequence::Sequence;
use crate::step_hsmm::{DURATION_VARIANCE_FLOOR, StepHsmm, discretised};
use crate::train::{TrainConfig, mean_terminal};
use footfall_core::Side;
use footfall_model::{
    FEATURE_COUNT, GaitModel, GaitStyle, GlobalVarianceModel, Provenance, STATES_PER_STEP,
    StateModel, StepModel,
};
use footfall_motion::recording::Recording;
use footfall_motion::steps::Walk;
use footfall_prob::duration::GaussianDuration;
use footfall_prob::gaussian::DiagonalGaussian;
use footfall_prob::hsmm::HsmmStats;
use footfall_prob::regression::map_estimate;
use transforms::Adapting;

/// Frames that a state's transformed mean and variance count for, against the style's own frames in that state.
const MAP_FRAMES: f64 = 6.0;

/// Segments that a state's transformed duration counts for.
const MAP_SEGMENTS: f64 = 1.5;

/// Rounds of alignment and maximum a posteriori re-estimation.
const MAP_ITERATIONS: usize = 2;

/// Least variance of a feature in a state, as a fraction of the base model's.
const VARIANCE_FLOOR: f64 = 0.02;

/// Fewest steps that show both feet.
const LEAST_STEPS: usize = 2;

/// Estimation of the transforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdaptMethod {
    /// Constrained maximum-likelihood linear regression: one transform for all states, each joint's features mixed only among
    /// themselves, because nothing but the data holds it.
    Cmllr,
    /// Constrained structural maximum a posteriori linear regression: all features mixed, over a tree of states.
    Csmaplr,
}

/// Settings of adaptation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AdaptConfig {
    /// Estimation of the transforms.
    pub method: AdaptMethod,
    /// Number of the clips' first steps to use; all if absent.
    pub steps: Option<usize>,
    /// Use the mirror image of every clip, too: a style whose sides are alike.
    pub mirror: bool,
}

impl AdaptConfig {
    /// Returns the settings that suit a dozen steps best, with the first `steps` of them.
    pub const fn first_steps(steps: usize) -> Self {
        Self {
            method: AdaptMethod::Csmaplr,
            steps: Some(steps),
            mirror: false,
        }
    }
}

/// A style, and measures of its adaptation.
#[derive(Clone, Debug)]
pub struct Adapted {
    /// The style.
    pub style: GaitStyle,
    /// Log-likelihood of the style's frames, less what the prior charges, at every alignment while transforms are estimated;
    /// never falls.
    pub objectives: Vec<f64>,
    /// Log-likelihood of the same frames under the base model, under the transforms, and after the states' own re-estimation.
    pub log_likelihoods: [f64; 3],
    /// Classes of states with transforms of their own: numbers of the states, the left step's first.
    pub classes: Vec<Vec<usize>>,
    /// Frames that were adapted to, at the model's rate.
    pub frames: usize,
}

/// Adapts `base` to the walks of `clips` and names the result `name`. Clips are read as in training: at any frame rate, on the
/// canonical body. `provenance` gets the counts of clips, subjects and steps filled in.
///
/// # Errors
/// [`TrainError`] when the clips hold no two consecutive steps, or the base cannot explain them.
pub fn adapt_style(
    base: &GaitModel,
    clips: &[Recording],
    name: &str,
    config: &AdaptConfig,
    provenance: Provenance,
    progress: &mut dyn Progress,
) -> Result<Adapted, TrainError> {
    base.check()?;
    let chosen = first_steps(clips, config.steps.unwrap_or(usize::MAX))?;
    let encoding = TrainConfig {
        frame_rate_hz: base.frame_rate_hz,
        windows: base.windows,
        mirror: config.mirror,
        em: EmConfig {
            max_iterations: 0,
            min_gain_per_frame: 0.0,
        },
    };
    let encoded = EncodedCorpus::of(&chosen, &encoding)?;
    let (corpus, counts) = encoded.steady();
    let mut adapting = Adapting::new(base, &corpus, config.method)?;
    let (transforms_fit, objectives) = adapting.run(&corpus, progress)?;
    let start = StepHsmm::of(base, adapting.max_duration());
    let durations = adapting.adapted_durations()?;
    let longest = adapting.max_duration();
    let prior = States {
        lengths: lengths(&durations, longest)?,
        hsmm: StepHsmm {
            gaussians: adapting.adapted_gaussians()?,
            durations,
            max_duration: longest,
        },
    };
    let mut states = prior.clone();
    for _ in 0..MAP_ITERATIONS {
        let stats = states.hsmm.expect_in_order(&corpus)?;
        states = prior.refined(&stats, &start)?;
    }
    let log_likelihoods = [
        start.expect_in_order(&corpus)?.log_likelihood,
        transforms_fit,
        states.hsmm.expect_in_order(&corpus)?.log_likelihood,
    ];
    let frames: usize = corpus.iter().map(Sequence::frames).sum();
    let steps: usize = corpus.iter().map(|sequence| sequence.steps.len()).sum();
    let style = GaitStyle {
        name: name.to_owned(),
        base_fingerprint: base.fingerprint()?,
        steps: [
            states.step(Side::Left, mean_terminal(&corpus, Side::Left))?,
            states.step(Side::Right, mean_terminal(&corpus, Side::Right))?,
        ],
        global_variance: global_variance(base, &corpus),
        // Of the recordings that show different steps.
        step_spread: spread::step_spread(base, &encoded.distinct().steady().0),
        speed_mps: mean_speed(&corpus),
        cadence_hz: steps as f64 * base.frame_rate_hz / frames as f64,
        provenance: Provenance {
            clips: counts.clips,
            subjects: counts.subjects,
            steps: distinct_steps(&chosen),
            ..provenance
        },
    };
    style.check()?;
    Ok(Adapted {
        style,
        objectives,
        log_likelihoods,
        classes: adapting.classes(),
        frames,
    })
}

/// Steps that were taken, those of a loop once.
fn distinct_steps(clips: &[Recording]) -> usize {
    let of_clip = |clip: &Recording| {
        let steps: usize = clip.walks.iter().map(|walk| walk.steps.len()).sum();
        steps.div_ceil(clip.repeats())
    };
    clips.iter().map(of_clip).sum()
}

/// Returns true when walks suffice to train a style: two consecutive steps, one of each foot.
pub fn shows_steps(walks: &[Walk]) -> bool {
    walks.iter().any(|walk| walk.steps.len() >= LEAST_STEPS)
}

/// The clips with only their first `limit` steps in full stride.
fn first_steps(clips: &[Recording], limit: usize) -> Result<Vec<Recording>, TrainError> {
    if limit < LEAST_STEPS {
        return Err(TrainError::TooFewSteps { found: limit });
    }
    let mut left = limit;
    let mut found = 0;
    let mut chosen = Vec::new();
    for clip in clips {
        let steady: Vec<Walk> = clip.walks.iter().map(steady_part).collect();
        let total: usize = steady.iter().map(|walk| walk.steps.len()).sum();
        found += total;
        // The rounds of a loop show the same steps: they count once, and no more rounds are taken than a longer recording has steps.
        let round = total.div_ceil(clip.repeats()).max(1);
        let rounds = (limit / round).clamp(1, clip.repeats());
        let mut budget = left.min(round) * rounds;
        let mut walks = Vec::new();
        for mut walk in steady {
            walk.steps.truncate(budget);
            if walk.steps.len() >= LEAST_STEPS {
                budget -= walk.steps.len();
                left = left.saturating_sub(walk.steps.len().div_ceil(rounds));
                walks.push(walk);
            }
        }
        if !walks.is_empty() {
            let mut taken = clip.clone();
            taken.walks = walks;
            taken.retargeted.report.repeats = rounds;
            chosen.push(taken);
        }
    }
    if chosen.is_empty() {
        return Err(match found {
            0 => TrainError::NoSteps,
            found => TrainError::TooFewSteps { found },
        });
    }
    Ok(chosen)
}

/// Both steps' states with Gaussians of their own.
#[derive(Clone, Debug)]
struct States {
    hsmm: StepHsmm,
    /// Mean and variance of the durations themselves, which is what the generator plays.
    lengths: Vec<[f64; 2]>,
}

impl StepHsmm {
    /// The states of a model.
    fn of(base: &GaitModel, max_duration: usize) -> Self {
        let states = || base.steps.iter().flat_map(|step| &step.states);
        Self {
            gaussians: states()
                .filter_map(|s| DiagonalGaussian::new(s.mean.clone(), s.variance.clone()).ok())
                .collect(),
            durations: states()
                .map(|s| GaussianDuration {
                    mean: s.duration_mean,
                    variance: s.duration_variance,
                })
                .collect(),
            max_duration,
        }
    }
}

impl States {
    /// These states, each moved towards what it saw.
    fn refined(&self, stats: &HsmmStats, base: &StepHsmm) -> Result<Self, TrainError> {
        let longest = self.hsmm.max_duration;
        let gaussians = self
            .hsmm
            .gaussians
            .iter()
            .zip(&stats.emissions)
            .zip(&base.gaussians)
            .map(|((prior, seen), base)| {
                let found = map_estimate(prior, seen, MAP_FRAMES)?;
                let floored = found.variance().iter().zip(base.variance());
                let variance = floored.map(|(v, b)| v.max(VARIANCE_FLOOR * b)).collect();
                Ok(DiagonalGaussian::new(found.mean().to_vec(), variance)?)
            })
            .collect::<Result<_, TrainError>>()?;
        let mut durations = self.hsmm.durations.clone();
        let mut lengths = self.lengths.clone();
        for ((duration, length), seen) in
            durations.iter_mut().zip(&mut lengths).zip(&stats.durations)
        {
            if seen.weight() > 0.0 {
                *duration = seen.estimate(longest, DURATION_VARIANCE_FLOOR)?;
                let own = duration.discretise(longest)?;
                let share = seen.weight() / (MAP_SEGMENTS + seen.weight());
                let [prior, prior_variance] = *length;
                let mean = prior + share * (own.mean() - prior);
                let spread = |variance: f64, of: f64| variance + (of - mean).powi(2);
                let variance = (1.0 - share) * spread(prior_variance, prior)
                    + share * spread(own.variance(), own.mean());
                *length = [mean, variance];
            }
        }
        Ok(Self {
            hsmm: StepHsmm {
                gaussians,
                durations,
                max_duration: longest,
            },
            lengths,
        })
    }

    fn step(&self, side: Side, other_terminal: f64) -> Result<StepModel, TrainError> {
        let first = side.index() * STATES_PER_STEP;
        let states = (first..first + STATES_PER_STEP)
            .map(|index| {
                let [duration_mean, duration_variance] = self.lengths[index];
                Ok(StateModel {
                    mean: self.hsmm.gaussians[index].mean().to_vec(),
                    variance: self.hsmm.gaussians[index].variance().to_vec(),
                    duration_mean,
                    duration_variance: duration_variance.max(DURATION_VARIANCE_FLOOR),
                })
            })
            .collect::<Result<_, TrainError>>()?;
        Ok(StepModel {
            states,
            other_terminal,
        })
    }
}

/// Mean and variance of durations as far as they can be.
fn lengths(durations: &[GaussianDuration], longest: usize) -> Result<Vec<[f64; 2]>, TrainError> {
    let possible = discretised(durations, longest)?;
    Ok(possible
        .iter()
        .map(|duration| [duration.mean(), duration.variance()])
        .collect())
}

/// The mean of the style's walks, with the base's relative spread.
fn global_variance(base: &GaitModel, corpus: &[Sequence]) -> GlobalVarianceModel {
    let frames: f64 = corpus.iter().map(|sequence| sequence.frames() as f64).sum();
    let mut mean = vec![0.0; FEATURE_COUNT];
    for sequence in corpus {
        let share = sequence.frames() as f64 / frames;
        for (mean, variance) in mean.iter_mut().zip(sequence.variance()) {
            *mean += share * variance;
        }
    }
    let known = &base.global_variance;
    for (mean, base) in mean.iter_mut().zip(&known.mean) {
        // A joint that the recording holds still may move a little all the same.
        *mean = mean.max(1e-3 * base);
    }
    let variance = (0..FEATURE_COUNT)
        .map(|dim| known.variance[dim] * (mean[dim] / known.mean[dim]).powi(2))
        .collect();
    GlobalVarianceModel { mean, variance }
}

/// Mean speed of walks, m/s.
pub(crate) fn mean_speed(corpus: &[Sequence]) -> f64 {
    let frames: f64 = corpus.iter().map(|sequence| sequence.frames() as f64).sum();
    let way: f64 = corpus
        .iter()
        .map(|sequence| sequence.speed_mps() * sequence.frames() as f64)
        .sum();
    way / frames
}

#[cfg(test)]
pub(crate) mod tests;
