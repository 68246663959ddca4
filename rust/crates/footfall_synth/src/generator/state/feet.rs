//! Feet and hips in a saved state.

use super::version::{Parts, since};
use crate::ground::{Lean, Look, PlanterState, Strafe, look, spread};
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
    pub(super) midway: Option<Midway>,
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
            look: Look::default(),
            balance: stance.balance,
            lean: stance.lean,
            airborne: None,
        };
        let midway = stance.midway.unwrap_or_else(|| Midway::at_end(&feet));
        PlanterState {
            spread: midway.spread,
            look: midway.look,
            ..feet
        }
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

/// Spread of the feet and turn of the head at the beginning of a step, where they are not as at the end of one: a step was replanned, or a head still turns.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Midway {
    spread: f32,
    look: Look,
}

impl Midway {
    /// Returns that of these feet, if it does not follow from them.
    pub(super) fn of(feet: &PlanterState) -> Option<Self> {
        let midway = Self {
            spread: feet.spread,
            look: feet.look,
        };
        (midway != Self::at_end(feet)).then_some(midway)
    }

    /// Returns that of feet at the end of a step.
    fn at_end(feet: &PlanterState) -> Self {
        Self {
            spread: spread(feet),
            look: look(feet),
        }
    }

    /// Reads the next part of a state. In the first version that has it, heads did not turn.
    pub(super) fn read(parts: &mut Parts<'_>) -> postcard::Result<Option<Self>> {
        if parts.version != since::FEET_SPREAD {
            return parts.next(since::HEADS_TURN, None);
        }
        let spread: Option<f32> = parts.next(since::FEET_SPREAD, None)?;
        let look = Look::default();
        Ok(spread.map(|spread| Self { spread, look }))
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = f32> {
        [self.spread, self.look.angle, self.look.rate].into_iter()
    }
}
