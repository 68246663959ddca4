//! The finding about a recording's hip joints, in words and as JSON.

use crate::output;
use footfall_core::Skeleton;
use footfall_motion::corpus::Person;
use footfall_motion::hip_centres::{HipFinding, HipVerdict};
use serde::Serialize;

/// A finding for people and scripts; lengths on the canonical body.
#[derive(Serialize)]
pub(crate) struct HipFacts {
    verdict: &'static str,
    /// Strides of plain walking that tell where the joints are.
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
}

impl HipFacts {
    /// The finding, where one was asked for.
    pub(crate) fn of(finding: &HipFinding) -> Option<Self> {
        let verdict = name(&finding.verdict)?;
        let leg_cm = 100.0 * Skeleton::standard().mean_leg_length();
        let correction = finding.verdict.correction();
        let moved = |along: fn(glam::Vec2) -> f32| {
            correction.map_or([0.0; 2], |correction| {
                correction.offsets.map(|offset| along(offset) * leg_cm)
            })
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
        })
    }

    /// One line.
    pub(crate) fn line(&self) -> String {
        let knee = |angles: Option<[f32; 3]>| {
            angles.map_or_else(String::new, |[strike, peak, end]| {
                format!("{strike:.0}/{peak:.0}/{end:.0}°")
            })
        };
        let recorded = knee(self.recorded_knee_degrees);
        match self.verdict {
            "corrected" => {
                let [up, forward] =
                    [self.moved_up_cm, self.moved_forward_cm].map(|[left, right]| {
                        if (left - right).abs() < 0.05 {
                            format!("{left:+.1}")
                        } else {
                            format!("{left:+.1} (left) {right:+.1} (right)")
                        }
                    });
                format!(
                    "moved {up} cm up and {forward} cm forwards, legs {:.3} of their length: knees {recorded} to {} at heel \
                     strike, in loading and before push-off over {} strides",
                    self.leg_factor,
                    knee(self.knee_degrees),
                    self.strides
                )
            }
            "own_body" => "left: the body is the canonical one".to_owned(),
            "natural" => format!(
                "left: knees bend {recorded} over {} strides, which no misplaced joint has to explain",
                self.strides
            ),
            "own_manner" => format!(
                "left: knees bend {recorded} over {} strides, which a manner of walking explains better than a misplaced joint",
                self.strides
            ),
            _ => format!(
                "left: {} strides of plain walking are too few to tell",
                self.strides
            ),
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

/// Says of a corpus whose hip joints moved, and of how many people they were left.
pub(crate) fn note_people(people: &[Person]) {
    let mut left = 0_usize;
    for person in people {
        if person.hip_centres.verdict.correction().is_none() {
            left += 1;
        } else if let Some(facts) = HipFacts::of(&person.hip_centres) {
            output::note(&format!(
                "hip joints of {} {}",
                person.subject,
                facts.line()
            ));
        }
    }
    if left > 0 && left < people.len() {
        output::note(&format!(
            "hip joints of {left} other people left as recorded"
        ));
    }
}
