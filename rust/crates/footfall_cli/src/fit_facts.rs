//! Findings about a recording's skeleton, as JSON, and notes about a corpus's people.

use crate::output;
use footfall_motion::corpus::Person;
use footfall_motion::head_carriage::HeadFinding;
use footfall_motion::hip_centres::{HipFinding, HipVerdict};
use serde::Serialize;

/// A finding about hip joints for people and scripts; lengths on the canonical body.
#[derive(Serialize)]
pub(crate) struct HipFacts {
    verdict: &'static str,
    /// Strides of plain walking from which the joints are estimated.
    strides: usize,
    /// Probability that the recording misplaces them.
    probability: Option<f32>,
    /// Way of the left and of the right joint up and forwards, centimetres.
    moved_up_cm: [f32; 2],
    moved_forward_cm: [f32; 2],
    /// Factor on the lengths of thighs and shanks.
    leg_factor: f32,
    /// Flexion of the knee at heel strike, at its peak in loading and before push-off, degrees.
    recorded_knee_degrees: Option<[f32; 3]>,
    knee_degrees: Option<[f32; 3]>,
    /// The finding in one line.
    #[serde(skip)]
    pub(crate) line: String,
}

impl HipFacts {
    /// The finding; none where the joints were to stay as recorded.
    pub(crate) fn of(finding: &HipFinding) -> Option<Self> {
        let verdict = name(&finding.verdict)?;
        let correction = finding.verdict.correction();
        let moved = |along: fn(glam::Vec2) -> f32| {
            correction.map_or([0.0; 2], |correction| correction.moved_cm().map(along))
        };
        Some(Self {
            verdict,
            strides: finding.strides,
            probability: finding.probability,
            moved_up_cm: moved(|offset| offset.x),
            moved_forward_cm: moved(|offset| offset.y),
            leg_factor: correction.map_or(1.0, |correction| correction.leg_factor),
            recorded_knee_degrees: finding.recorded_knee,
            knee_degrees: finding.knee,
            line: finding.to_string(),
        })
    }
}

/// A finding about neck and head for people and scripts: degrees forwards and down, to the left, and towards the right shoulder.
#[derive(Serialize)]
pub(crate) struct HeadFacts {
    /// Strides of plain walking from which the carriage is estimated.
    strides: usize,
    recorded_neck_degrees: [f32; 3],
    neck_degrees: [f32; 3],
    recorded_head_degrees: [f32; 3],
    head_degrees: [f32; 3],
    /// The finding in one line.
    #[serde(skip)]
    pub(crate) line: String,
}

impl HeadFacts {
    /// The finding.
    pub(crate) fn of(finding: &HeadFinding) -> Self {
        let (recorded, corrected) = (finding.recorded, finding.corrected);
        Self {
            strides: finding.strides,
            recorded_neck_degrees: recorded.neck.to_array(),
            neck_degrees: corrected.neck.to_array(),
            recorded_head_degrees: recorded.head.to_array(),
            head_degrees: corrected.head.to_array(),
            line: finding.to_string(),
        }
    }
}

const fn name(verdict: &HipVerdict) -> Option<&'static str> {
    Some(match verdict {
        HipVerdict::Corrected(_) => "corrected",
        HipVerdict::AsRecorded => return None,
        HipVerdict::OwnBody => "own_body",
        HipVerdict::TooLittleWalking => "too_little_walking",
        HipVerdict::Natural => "natural",
        HipVerdict::OwnManner => "own_manner",
    })
}

/// Says of a corpus whose hip joints and heads moved, and of how many people the hip joints were left.
pub(crate) fn note_people(people: &[Person]) {
    let mut left = 0_usize;
    for person in people {
        let finding = &person.fit.hip_centres;
        if let Some(head) = &person.fit.head {
            output::note(&format!("head of {}: {head}", person.subject));
        }
        if finding.verdict.correction().is_none() {
            left += 1;
        } else {
            output::note(&format!("hip joints of {} {finding}", person.subject));
        }
    }
    if left > 0 && left < people.len() {
        output::note(&format!(
            "hip joints of {left} other people left as recorded"
        ));
    }
}
