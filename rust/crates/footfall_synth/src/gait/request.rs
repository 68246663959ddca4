//! Controls of one step, and the request that a gait makes of them.

use super::direction::sidles;
use super::pace::Pace;
use super::stand::Amplitude;
use crate::controls::{Controls, GaitChoice};
use crate::detail::Detail;
use footfall_core::{Side, StepPosition};
use glam::Vec2;

/// Controls within the limits of one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepControls {
    /// Velocity to the left and forwards relative to the facing direction.
    pub(crate) velocity_mps: Vec2,
    pub(crate) turn_rate: f32,
    pub(crate) amplitude: Amplitude,
    pub(crate) gait: GaitChoice,
    /// Rise of the hips in a leap, metres; `None` for other steps.
    pub(crate) leap_m: Option<f32>,
    /// True if a walked step that changes in its middle brings the feet together, or a run's step slows down, false if not; `None` to choose.
    pub(crate) brakes: Option<bool>,
    pub(crate) detail: Detail,
}

impl StepControls {
    /// Derives the controls of a step that follows one of this amplitude.
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
            brakes: None,
            detail,
        }
    }

    /// Returns the velocity of the next step, at most `most_mps` from that of this one.
    pub(crate) fn velocity_within(&self, velocity_mps: Vec2, most_mps: f32) -> Vec2 {
        velocity_mps + (self.velocity_mps - velocity_mps).clamp_length_max(most_mps)
    }
}

/// Manner of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Manner {
    pub(crate) pace: Pace,
    /// Position in the walk.
    pub(crate) position: StepPosition,
    pub(crate) detail: Detail,
}

impl Manner {
    /// Manner of a step inside a walk, in full detail.
    pub(crate) const fn inside(pace: Pace) -> Self {
        Self {
            pace,
            position: StepPosition::Inside,
            detail: Detail::Full,
        }
    }
}

/// Request for one step: its gait's answer to the controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepRequest {
    pub(crate) manner: Manner,
    pub(crate) amplitude: Amplitude,
    /// Turn rate at the end of the step, rad/s.
    pub(crate) turn_rate: f32,
    /// Velocity to the left and forwards relative to the facing direction.
    pub(crate) velocity_mps: Vec2,
    /// Heading under which the walk goes along +Z, radians: people hold their hips a little askew.
    pub(crate) facing: f32,
    /// Rise of the hips in a leap, metres; `None` for other steps.
    pub(crate) leap_m: Option<f32>,
}

/// Part of a step that has passed when the step is replanned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passed {
    /// Frames of the whole step.
    pub(crate) whole_frames: f64,
    /// Share of it that has passed.
    pub(crate) share: f64,
    /// Foot that stands.
    pub(crate) standing: Side,
    /// Share of the time in which a foot bears that has passed.
    pub(crate) borne: f32,
    /// Velocity to the left and forwards that the walker has reached by then, m/s.
    pub(crate) velocity_mps: Vec2,
    /// Speed of the hips, m/s.
    pub(crate) hips_mps: f32,
    /// Way of the hips until they are above the standing foot, metres; negative when they are past it.
    pub(crate) room_m: f32,
}

impl Passed {
    /// Returns true in a step to the side, at this velocity, in which the trailing foot comes to the leading one.
    pub(crate) fn gathers(&self, velocity_mps: Vec2) -> bool {
        let towards = match self.standing {
            Side::Left => velocity_mps.x,
            Side::Right => -velocity_mps.x,
        };
        towards > 0.0 && sidles(velocity_mps)
    }

    /// Returns the hardest braking of hips that come to rest `beside_m` metres before they are above the standing foot in this time, along a cubic, m/s².
    pub(crate) fn braking_mps2(&self, secs: f32, beside_m: f32) -> f32 {
        let room_m = self.room_m - beside_m;
        let (pace, room) = (self.hips_mps / secs, 6.0 * room_m / (secs * secs));
        (4.0 * pace - room).max(room - 2.0 * pace)
    }
}
