//! State of feet, hips and heading between two steps.

use super::look::Look;
use super::strafe::Strafe;
use footfall_core::Side;
use footfall_ik::{FootTarget, Plant};
use glam::{Quat, Vec2, Vec3};

/// State at the end of a step, with which the next one begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlanterState {
    pub(crate) plants: [Plant; 2],
    pub(crate) hips: Vec3,
    /// Velocity of the hips in the last frame, m/s; `None` before the first step.
    pub(crate) hips_velocity: Option<Vec3>,
    pub(crate) heading: f32,
    pub(crate) turn_rate: f32,
    pub(crate) ground_position: Vec3,
    pub(crate) ground_velocity: Option<Vec3>,
    /// Factor on the legs' reach at the end of the last step.
    pub(crate) stride: f32,
    /// Outward shift of each foot for the turn at the end of the last step, as a share of the leg's length.
    pub(crate) spread: f32,
    /// Strafe of the last step.
    pub(crate) strafe: Strafe,
    /// Shift of both feet for the balance of the last landing, to the left and forwards.
    pub(crate) balance: Vec2,
    /// Foot that is still in the air, after a step of a run or a cut.
    pub(crate) airborne: Option<Airborne>,
    /// Lean of the body.
    pub(crate) lean: Lean,
    /// Turn of the head.
    pub(crate) look: Look,
}

impl PlanterState {
    /// Returns the state of a walk that begins at the origin on these plants, under this heading.
    pub(super) fn first(plants: [Plant; 2], heading: f32) -> Self {
        Self {
            plants,
            hips: Vec3::ZERO,
            hips_velocity: None,
            heading,
            turn_rate: 0.0,
            ground_position: Vec3::ZERO,
            ground_velocity: None,
            stride: 1.0,
            spread: 0.0,
            strafe: Strafe::NONE,
            balance: Vec2::ZERO,
            airborne: None,
            lean: Lean::default(),
            look: Look::default(),
        }
    }

    /// Returns the speed of the hips over the ground, m/s, and the way until they are above a foot, metres.
    pub(crate) fn room(&self, side: Side) -> (f32, f32) {
        let velocity = self.hips_velocity.unwrap_or(Vec3::ZERO).with_y(0.0);
        let way = self.plants[side.index()].flat_ankle - self.hips;
        (velocity.length(), way.dot(velocity.normalize_or_zero()))
    }
}

/// A foot in the air between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Airborne {
    /// Places of the foot as the step begins, and a frame earlier.
    pub(crate) now: FootTarget,
    pub(crate) before: FootTarget,
    /// Time between the two, seconds.
    pub(crate) frame_secs: f32,
}

impl Airborne {
    /// Returns the place of the foot this long ago.
    pub(super) fn earlier(&self, secs: f32) -> FootTarget {
        let share = secs / self.frame_secs;
        if (share - 1.0).abs() < 1e-3 {
            return self.before;
        }
        let turned = |now: Quat, before: Quat| now.slerp(before, share);
        FootTarget {
            ankle: self.now.ankle + share * (self.before.ankle - self.now.ankle),
            foot: turned(self.now.foot, self.before.foot),
            toes: turned(self.now.toes, self.before.toes),
        }
    }
}

/// Lean of the body to the left, and of pelvis and trunk forwards, radians, its rate of change, rad/s, and the lean of the standing leg.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lean {
    pub(crate) angle: Vec2,
    pub(crate) rate: Vec2,
    /// Lean of the standing leg forwards, radians: the hips are ahead of its foot by so much more than as generated.
    pub(crate) leg: f32,
}
