//! Confidence: how well the model explains the measurements, and the standing body shown when it explains little.
//!
//! A logistic curve turns the mean logarithm of the density of the measurements, given the prediction, into a probability. The curve was fitted
//! to the output of a model without jumps and hops: on one side walks and runs of people left out (CMU's 16 and 35, simulated right foot; ipol's 1 to 4, real), on the other jumps
//! (CMU's 91) and shaken sensors; frames of motion, with equal weight for both sides. Results of the same model for others:
//!
//! | frames of motion | frames | median | below 0.5 | below 0.2 |
//! | --- | --- | --- | --- | --- |
//! | walks, CMU's 7 and 8, left out, simulated | 427 | 0.86 | 0.5 % | 0 |
//! | walks with a U-turn, ipol's 5 to 8, real | 4,679 | 0.84 | 0.7 % | 0 |
//! | walk, gaitmap example, real | 983 | 0.81 | 0 | 0 |
//! | walks backwards, Bandai's actors, simulated | 2,657 | 0.87 | 3 % | 0 |
//! | crouched walk, O3DE's actor, simulated | 1,865 | 0.81 | 14 % | 2 % |
//! | jumps and hops, CMU's unidentified people, simulated | 903 | 0.43 | 62 % | 15 % |
//! | a shaken sensor | 510 | 0.01 | 100 % | 100 % |
//!
//! A foot cannot distinguish walking backwards from walking: motions with equal measurements are not detected.

use crate::body::{BodyFrame, Course};
use footfall_core::Behaviour;
use footfall_core::ease::smooth_step;
use footfall_model::ImuModel;
use footfall_model::imu_model::{BODY_COUNT, CONTACT, TURN, WAY};

/// Slope of the logistic curve, and the logarithm of the density at which it is one half.
const SLOPE: f32 = 1.3;
const HALF: f32 = -2.75;

/// Time constant of the mean, seconds.
const MEAN_SECS: f32 = 0.33;

/// Below the first of these confidences the body stands, above the second it is the model's.
const TRUSTED: [f32; 2] = [0.04, 0.12];

/// Confidence in the model, given what is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Confidence {
    mean: f32,
    /// False when the model is trusted whatever it explains.
    doubts: bool,
}

impl Confidence {
    /// Nothing speaks against the model yet.
    pub(crate) const fn new(doubts: bool) -> Self {
        Self { mean: 0.0, doubts }
    }

    /// Goes on by a frame whose measurement had this logarithm of its density, however many sensors there are.
    pub(crate) fn step(&mut self, log_density: f32, dt_secs: f32) {
        let share = 1.0 - (-dt_secs / MEAN_SECS).exp();
        self.mean += share * (log_density - self.mean);
    }

    /// Probability that the model holds what is done, 0 to 1.
    pub(crate) fn value(self) -> f32 {
        1.0 / (1.0 + (SLOPE * (HALF - self.mean)).exp())
    }

    /// Share of the body that is the model's; the rest stands.
    pub(crate) fn trusted(self) -> f32 {
        if !self.doubts {
            return 1.0;
        }
        smooth_step((self.value() - TRUSTED[0]) / (TRUSTED[1] - TRUSTED[0]))
    }

    /// Returns true when what the sensors say of contacts and of the heading is taken.
    pub(crate) fn is_trusted(self) -> bool {
        self.trusted() > 0.5
    }

    /// Probabilities of behaviours: of what is not trusted the body stands.
    pub(crate) fn behaviours(
        self,
        probabilities: &[f32; Behaviour::ALL.len()],
    ) -> [f32; Behaviour::ALL.len()] {
        let trusted = self.trusted();
        let mut shown = probabilities.map(|probability| trusted * probability);
        shown[Behaviour::Stand.index()] += 1.0 - trusted;
        shown
    }

    /// Draws a body and how it changes to one that stands, by as much as the model is not trusted.
    pub(crate) fn calm(self, standing: Option<&BodyFrame>, course: &mut Course) {
        let trusted = self.trusted();
        if let Some(standing) = standing.filter(|_| trusted < 1.0) {
            for n in 0..BODY_COUNT {
                course.body[n] = standing[n] + trusted * (course.body[n] - standing[n]);
                course.arrival[n] *= trusted;
                course.velocity[n] *= trusted;
            }
        }
    }
}

/// The mean body of the frames in which a model's people stand, at rest on both feet; `None` without any.
pub(crate) fn standing_body(model: &ImuModel) -> Option<BodyFrame> {
    let (mut sum, mut count) = ([0.0_f64; BODY_COUNT], 0.0);
    for row in standing_rows(model, &model.body, BODY_COUNT) {
        count += 1.0;
        for (sum, value) in sum.iter_mut().zip(row) {
            *sum += f64::from(*value);
        }
    }
    let mut body = sum.map(|sum| (sum / count) as f32);
    body[WAY..WAY + 2].fill(0.0);
    body[TURN] = 0.0;
    body[CONTACT..CONTACT + 2].fill(1.0);
    (count > 0.0).then_some(body)
}

/// The rows, of this width, of the frames in which a model's people stand.
pub(crate) fn standing_rows<'a>(
    model: &'a ImuModel,
    rows: &'a [f32],
    width: usize,
) -> impl Iterator<Item = &'a [f32]> {
    let stands = model.segments.iter().flat_map(|segment| {
        let stands = model.behaviour_of(*segment) == Behaviour::Stand;
        core::iter::repeat_n(stands, usize::from(segment.frames))
    });
    let rows = rows.chunks_exact(width).zip(stands);
    rows.filter_map(|(row, stands)| stands.then_some(row))
}

#[cfg(test)]
mod tests {
    #![expect(
        clippy::float_cmp,
        reason = "what is trusted as a whole or not at all is exact"
    )]

    use super::*;

    #[test]
    fn what_is_explained_is_trusted_and_what_is_not_stands() {
        let mut confidence = Confidence::new(true);
        let mut settle = |log_density: f32| {
            for _ in 0..90 {
                confidence.step(log_density, 1.0 / 30.0);
            }
            confidence
        };
        let explained = settle(-1.3);
        assert!(explained.value() > 0.85 && explained.trusted() == 1.0);
        let half = settle(HALF);
        assert!((half.value() - 0.5).abs() < 0.01);
        let shaken = settle(-6.25);
        assert!(shaken.value() < 0.02 && shaken.trusted() == 0.0);

        let mut jumps = [0.0; Behaviour::ALL.len()];
        jumps[Behaviour::Jump.index()] = 1.0;
        assert_eq!(explained.behaviours(&jumps), jumps);
        assert_eq!(shaken.behaviours(&jumps)[Behaviour::Stand.index()], 1.0);

        let mut course = Course {
            body: [1.0; BODY_COUNT],
            arrival: [0.5; BODY_COUNT],
            velocity: [0.5; BODY_COUNT],
        };
        shaken.calm(Some(&[0.25; BODY_COUNT]), &mut course);
        let still = Course {
            body: [0.25; BODY_COUNT],
            ..Course::REST
        };
        assert_eq!(course, still);
        explained.calm(Some(&[0.5; BODY_COUNT]), &mut course);
        assert_eq!(course, still);
    }
}
