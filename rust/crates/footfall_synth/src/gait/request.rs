//! Requests for one step: the controls as a step can follow them, and the step that a gait makes of them.

use super::kinds::Gait;
use super::pace::Pace;
use super::stand::Amplitude;
use crate::controls::{Controls, GaitChoice};
use crate::detail::Detail;
use footfall_core::StepPosition;
use glam::Vec2;

/// Requirements of the next step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepControls {
    /// Travel to the left and forwards from where the walker faces.
    pub(crate) velocity_mps: Vec2,
    pub(crate) turn_rate: f32,
    pub(crate) amplitude: Amplitude,
    pub(crate) gait: GaitChoice,
    /// Rise of the hips in a leap, if it is one, metres.
    pub(crate) leap_m: Option<f32>,
    pub(crate) detail: Detail,
}

impl StepControls {
    /// Derives the requirements of the step after one of this amplitude from the controls.
    pub(crate) fn after(
        before: Amplitude,
        controls: Controls,
        fastest_mps: f32,
        detail: Detail,
    ) -> Self {
        Self {
            velocity_mps: controls.velocity().clamp_length_max(fastest_mps),
            turn_rate: controls.turn_rate(),
            amplitude: Amplitude {
                from: before.to,
                to: if controls.is_standing() { 0.0 } else { 1.0 },
            },
            gait: controls.gait,
            leap_m: None,
            detail,
        }
    }

    /// The velocity of the next step, after one of this velocity and gait.
    pub(crate) fn velocity_after(&self, velocity_mps: Vec2, gait: Gait) -> Vec2 {
        self.velocity_within(velocity_mps, gait.most_change_mps())
    }

    /// The velocity of the next step, which differs by so much at most from that of this one.
    pub(crate) fn velocity_within(&self, velocity_mps: Vec2, most_mps: f32) -> Vec2 {
        velocity_mps + (self.velocity_mps - velocity_mps).clamp_length_max(most_mps)
    }
}

/// Manner of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Manner {
    pub(crate) pace: Pace,
    /// Place in the walk.
    pub(crate) position: StepPosition,
    pub(crate) detail: Detail,
}

impl Manner {
    /// Inside a walk, in full detail.
    pub(crate) const fn inside(pace: Pace) -> Self {
        Self {
            pace,
            position: StepPosition::Inside,
            detail: Detail::Full,
        }
    }
}

/// StepRequest for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepRequest {
    pub(crate) manner: Manner,
    pub(crate) amplitude: Amplitude,
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// Travel to the left and forwards from where the walker faces.
    pub(crate) velocity_mps: Vec2,
    /// Heading under which the walk goes along +Z, radians: people hold their hips a little askew.
    pub(crate) facing: f32,
    /// Rise of the hips in a leap, if it is one, metres.
    pub(crate) leap_m: Option<f32>,
}
