//! Steps in which a runner slows down to stand or to walk: quicker and shorter ones.
//!
//! People who stop from a run brake over four to six quick, short steps, each foot well ahead of the hips. In a step as long as those of the run before
//! they would lose half of their speed over one foot, on a deeply bent knee.

use super::kinds::Gait;
use super::request::{StepControls, StepRequest};
use super::stand::Amplitude;
use crate::controls::GaitChoice;
use glam::Vec2;

/// Increase of the tempo. O3DE's actor takes steps of 0.18 to 0.28 s as he stops from 3.4 m/s, and of 0.32 s in an even run.
const QUICKER: f64 = 1.65;

/// Shortening of the strides, walked and run. Walked steps that are so much quicker reach less far anyway.
const SHORTER: [f64; 2] = [1.15, 1.45];

/// Share of the usual change of speed from step to step: what is lost in a second remains about the same.
pub(super) const LESS_LOST: f32 = 0.6;

/// Excess of the speed over the requested one from which a runner slows down to walk in such steps, m/s.
const LEAST_EXCESS_MPS: f32 = 0.4;

/// Turn rate, rad/s, and change of direction, radians, from which a runner turns rather than slows down.
const TURNS_RADPS: f32 = 1.5;
const TURNS_RAD: f32 = 0.5;

impl StepControls {
    /// Returns true when a runner on legs of this length is asked for a speed at which people walk, straight ahead. The choice of gait does not count: followers over a network know it only as
    /// the gait of the step, and whether a run slows down as the sender's choice, which may have come of controls that were lost on the way.
    pub(super) fn slows_to_walk(&self, before: Gait, velocity_mps: Vec2, leg_length: f32) -> bool {
        if let (GaitChoice::Run, Some(brakes)) = (self.gait, self.brakes) {
            return brakes && before == Gait::Run;
        }
        let asked = self.velocity_mps;
        let suits = GaitChoice::Auto.of_step(Gait::Run, asked, leg_length, false);
        let straight =
            self.turn_rate.abs() < TURNS_RADPS && velocity_mps.angle_to(asked).abs() < TURNS_RAD;
        (before, suits) == (Gait::Run, Gait::Walk)
            && straight
            && self.amplitude == Amplitude::WALK
            && self.leap_m.is_none()
            && velocity_mps.length() - asked.length() > LEAST_EXCESS_MPS
    }
}

impl StepRequest {
    /// Returns true for a run that [slows down](Self::slowing): no other is so much quicker than it is long.
    pub(crate) fn run_slows(&self) -> bool {
        self.manner.pace.tempo > QUICKER * self.manner.pace.stride
    }

    /// Returns the request for a step of this gait that slows down: quicker and shorter.
    pub(super) fn slowing(mut self, gait: Gait) -> Self {
        let pace = &mut self.manner.pace;
        pace.tempo *= QUICKER;
        pace.stride /= SHORTER[gait as usize];
        self
    }
}
