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

    /// Displaces the hips in the course of a step; those of a leap by the push-off, for nothing moves them aside in the air.
    pub(super) fn lead(&self, timing: &StepTiming, leaps: bool, out: &mut [PlantedFrame]) {
        if self.way == Vec3::ZERO {
            return;
        }
        let frames = timing.frames as f32;
        let pushed = timing.take_off.filter(|_| leaps).map(|last| last as f32);
        for (index, frame) in out.iter_mut().enumerate() {
            let time = index as f32;
            let share = match pushed {
                // The speed rises with the square of the time, and then stays.
                Some(last) => {
                    let gained = (time.min(last) / last).powi(3) / 3.0;
                    let whole = frames / last - 2.0 / 3.0;
                    (gained + (time - last).max(0.0) / last) / whole
                }
                None => smooth_step(time / frames),
            };
            frame.pose.root_position += share * self.way;
        }
    }
}
