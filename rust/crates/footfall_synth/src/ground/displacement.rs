//! Displacement of a step's end: a walker that is a little off its place walks there.
//!
//! The standing foot stays. The hips move smoothly to the displaced end, and the landing foot goes with them, so that the
//! correction is part of the walk.

use super::frame::PlantedFrame;
use crate::plan::StepTiming;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Displacement of the end of a step from where it was planned, in the space where the walk began.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Displacement {
    /// Way over the ground, metres.
    pub(crate) way: Vec3,
    /// Turn, radians, positive to the left.
    pub(crate) turn: f32,
}

impl Displacement {
    pub(crate) const NONE: Self = Self {
        way: Vec3::ZERO,
        turn: 0.0,
    };

    /// Returns the sum of two displacements.
    pub(crate) fn and(self, more: Self) -> Self {
        Self {
            way: self.way + more.way,
            turn: self.turn + more.turn,
        }
    }

    /// Limits the way and the turn.
    pub(crate) fn within(self, most_m: f32, most_rad: f32) -> Self {
        Self {
            way: self.way.clamp_length_max(most_m),
            turn: self.turn.clamp(-most_rad, most_rad),
        }
    }

    /// Displaces the hips in the course of a step.
    pub(super) fn lead(&self, timing: &StepTiming, out: &mut [PlantedFrame]) {
        if self.way == Vec3::ZERO {
            return;
        }
        for (index, frame) in out.iter_mut().enumerate() {
            let share = smooth_step(index as f32 / timing.frames as f32);
            frame.pose.root_position += share * self.way;
        }
    }
}
