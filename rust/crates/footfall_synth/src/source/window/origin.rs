//! Requests for a step, and what a step was made from.

use crate::gait::{Manner, StepRequest};
use crate::ground::{Displacement, PlanterState};
use crate::plan::{Remainder, TIE_LEN};
use glam::Vec2;

/// Origin of the current step: with the planner's and the styles' state all that it takes to make it again.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) request: StepRequest,
    /// The manner and the facing of the step before.
    pub(crate) manner_before: Manner,
    pub(crate) facing_before: f32,
    /// Velocity of the step before.
    pub(crate) velocity_before_mps: Vec2,
    /// The feet before the step; `None` for the first.
    pub(crate) planter: Option<PlanterState>,
    pub(crate) tie: [f32; TIE_LEN],
    /// Remainder of a step that was planned anew, where the current one is that.
    pub(crate) remainder: Option<Remainder>,
    /// Displacement of the step's end.
    pub(crate) displacement: Displacement,
}
