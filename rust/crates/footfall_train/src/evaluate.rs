//! Objective evaluation of styles: are they told apart, do they resemble their model, do they move like people?
//!
//! Questions that Tilmanne et al. (2012, section 6) asked a hundred people, asked of measures. A classifier that is trained on strides
//! of real recordings names the style of real strides that it has not seen and of synthesised ones ([`confusion`], the
//! paper's Table 2 and equation 16); synthesised strides are compared with real ones of the style ([`resemblance`]); feet and
//! smoothness are judged by themselves ([`naturalness`]).
//!
//! Modules in suggested reading order: [`stride_features`], [`lda`], [`confusion`], [`resemblance`], [`naturalness`]; [`told_apart`]; [`standing`]; [`response`].

pub mod confusion;
mod error;
pub mod lda;
pub mod naturalness;
mod recognition;
pub mod resemblance;
pub mod response;
pub mod standing;
pub mod stride_features;
pub mod told_apart;

pub use confusion::Confusion;
pub use error::EvaluateError;
pub use resemblance::JointRatios;
pub use stride_features::PHASES;

use footfall_core::{Clip, Pose};
use footfall_motion::steps::Walk;
use lda::{ClassMoments, Labelled};
use rayon::prelude::*;
use recognition::recognise;
use stride_features::{LEAST_SPREAD, Stride, strides};

/// A recording of one style.
#[derive(Clone, Debug, PartialEq)]
pub struct StyledClip {
    /// Style that it shows.
    pub style: String,
    /// The motion, on the canonical body, floor at y = 0.
    pub clip: Clip,
    /// Its walks, in frames of the clip.
    pub walks: Vec<Walk>,
}

impl StyledClip {
    /// A recording without its first `skip_frames` frames (an artificial T-pose, for example).
    pub fn new(style: &str, clip: &Clip, skip_frames: usize, walks: &[Walk]) -> Self {
        let mut walks = walks.to_vec();
        for step in walks.iter_mut().flat_map(|walk| &mut walk.steps) {
            let shift = |frame: usize| frame.saturating_sub(skip_frames);
            (step.first, step.end) = (shift(step.first), shift(step.end));
            step.other_terminal = step.other_terminal.map(shift);
            step.heel_rise = step.heel_rise.map(shift);
            step.take_off = step.take_off.map(shift);
        }
        Self {
            style: style.to_owned(),
            clip: Clip {
                poses: clip.poses.get(skip_frames..).unwrap_or_default().to_vec(),
                ..clip.clone()
            },
            walks,
        }
    }

    /// Each walk as a clip of its own: what stands before, between and after is no gait.
    fn walking(&self) -> Vec<Clip> {
        let span = |walk: &Walk| Some((walk.steps.first()?.first, walk.steps.last()?.end));
        self.walks
            .iter()
            .filter_map(|walk| {
                let (first, end) = span(walk)?;
                let end = end.min(self.clip.poses.len());
                Some(Clip {
                    poses: self.clip.poses.get(first..end)?.to_vec(),
                    ..self.clip.clone()
                })
            })
            .collect()
    }
}

/// Division of real strides into seen and unseen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// Every take in turn is unseen; each style needs two takes.
    Take,
    /// One half of every recording is unseen, then the other.
    Half,
}

/// Measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleEvaluation {
    /// Division of the real strides.
    pub split: Split,
    /// Judgements of real strides that the classifier had not seen.
    pub real: Confusion,
    /// Judgements of the synthesised strides by the same classifiers, each stride once per fold.
    pub synthesised: Option<Confusion>,
    /// By style, in alphabetical order.
    pub styles: Vec<StyleMeasures>,
    /// Mean shrinkage of the classifiers' covariance.
    pub shrinkage: f64,
}

/// Measures of one style.
#[derive(Clone, Debug, PartialEq)]
pub struct StyleMeasures {
    /// Its name.
    pub style: String,
    /// The real recordings.
    pub real: Naturalness,
    /// One part of the real recordings against the other: what nature itself scores.
    pub real_against_real: Resemblance,
    /// The synthesised ones, if there are any of the style.
    pub synthesised: Option<(Naturalness, Resemblance)>,
}

/// Measures of recordings by themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Naturalness {
    /// Number of recordings.
    pub clips: usize,
    /// Number of their strides.
    pub strides: usize,
    /// Median speed of standing feet, m/s.
    pub slip_mps: Option<f64>,
    /// Share of frames in which a foot skates.
    pub skating_ratio: Option<f64>,
    /// Root mean square jerk, m/s³.
    pub jerk: Option<f64>,
    /// Median over the joints of the deviation between steps, radians.
    pub step_variability: Option<f64>,
}

/// Measures of recordings against others of the same style.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Resemblance {
    /// Distance of the mean features in units of the spread within styles.
    pub distance: Option<f64>,
    /// Variance of the joints' motion over the reference's.
    pub variance: JointRatios,
    /// Variability between steps over the reference's.
    pub variability: JointRatios,
}

impl StyleEvaluation {
    /// Recognition of synthesised over that of real strides.
    pub fn ratio(&self) -> Option<f64> {
        let real = self.real.rate().filter(|rate| *rate > 0.0)?;
        Some(self.synthesised.as_ref()?.rate()? / real)
    }

    /// Pearson correlation of the styles' recognition rates, real against synthesised.
    pub fn rate_correlation(&self) -> Option<f64> {
        let synthesised = self.synthesised.as_ref()?;
        let pairs: Vec<(f64, f64)> = (0..self.styles.len())
            .filter_map(|style| {
                Some((self.real.class_rate(style)?, synthesised.class_rate(style)?))
            })
            .collect();
        resemblance::correlation(&pairs)
    }
}

/// A recording with its strides.
struct Recording<'a> {
    style: usize,
    clip: &'a StyledClip,
    /// Which recording of its style.
    take: usize,
    strides: Vec<Stride>,
}

/// Judges real recordings, and synthesised ones against them.
///
/// `split: None` takes [`Split::Take`] when every style has two takes with strides, else [`Split::Half`].
///
/// # Errors
/// [`EvaluateError`] says which style lacks what.
pub fn evaluate_styles(
    real: &[StyledClip],
    synthesised: Option<&[StyledClip]>,
    split: Option<Split>,
) -> Result<StyleEvaluation, EvaluateError> {
    check_finite(real)?;
    check_finite(synthesised.unwrap_or_default())?;
    let all = real.par_iter().map(|clip| strides(&clip.clip, &clip.walks));
    let all: Vec<Vec<Stride>> = all.collect();
    let mut names: Vec<String> = real
        .iter()
        .zip(&all)
        .filter(|(_, strides)| !strides.is_empty())
        .map(|(clip, _)| clip.style.clone())
        .collect();
    names.sort();
    names.dedup();
    if names.len() < 2 {
        return Err(EvaluateError::OneStyle { found: names.len() });
    }
    let real = recordings(real, all, &names);
    let synthesised = match synthesised {
        None => None,
        Some(clips) => Some(synthesised_recordings(clips, &names)?),
    };
    let takes = |style: usize| real.iter().filter(|one| one.style == style).count();
    let split = split.unwrap_or_else(|| {
        if (0..names.len()).all(|style| takes(style) >= 2) {
            Split::Take
        } else {
            Split::Half
        }
    });
    let folds = match split {
        Split::Take => recognition::take_folds(&real, &names)?,
        Split::Half => recognition::half_folds(&real, &names)?,
    };
    let every: Vec<Labelled<'_>> = real.iter().flat_map(labelled).collect();
    let spread = ClassMoments::of(&every, names.len(), LEAST_SPREAD)?.spread;
    let judged = recognise(&folds, synthesised.as_deref(), &names)?;
    let styles = names
        .iter()
        .enumerate()
        .map(|(style, name)| {
            let recordings = (real.as_slice(), synthesised.as_deref());
            measures(style, name, recordings, split, &spread)
        })
        .collect();
    Ok(StyleEvaluation {
        split,
        real: judged.real,
        synthesised: judged.synthesised,
        styles,
        shrinkage: judged.shrinkage,
    })
}

/// Rotations that are no numbers would pass for no rotation at all.
fn check_finite(clips: &[StyledClip]) -> Result<(), EvaluateError> {
    let is_finite = |pose: &Pose| {
        pose.root_position.is_finite() && pose.rotations.iter().all(|turn| turn.is_finite())
    };
    for clip in clips {
        if let Some(frame) = clip.clip.poses.iter().position(|pose| !is_finite(pose)) {
            return Err(EvaluateError::NotFinite {
                style: clip.style.clone(),
                frame,
            });
        }
    }
    Ok(())
}

fn labelled<'a>(recording: &'a Recording<'_>) -> impl Iterator<Item = Labelled<'a>> {
    recording.strides.iter().map(|stride| Labelled {
        features: &stride.features,
        class: recording.style,
    })
}

/// The recordings with strides, numbered within their style.
fn recordings<'a>(
    clips: &'a [StyledClip],
    strides: Vec<Vec<Stride>>,
    names: &[String],
) -> Vec<Recording<'a>> {
    let mut takes = vec![0; names.len()];
    let mut recordings = Vec::new();
    for (clip, strides) in clips.iter().zip(strides) {
        let Ok(style) = names.binary_search(&clip.style) else {
            continue;
        };
        if !strides.is_empty() {
            recordings.push(Recording {
                style,
                clip,
                take: takes[style],
                strides,
            });
            takes[style] += 1;
        }
    }
    recordings
}

fn synthesised_recordings<'a>(
    clips: &'a [StyledClip],
    names: &[String],
) -> Result<Vec<Recording<'a>>, EvaluateError> {
    if let Some(clip) = clips.iter().find(|clip| !names.contains(&clip.style)) {
        return Err(EvaluateError::UnknownStyle {
            style: clip.style.clone(),
            known: names.to_vec(),
        });
    }
    let all = clips
        .par_iter()
        .map(|clip| strides(&clip.clip, &clip.walks));
    let recordings = recordings(clips, all.collect(), names);
    if recordings.is_empty() {
        return Err(EvaluateError::NoSynthesisedStride);
    }
    Ok(recordings)
}

/// The recordings of one style.
fn of_style<'r, 'a>(recordings: &'r [Recording<'a>], style: usize) -> Vec<&'r Recording<'a>> {
    recordings.iter().filter(|one| one.style == style).collect()
}

fn all_strides<'r>(recordings: &[&'r Recording<'_>]) -> Vec<Vec<&'r Stride>> {
    recordings
        .iter()
        .map(|one| one.strides.iter().collect())
        .collect()
}

fn measures(
    style: usize,
    name: &str,
    (real, synthesised): (&[Recording<'_>], Option<&[Recording<'_>]>),
    split: Split,
    spread: &[f64],
) -> StyleMeasures {
    let real = of_style(real, style);
    let (first, second) = recognition::two_parts(&real, split);
    let synthesised = synthesised
        .map(|recordings| of_style(recordings, style))
        .filter(|own| !own.is_empty())
        .map(|own| {
            let resemblance = resemble(&all_strides(&own), &all_strides(&real), spread);
            (naturalness_of(&own), resemblance)
        });
    StyleMeasures {
        style: name.to_owned(),
        real: naturalness_of(&real),
        real_against_real: resemble(&second, &first, spread),
        synthesised,
    }
}

fn resemble(judged: &[Vec<&Stride>], reference: &[Vec<&Stride>], spread: &[f64]) -> Resemblance {
    let (all_judged, all_reference) = (judged.concat(), reference.concat());
    Resemblance {
        distance: resemblance::distance(&all_judged, &all_reference, spread),
        variance: resemblance::variance_ratios(&all_judged, &all_reference),
        variability: resemblance::variability_ratios(judged, reference),
    }
}

fn naturalness_of(recordings: &[&Recording<'_>]) -> Naturalness {
    let walking: Vec<Clip> = recordings
        .iter()
        .flat_map(|one| one.clip.walking())
        .collect();
    let slips: Vec<f64> = walking
        .par_iter()
        .flat_map(naturalness::contact_slips)
        .collect();
    // Long walks count for more than short ones.
    let mean = |values: Vec<Option<f64>>| {
        let known = || {
            values
                .iter()
                .zip(&walking)
                .filter_map(|(value, clip)| Some(((*value)?, clip.duration_secs())))
        };
        let secs: f64 = known().map(|(_, secs)| secs).sum();
        (secs > 0.0).then(|| known().map(|(value, secs)| value * secs).sum::<f64>() / secs)
    };
    let jerks = walking
        .par_iter()
        .map(|clip| naturalness::jerk(clip).map(|jerk| jerk * jerk));
    Naturalness {
        clips: recordings.len(),
        strides: recordings.iter().map(|one| one.strides.len()).sum(),
        slip_mps: resemblance::median(slips),
        skating_ratio: mean(walking.iter().map(naturalness::skating_ratio).collect()),
        jerk: mean(jerks.collect()).map(f64::sqrt),
        step_variability: resemblance::step_variability(&all_strides(recordings))
            .and_then(resemblance::median),
    }
}

#[cfg(test)]
mod tests;
