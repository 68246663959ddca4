//! Placing of a step: where on the ground it goes, and from which posture.

use super::displacement::Displacement;
use super::lean::Pull;
use super::speed_change::SpeedChange;
use crate::gait::{Amplitude, Posture};
use crate::plan::StepShape;
use footfall_core::ease::smooth_step;
use footfall_model::FEATURE_COUNT;
use glam::Vec2;

/// Placing of a step on the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placing<'a> {
    pub(crate) shape: &'a StepShape,
    /// The standing posture before the step and after it.
    pub(crate) standing: [&'a Posture; 2],
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// Headings under which the walk goes along +Z, before the step and after it, radians.
    pub(crate) facing: [f32; 2],
    /// Travel to the left and forwards from where the steps face, m/s: those of a run face where it goes.
    pub(crate) velocity_mps: Vec2,
    /// That of the step before.
    pub(crate) velocity_before_mps: Vec2,
    /// Direction of a run from where the walker faces, radians, positive to the left; none in a walk, and where the generated legs choose it.
    pub(crate) direction: Option<f32>,
    /// The share of it that had passed when it was planned anew.
    pub(crate) passed: f32,
    /// Displacement of its end.
    pub(crate) displacement: Displacement,
    /// True where legs are to be as long as generated: those of two systems are not true enough for that.
    pub(crate) keeps_lengths: bool,
}

impl Placing<'_> {
    /// Accelerations to lean against in a step of so many seconds. A run leans into its turns, too; nobody leans out of a sidestep.
    pub(super) fn pull(&self, secs: f32) -> Pull {
        let Amplitude { from, to } = self.shape.amplitude;
        let [before, after] = [from * self.velocity_before_mps, to * self.velocity_mps];
        Pull {
            within: Vec2::new(0.0, (after.y - before.y) / secs),
            after: Vec2::new(after.y * self.turn_rate, 0.0),
        }
    }

    /// Change of speed from the step before to the end of this one.
    pub(super) fn change(&self) -> SpeedChange {
        let Amplitude { from, to } = self.shape.amplitude;
        let change = SpeedChange::between(from * self.velocity_before_mps, to * self.velocity_mps);
        if self.passed > 0.0 {
            // Half a step has no surge of a step.
            return change.whole();
        }
        change
    }

    /// The standing posture at part `s` of the step, and what there is of the walk on top of it.
    pub(super) fn grown(&self, walking: &[f32], s: f32) -> (Posture, Posture) {
        let amplitude = self.shape.amplitude.at(s);
        let change = smooth_step(s);
        let mut standing = *self.standing[0];
        let mut grown = [0.0; FEATURE_COUNT];
        let pairs = self.standing[1].iter().zip(walking);
        for ((value, standing), (after, walking)) in grown.iter_mut().zip(&mut standing).zip(pairs)
        {
            *standing += change * (after - *standing);
            *value = *standing + amplitude * (walking - *standing);
        }
        (standing, grown)
    }
}
