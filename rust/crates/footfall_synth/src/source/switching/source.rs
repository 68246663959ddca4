//! Switching steps as a source of steps.

use super::SwitchingSteps;
use crate::controls::STANDING_SPEED_MPS;
use crate::detail::Detail;
use crate::gait::{Amplitude, FASTEST_WALK_MPS, Gait, StepControls, pelvis_turn};
use crate::ground::PlantedStep;
use crate::plan::StepShape;
use crate::source::step_source::{StepSource, Stretches};
use glam::Vec2;

/// Largest change of velocity between consecutive steps, m/s: two systems know one way of walking and adapt less.
const MOST_CHANGE_MPS: f32 = 0.5;

impl StepSource for SwitchingSteps {
    fn fastest_mps(&self) -> f32 {
        FASTEST_WALK_MPS
    }

    fn gait(&self) -> Gait {
        Gait::Walk
    }

    fn shape(&self) -> &StepShape {
        &self.shape
    }

    fn planted(&self) -> &PlantedStep {
        &self.planted
    }

    fn facing(&self) -> [f32; 2] {
        self.origin.facing
    }

    fn stand(&mut self, detail: Detail) -> bool {
        let first = self.origin.leading;
        let speed = f64::from(STANDING_SPEED_MPS);
        self.begin(first, Amplitude::STAND, speed, detail);
        self.velocity_mps = Vec2::ZERO;
        true
    }

    fn advance(&mut self, controls: &StepControls) {
        self.velocity_mps = controls.velocity_within(self.velocity_mps, MOST_CHANGE_MPS);
        self.take_over(self.origin.leading.other());
        self.set_pace();
        self.origin.turn_rate = controls.turn_rate;
        self.origin.amplitude = controls.amplitude;
        self.origin.detail = controls.detail;
        let facing = self.facing() + pelvis_turn(self.velocity_mps);
        self.origin.facing = [self.origin.facing[1], facing];
        self.generate_and_plant();
    }

    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>) {
        let Some(feet) = self.origin.planter else {
            return;
        };
        if haste > 1.0 {
            let haste = f64::from(haste);
            self.origin.tempo *= haste;
            self.origin.stride /= haste;
            // The same step, drawn by the same chance.
            self.rng
                .set_word_pos(u128::from(self.origin.chance_position));
            self.planted.resume(&feet);
            self.generate_and_plant();
        }
        while let Some(share) = next(&self.shape, &self.planted) {
            self.origin.stride *= f64::from(share);
            self.shape.stride = self.origin.stride;
            self.velocity_mps *= share;
            self.planted.resume(&feet);
            self.plant();
        }
    }
}
