//! Requests for a step, and what a step was made from.

use super::TIE;
use crate::gait::stand::Amplitude;
use crate::ground::displacement::Aside;
use crate::ground::planter_state::PlanterState;
use crate::plan::Manner;
use crate::plan::remainder::Rest;
use footfall_model::FEATURE_COUNT;
use glam::Vec2;

/// Numbers that tie a window to the one before.
pub(crate) const TIE_LEN: usize = TIE * FEATURE_COUNT;

/// Request for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Request {
    pub(crate) manner: Manner,
    pub(crate) amplitude: Amplitude,
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// Travel to the left and forwards from where the walker faces.
    pub(crate) velocity_mps: Vec2,
    /// Heading under which the walk goes along +Z, radians: people hold their hips a little askew.
    pub(crate) facing: f32,
    /// Rise of the hips in a leap, if it is one, metres.
    pub(crate) leap_m: Option<f32>,
}

/// Origin of the current step: with the planner's and the styles' state all that it takes to make it again.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) request: Request,
    /// The manner and the facing of the step before.
    pub(crate) manner_before: Manner,
    pub(crate) facing_before: f32,
    /// Velocity of the step before.
    pub(crate) velocity_before_mps: Vec2,
    /// The feet before the step; `None` for the first.
    pub(crate) planter: Option<PlanterState>,
    pub(crate) tie: [f32; TIE_LEN],
    /// Rest of a step that was planned anew, where the current one is that.
    pub(crate) rest: Option<Rest>,
    /// Displacement of the step's end.
    pub(crate) aside: Aside,
}
