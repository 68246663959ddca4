//! Origin of a step.

use crate::gait::{Manner, StepRequest};
use crate::ground::{Displacement, PlanterState};
use crate::plan::{Remainder, TIE_LEN};
use glam::Vec2;

/// Origin of a step: with the state of planner and styles, all data needed to generate it again.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) request: StepRequest,
    /// Manner and facing of the previous step.
    pub(crate) manner_before: Manner,
    pub(crate) facing_before: f32,
    /// Velocity of the previous step.
    pub(crate) velocity_before_mps: Vec2,
    /// Feet before the step; `None` for the first.
    pub(crate) planter: Option<PlanterState>,
    pub(crate) tie: [f32; TIE_LEN],
    /// Remainder of a replanned step, if this is one.
    pub(crate) remainder: Option<Remainder>,
    /// Displacement of the step's end.
    pub(crate) displacement: Displacement,
}
