//! True hip joints of a person, from the bending of the knees.
//!
//! Skeletons are fitted to markers, and a hip joint has no marker of its own: fits misplace it by centimetres, in the same way
//! in all recordings of a person. The ankle stays in place, so the error shows in the knee: a hip that is 1 cm too
//! low bends a nearly straight leg by 8°, and one too far forward bends it more at heel strike than at push-off. This
//! module inverts the relation: it moves a person's hip joints and stretches the legs, once for all recordings, so that
//! the knees over stance become most probable under normal gait with its spread between people.
//!
//! The correction changes the skeleton, never the motion: a crouching person still crouches. It is applied if the knees are more
//! probable on misplaced joints than on correct ones of people who walk plainly or in a manner of
//! their own; [`Origin`] sets by how much, and [`HipVerdict`] names every other case.

mod fit;
mod leg;
pub mod reference;
mod stances;
mod summary;

use crate::walking_evidence::{Origin, WalkingEvidence};
use footfall_core::Side;
use glam::{Vec2, Vec3};
use reference::Gait;
use stances::{Legs, Parameters};

/// Moves of the hip joints to where they belong, in the axes of the pelvis; lengths as shares of the recorded leg (hip joint to ankle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HipCorrection {
    /// Way up (x) and forwards (y) of the left and of the right hip joint.
    pub offsets: [Vec2; 2],
    /// Factor on the lengths of thighs and shanks.
    pub leg_factor: f32,
}

impl HipCorrection {
    /// The move of one hip joint: left, up, forwards.
    pub fn offset(&self, side: Side) -> Vec3 {
        let [up, forward] = self.offsets[side.index()].to_array();
        Vec3::new(0.0, up, forward)
    }

    /// Returns true when the correction can be that of a recording: no leg of it would have to be longer than it is, in the mean of its
    /// strides.
    pub(crate) fn suits(&self, recording: &WalkingEvidence) -> bool {
        Side::BOTH.iter().all(|&side| {
            let stances = || recording.stances.iter().filter(|s| s.side == side);
            let reaches = stances().map(|stance| {
                let hips = stance.hip_from_ankle.iter();
                hips.map(|hip| (*hip + self.offset(side)).length())
                    .fold(0.0, f32::max)
            });
            let mean = reaches.sum::<f32>() / stances().count().max(1) as f32;
            let [thigh, shank] = recording.segments[side.index()];
            mean < (thigh + shank) * self.leg_factor + MOST_OVERSTRETCHED
        })
    }
}

impl Origin {
    /// Logarithm of the odds that hip joints are misplaced, before the knees are seen.
    const fn ln_prior_odds(self) -> f64 {
        match self {
            Self::Unknown => -4.0,
            Self::MarkerFit => 7.0,
        }
    }

    /// Fewer strides, or none of one leg, give no estimate.
    const fn least_strides(self) -> usize {
        match self {
            Self::Unknown => 3,
            Self::MarkerFit => 2,
        }
    }
}

/// Decision about a person's hip joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HipVerdict {
    /// They move.
    Corrected(HipCorrection),
    /// They stay as recorded, as was asked for.
    AsRecorded,
    /// The body is the canonical one; there is nothing to fit.
    OwnBody,
    /// Too few strides of plain walking.
    TooLittleWalking,
    /// The knees bend as people's do, or nearly so.
    Natural,
    /// The knees bend otherwise than people's do, and in a way that a manner of walking explains better than a misplaced
    /// joint.
    OwnManner,
}

impl HipVerdict {
    /// The correction, if there is one.
    pub const fn correction(&self) -> Option<&HipCorrection> {
        match self {
            Self::Corrected(correction) => Some(correction),
            _ => None,
        }
    }
}

/// A verdict and the evidence for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HipFinding {
    /// The decision.
    pub verdict: HipVerdict,
    /// Strides that it was learned from.
    pub strides: usize,
    /// Probability that the joints are misplaced; absent without strides.
    pub probability: Option<f32>,
    /// Flexion of the knee at heel strike, at its first peak and before push-off, degrees, as recorded; absent without strides.
    pub recorded_knee: Option<[f32; 3]>,
    /// The same after the correction.
    pub knee: Option<[f32; 3]>,
}

impl HipFinding {
    /// A verdict that needs no evidence.
    pub const fn without_evidence(verdict: HipVerdict) -> Self {
        Self {
            verdict,
            strides: 0,
            probability: None,
            recorded_knee: None,
            knee: None,
        }
    }
}

/// Logarithm of the odds of a peculiar manner in a walk that is labelled as plain.
const LN_MANNER_ODDS: f64 = -2.0;
/// No fit of a skeleton is farther off: up and forwards, in leg lengths, and the factor on the legs.
const MOST_UP: f32 = 0.05;
const MOST_FORWARD: f32 = 0.1;
const MOST_LENGTHENED: f32 = 0.035;
/// Greatest distance of the ankles of a person's own recordings out of reach, in leg lengths: noise of markers.
const MOST_OVERSTRETCHED: f32 = 0.008;

/// Finds one person's hip joints from all recordings of one skeleton.
pub fn find_hip_centres(recordings: &[&WalkingEvidence]) -> HipFinding {
    if recordings.iter().any(|recording| recording.is_own_body) {
        return HipFinding::without_evidence(HipVerdict::OwnBody);
    }
    let legs = Legs::new(recordings);
    let strides = legs.strides();
    let count = strides.iter().sum();
    let too_little = HipFinding {
        strides: count,
        ..HipFinding::without_evidence(HipVerdict::TooLittleWalking)
    };
    let origin = recordings.first().map_or(Origin::Unknown, |r| r.origin);
    if count < origin.least_strides() || strides.contains(&0) {
        return too_little;
    }
    let (Some(plain), Some(manner), Some(misplaced), Some(places)) = (
        fit::as_recorded(&legs, Gait::Plain),
        fit::as_recorded(&legs, Gait::Manner).map(|evidence| evidence + LN_MANNER_ODDS),
        fit::misplaced(&legs),
        fit::places(&legs),
    ) else {
        return too_little;
    };
    let most = plain.max(manner);
    let either = most + ((plain - most).exp() + (manner - most).exp()).ln();
    let ln_odds = origin.ln_prior_odds() + misplaced - either;
    let correction = places.correction();
    let verdict = if ln_odds > 0.0 && is_plausible(&correction) {
        HipVerdict::Corrected(correction)
    } else if plain >= manner {
        HipVerdict::Natural
    } else {
        HipVerdict::OwnManner
    };
    let recorded = legs.mean_knee(&Parameters::default());
    let knee = match verdict {
        HipVerdict::Corrected(_) => legs.mean_knee(&places),
        _ => recorded,
    };
    HipFinding {
        verdict,
        strides: count,
        probability: Some((1.0 / (1.0 + (-ln_odds).exp())) as f32),
        recorded_knee: Some(reference::landmarks(&recorded)),
        knee: Some(reference::landmarks(&knee)),
    }
}

fn is_plausible(correction: &HipCorrection) -> bool {
    (correction.leg_factor - 1.0).abs() <= MOST_LENGTHENED
        && correction
            .offsets
            .iter()
            .all(|offset| offset.x.abs() <= MOST_UP && offset.y.abs() <= MOST_FORWARD)
}

#[cfg(test)]
mod tests;
