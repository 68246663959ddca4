//! Objective evaluation of styles: classification, likeness to their model and to human motion.
//!
//! Questions that Tilmanne et al. (2012, section 6) asked a hundred people, asked of measures. A classifier that is trained on strides
//! of real recordings names the style of real strides that it has not seen and of synthesised ones ([`confusion`], the
//! paper's Table 2 and equation 16); synthesised strides are compared with real ones of the style ([`resemblance`]); feet and
//! smoothness are judged by themselves ([`naturalness`]).
//!
//! Modules in suggested reading order: [`stride_features`], [`lda`], [`confusion`], [`resemblance`], [`naturalness`]; [`told_apart`]; [`standing`]; [`response`].
//!
//! Reports that the command line prints and the studio draws are typed, and serialise to the JSON of `footfall evaluate`: [`style_report`], [`contacts`],
//! [`dynamics`], [`imu`], [`training`]. Evaluations that generate walks belong to the command line, which has a generator.

pub mod confusion;
pub mod contacts;
pub mod dynamics;
mod error;
pub mod imu;
pub mod lda;
pub mod naturalness;
mod recognition;
pub mod resemblance;
pub mod response;
pub mod standing;
pub mod stride_features;
pub mod style_report;
mod take;
pub mod told_apart;
pub mod training;

pub use confusion::Confusion;
pub use error::EvaluateError;
pub use resemblance::JointRatios;
pub use stride_features::PHASES;

use footfall_core::{Clip, Pose};
use footfall_motion::recording::Recording;
use lda::{ClassMoments, Labelled};
use rayon::prelude::*;
use recognition::recognise;
use serde::Serialize;
use stride_features::{LEAST_SPREAD, Stride};
use take::{Moving, Take};

/// Division of real strides into seen and unseen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    #[serde(rename = "jerk_mps3")]
    pub jerk: Option<f64>,
    /// Median over the joints of the deviation between steps, radians.
    #[serde(rename = "step_variability_rad")]
    pub step_variability: Option<f64>,
}

/// Measures of recordings against others of the same style.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Resemblance {
    /// Distance of the mean features in units of the spread within styles.
    pub distance: Option<f64>,
    /// Variance of the joints' motion over the reference's.
    #[serde(rename = "variance_ratio")]
    pub variance: JointRatios,
    /// Variability between steps over the reference's.
    #[serde(rename = "step_variability_ratio")]
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

/// Judges real recordings, and synthesised ones against them.
///
/// `split: None` takes [`Split::Take`] when every style has two takes with strides, else [`Split::Half`].
///
/// # Errors
/// [`EvaluateError`] says which style lacks what.
pub fn evaluate_styles(
    real: &[Recording],
    synthesised: Option<&[Recording]>,
    split: Option<Split>,
) -> Result<StyleEvaluation, EvaluateError> {
    check_finite(real)?;
    check_finite(synthesised.unwrap_or_default())?;
    let all = strides_of(real);
    let mut names: Vec<String> = real
        .iter()
        .zip(&all)
        .filter(|(_, (_, strides))| !strides.is_empty())
        .map(|(recording, _)| recording.style().to_owned())
        .collect();
    names.sort();
    names.dedup();
    if names.len() < 2 {
        return Err(EvaluateError::OneStyle { found: names.len() });
    }
    let real = takes(real, all, &names);
    let synthesised = match synthesised {
        None => None,
        Some(recordings) => Some(synthesised_takes(recordings, &names)?),
    };
    let takes_of = |style: usize| real.iter().filter(|one| one.style == style).count();
    let split = split.unwrap_or_else(|| {
        if (0..names.len()).all(|style| takes_of(style) >= 2) {
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
fn check_finite(recordings: &[Recording]) -> Result<(), EvaluateError> {
    let is_finite = |pose: &Pose| {
        pose.root_position.is_finite() && pose.rotations.iter().all(|turn| turn.is_finite())
    };
    for recording in recordings {
        let mut poses = recording.clip().poses.iter();
        if let Some(frame) = poses.position(|pose| !is_finite(pose)) {
            return Err(EvaluateError::NotFinite {
                style: recording.style().to_owned(),
                frame,
            });
        }
    }
    Ok(())
}

fn labelled(take: &Take) -> impl Iterator<Item = Labelled<'_>> {
    take.strides.iter().map(|stride| Labelled {
        features: &stride.features,
        class: take.style,
    })
}

/// The motion proper of each recording, and its strides.
fn strides_of(recordings: &[Recording]) -> Vec<(Moving, Vec<Stride>)> {
    let measured = recordings.par_iter().map(|recording| {
        let motion = Moving::of(recording);
        let strides = motion.strides();
        (motion, strides)
    });
    measured.collect()
}

/// The recordings with strides, numbered within their style.
fn takes(
    recordings: &[Recording],
    measured: Vec<(Moving, Vec<Stride>)>,
    names: &[String],
) -> Vec<Take> {
    let mut counts = vec![0; names.len()];
    let mut takes = Vec::new();
    for (recording, (motion, strides)) in recordings.iter().zip(measured) {
        let named = names.binary_search_by(|name| name.as_str().cmp(recording.style()));
        let Ok(style) = named else {
            continue;
        };
        if !strides.is_empty() {
            takes.push(Take {
                style,
                motion,
                number: counts[style],
                strides,
            });
            counts[style] += 1;
        }
    }
    takes
}

fn synthesised_takes(
    recordings: &[Recording],
    names: &[String],
) -> Result<Vec<Take>, EvaluateError> {
    let is_known = |style: &str| names.iter().any(|name| name == style);
    if let Some(unknown) = recordings.iter().find(|one| !is_known(one.style())) {
        return Err(EvaluateError::UnknownStyle {
            style: unknown.style().to_owned(),
            known: names.to_vec(),
        });
    }
    let takes = takes(recordings, strides_of(recordings), names);
    if takes.is_empty() {
        return Err(EvaluateError::NoSynthesisedStride);
    }
    Ok(takes)
}

/// The recordings of one style.
fn of_style(takes: &[Take], style: usize) -> Vec<&Take> {
    takes.iter().filter(|one| one.style == style).collect()
}

fn all_strides<'r>(takes: &[&'r Take]) -> Vec<Vec<&'r Stride>> {
    takes
        .iter()
        .map(|one| one.strides.iter().collect())
        .collect()
}

fn measures(
    style: usize,
    name: &str,
    (real, synthesised): (&[Take], Option<&[Take]>),
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

fn naturalness_of(recordings: &[&Take]) -> Naturalness {
    let walking: Vec<Clip> = recordings
        .iter()
        .flat_map(|one| one.motion.walking())
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
