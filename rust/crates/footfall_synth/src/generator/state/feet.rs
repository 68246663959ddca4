//! Feet and hips in a saved state.

use crate::generator::GaitGenerator;
use crate::ground::{Lean, PlanterState, Strafe, spread};
use crate::source::Steps;
use footfall_ik::Plant;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Feet and hips at the beginning of a step.
#[derive(Serialize, Deserialize)]
pub(super) struct Feet {
    /// Flat ankle and heading, left and right.
    plants: [[f32; 4]; 2],
    hips: [f32; 3],
    hips_velocity: Option<[f32; 3]>,
    heading: f32,
    turn_rate: f32,
    ground_position: [f32; 3],
    ground_velocity: Option<[f32; 3]>,
    stride: f32,
    strafe: Strafe,
}

/// Stance over the feet at the beginning of a step, which follows in later parts of a state.
pub(super) struct Stance {
    pub(super) lean: Lean,
    pub(super) balance: Vec2,
    /// Spread of the feet in the middle of a step; `None` for one that is as at the end of a step.
    pub(super) spread: Option<f32>,
}

impl Feet {
    pub(super) fn of(planter: &PlanterState) -> Self {
        Self {
            plants: planter.plants.map(|plant| {
                let [x, y, z] = plant.flat_ankle.to_array();
                [x, y, z, plant.heading]
            }),
            hips: planter.hips.to_array(),
            hips_velocity: planter.hips_velocity.map(|v| v.to_array()),
            heading: planter.heading,
            turn_rate: planter.turn_rate,
            ground_position: planter.ground_position.to_array(),
            ground_velocity: planter.ground_velocity.map(|v| v.to_array()),
            stride: planter.stride,
            strafe: planter.strafe,
        }
    }

    /// Returns the state of feet with this stance over them.
    pub(super) fn planter(&self, stance: &Stance) -> PlanterState {
        let feet = PlanterState {
            plants: self.plants.map(|[x, y, z, heading]| Plant {
                flat_ankle: Vec3::new(x, y, z),
                heading,
            }),
            hips: self.hips.into(),
            hips_velocity: self.hips_velocity.map(Vec3::from),
            heading: self.heading,
            turn_rate: self.turn_rate,
            ground_position: self.ground_position.into(),
            ground_velocity: self.ground_velocity.map(Vec3::from),
            stride: self.stride,
            strafe: self.strafe,
            spread: 0.0,
            balance: stance.balance,
            lean: stance.lean,
            airborne: None,
        };
        PlanterState {
            spread: stance.spread.unwrap_or_else(|| spread(&feet)),
            ..feet
        }
    }

    /// Returns the spread of the feet of a walker whose step was replanned.
    pub(super) fn spread_midway(generator: &GaitGenerator) -> Option<f32> {
        let Steps::Styled(steps) = &generator.steps else {
            return None;
        };
        let origin = steps.window.origin();
        let feet = origin.planter.filter(|_| origin.remainder.is_some());
        feet.map(|feet| feet.spread)
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = f32> {
        let velocities = [self.hips_velocity, self.ground_velocity];
        self.plants
            .into_iter()
            .flatten()
            .chain(self.hips)
            .chain(self.ground_position)
            .chain([self.heading, self.turn_rate, self.stride])
            .chain(self.strafe.numbers())
            .chain(velocities.into_iter().flatten().flatten())
    }
}
