//! Generated walks or runs beside captured ones: can a classifier tell them apart, and by what?
//!
//! Strides of both are reduced to the swing of fourteen parts of the body, low-passed at 6 Hz so that the noise of markers does not
//! count. Two classifiers learn which strides were captured, from some people and some seeds, and judge others
//! ([`judge`](folds::judge)). People differ from each other too, so the yardstick is what people score in the generator's place
//! ([`people_apart`]), not 0.5. Beside the verdict stand measures that say where a difference lies: [`detail`] of 3 to
//! 6 Hz by part, [`root`] (surge, limp and bob of the hips), [`posture`] (knees, pitch of the feet), [`bouts`] (speed, cadence, flight) and
//! [`gait`] (these and slip over all walkers).
//!
//! Modules in the order in which data flows: [`bouts`], [`gait`], [`swings`], [`features`], [`classifiers`], [`folds`]; [`detail`], [`root`], [`posture`].

pub mod bouts;
pub mod classifiers;
pub mod detail;
pub mod features;
pub mod folds;
pub mod gait;
pub mod posture;
pub mod root;
pub mod swings;

use crate::evaluate::EvaluateError;
use bouts::{Bout, Gait};
use core::ops::RangeInclusive;
use detail::PartDetail;
use features::View;
use folds::{Sample, Verdict};
use footfall_core::Clip;
use footfall_motion::steps::Walk;
use gait::GaitMeasures;
use posture::Posture;
use rayon::prelude::*;
use root::RootHarmonics;
use swings::{StrideSwings, stride_swings};

/// Walking and running of one captured person, or of one seed of a generator.
#[derive(Clone, Debug)]
pub struct Walker {
    /// Name of the person, or number of the seed.
    pub name: String,
    /// Recordings on the canonical body with the walks that are judged.
    pub clips: Vec<(Clip, Vec<Walk>)>,
    /// Speed that was asked of a generator, m/s.
    pub asked_mps: Option<f64>,
}

impl Walker {
    /// The walker with only the parts in a gait and, where a range is given, at speeds within it.
    #[must_use]
    pub fn in_gait(mut self, gait: Gait, speeds: Option<&RangeInclusive<f64>>) -> Self {
        for (clip, walks) in &mut self.clips {
            *walks = gait.parts(clip, walks);
            walks.retain(|walk| {
                let is_in = |range: &RangeInclusive<f64>| {
                    Bout::of(clip, walk).is_some_and(|bout| range.contains(&bout.speed_mps))
                };
                speeds.is_none_or(is_in)
            });
        }
        self
    }
}

/// Measures of captured and generated walks side by side.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Captured strides, generated strides.
    pub strides: [usize; 2],
    /// Captured people with strides, generated seeds with strides.
    pub walkers: [usize; 2],
    /// Classifiers on each [`View`], in the order of [`View::ALL`].
    pub told_apart: Vec<(View, Verdict)>,
    /// Detail of 3 to 6 Hz by part: captured, generated.
    pub detail: Vec<(&'static str, [PartDetail; 2])>,
    /// Harmonics of the hips: captured, generated.
    pub root: [RootHarmonics; 2],
    /// Knees and feet: captured, generated.
    pub posture: [Posture; 2],
    /// Speed, cadence, flight and slip: captured, generated.
    pub gait: [GaitMeasures; 2],
}

/// Compares generated walks with captured ones, all of one gait.
///
/// # Errors
/// [`EvaluateError::TooFewWalkers`] with fewer than three people or seeds that show a stride, and errors of the classifiers.
pub fn compare(
    captured: &[Walker],
    generated: &[Walker],
    gait: Gait,
) -> Result<Comparison, EvaluateError> {
    let measures = [captured, generated].map(GaitMeasures::of);
    let sides = [
        ("captured", strides_of(captured, gait)),
        ("generated", strides_of(generated, gait)),
    ];
    for (kind, walkers) in &sides {
        if walkers.len() < LEAST_WALKERS {
            return Err(EvaluateError::TooFewWalkers {
                kind,
                found: walkers.len(),
                least: LEAST_WALKERS,
            });
        }
    }
    let [captured, generated] = sides.map(|(_, walkers)| walkers);
    let told_apart = View::ALL
        .into_par_iter()
        .map(|view| {
            let (people, seeds) = (samples(&captured, view), samples(&generated, view));
            Ok((view, folds::judge(&people, &seeds)?))
        })
        .collect::<Result<_, EvaluateError>>()?;
    let both = [&captured, &generated];
    let count = |walkers: &[Vec<StrideSwings>]| walkers.iter().map(Vec::len).sum();
    Ok(Comparison {
        strides: both.map(|walkers| count(walkers)),
        walkers: both.map(Vec::len),
        told_apart,
        detail: detail::by_part(both),
        root: both.map(|walkers| RootHarmonics::of(walkers.iter().flatten())),
        posture: both.map(|walkers| Posture::of(walkers.iter().flatten())),
        gait: measures,
    })
}

/// Scores of captured people in the generator's place ([`folds::people_apart`]) on each [`View`], in the order of [`View::ALL`].
///
/// # Errors
/// Errors of the classifiers.
pub fn people_apart(
    captured: &[Walker],
    gait: Gait,
) -> Result<Vec<Option<Verdict>>, EvaluateError> {
    let people = strides_of(captured, gait);
    View::ALL
        .into_par_iter()
        .map(|view| folds::people_apart(&samples(&people, view)))
        .collect()
}

/// Walkers fewer than this cannot be divided into those learned from and those judged.
const LEAST_WALKERS: usize = 3;

/// Strides of each walker who shows any.
fn strides_of(walkers: &[Walker], gait: Gait) -> Vec<Vec<StrideSwings>> {
    let of = |walker: &Walker| -> Vec<StrideSwings> {
        let clips = walker.clips.iter();
        clips
            .flat_map(|(clip, walks)| stride_swings(clip, walks, gait))
            .collect()
    };
    let all: Vec<Vec<StrideSwings>> = walkers.par_iter().map(of).collect();
    all.into_iter()
        .filter(|strides| !strides.is_empty())
        .collect()
}

fn samples(walkers: &[Vec<StrideSwings>], view: View) -> Vec<Sample> {
    let of = |(walker, strides): (usize, &Vec<StrideSwings>)| {
        let sample = |stride: &StrideSwings| Sample {
            walker,
            features: features::of(stride, view),
        };
        strides.iter().map(sample).collect::<Vec<_>>()
    };
    walkers.iter().enumerate().flat_map(of).collect()
}
