//! Placing of a step on the ground: direction, speed and postures.

use super::displacement::Displacement;
use super::lean::Pull;
use super::speed_change::SpeedChange;
use crate::gait::{Amplitude, Posture};
use crate::plan::StepShape;
use footfall_core::ease::smooth_step;
use footfall_model::FEATURE_COUNT;
use glam::Vec2;

/// Turn rates from which a walker leans less, and at which it turns about a foot rather than along a curve, rad/s.
const CURVE_RADPS: [f32; 2] = [2.5, 3.5];

/// Share of a change of speed against which a walker still leans as the step ends.
const LEFT: f32 = 0.5;

/// Share of it against which a walker still leans as it comes to rest. O3DE's actor, whose feet come to rest after a walk, leans back by 4° then, and by 1° half a second later.
const LEFT_AT_REST: f32 = 0.35;

/// Speed above which a step has a direction of its own, m/s.
const DIRECTED_MPS: f32 = 0.1;

/// Placing of a step on the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placing<'a> {
    pub(crate) shape: &'a StepShape,
    /// The standing posture before the step and after it.
    pub(crate) standing: [&'a Posture; 2],
    /// The mean posture of the walk before the step and after it.
    pub(crate) walking: [&'a Posture; 2],
    /// Turn rate at the end of the step, rad/s.
    pub(crate) turn_rate: f32,
    /// Headings under which the walk goes along +Z, before the step and after it, radians.
    pub(crate) facing: [f32; 2],
    /// Velocity to the left and forwards relative to the facing direction of the steps, m/s; steps of a run face their direction of travel.
    pub(crate) velocity_mps: Vec2,
    /// The same of the previous step.
    pub(crate) velocity_before_mps: Vec2,
    /// Direction of a run relative to the facing direction, radians, positive to the left; `None` in a walk, and when the generated legs determine it.
    pub(crate) direction: Option<f32>,
    /// Share of the step that had passed when it was replanned.
    pub(crate) passed: f32,
    /// Displacement of the end of the step.
    pub(crate) displacement: Displacement,
    /// True for a body that rights itself as it stands: it may come to rest leaning.
    pub(crate) rights_itself: bool,
    /// True when legs keep their generated lengths; those of a switching model are not accurate enough.
    pub(crate) keeps_lengths: bool,
}

impl Placing<'_> {
    /// Returns the accelerations to lean against in a step of this duration. Runs lean into turns, too; sidesteps do not lean.
    pub(super) fn pull(&self, secs: f32) -> Pull {
        let [before, after] = self.ends_mps();
        let [from, to] = CURVE_RADPS;
        let curving = 1.0 - smooth_step((self.turn_rate.abs() - from) / (to - from));
        let change = (after.y - before.y) / secs;
        let walks = self.amplitude_at(1.0);
        let at_rest = if self.rights_itself {
            LEFT_AT_REST
        } else {
            0.0
        };
        // Who turns about a foot faces another way.
        let left = (at_rest + walks * (LEFT - at_rest)) * curving * change;
        Pull {
            within: Vec2::new(0.0, change),
            after: Vec2::new(curving * after.y * self.turn_rate, left),
            rests: [0.0, 1.0].map(|s| self.amplitude_at(s) <= 0.0),
        }
    }

    /// Returns the change of speed from the previous step to the end of this one.
    pub(super) fn change(&self) -> SpeedChange {
        let [before, after] = self.ends_mps();
        let change = SpeedChange::between(before, after);
        if self.passed > 0.0 {
            // A remainder has no surge of its own.
            return change.whole();
        }
        change
    }

    /// Returns true for a step of a walk that hardly travels, after one that did: its walker turns back.
    pub(super) fn turns_back(&self) -> bool {
        let [before, after] = [self.velocity_before_mps, self.velocity_mps]
            .map(|velocity| velocity.length() > DIRECTED_MPS);
        self.shape.amplitude == Amplitude::WALK && before && !after
    }

    /// Returns the way of a step inside a walk, along its direction and at its mean speed, metres; `None` for others. One after a slower step, or after one that went elsewhere, covers less.
    pub(super) fn way_m(&self, secs: f32) -> Option<f32> {
        let [before, after] = self.ends_mps();
        let mean_mps = (0.5 * (before + after)).dot(after.normalize_or_zero());
        let walks = self.shape.amplitude == Amplitude::WALK && !self.turns_back();
        walks.then_some(mean_mps * secs)
    }

    /// Returns the velocities at the beginning and at the end of the step, m/s.
    fn ends_mps(&self) -> [Vec2; 2] {
        [
            self.amplitude_at(0.0) * self.velocity_before_mps,
            self.amplitude_at(1.0) * self.velocity_mps,
        ]
    }

    /// Returns the share of the walk at part `s` of the step.
    fn amplitude_at(&self, s: f32) -> f32 {
        self.shape.amplitude.at(s, self.passed)
    }

    /// Returns the posture about which the body swings at part `s` of the step, and the blend of standing with these features of the walk.
    pub(super) fn grown(&self, walking: &[f32], s: f32) -> (Posture, Posture) {
        let amplitude = self.amplitude_at(s);
        let change = smooth_step(s);
        let between = |[before, after]: [&Posture; 2], index: usize| {
            before[index] + change * (after[index] - before[index])
        };
        let (mut middle, mut grown) = ([0.0; FEATURE_COUNT], [0.0; FEATURE_COUNT]);
        for (index, walking) in walking.iter().enumerate() {
            let standing = between(self.standing, index);
            middle[index] = standing + amplitude * (between(self.walking, index) - standing);
            grown[index] = standing + amplitude * (walking - standing);
        }
        (middle, grown)
    }
}
