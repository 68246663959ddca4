//! Replanning of the remainder of a step.

use super::generate::placing;
use super::{Origin, StepWindow};
use crate::detail::Detail;
use crate::gait::{Amplitude, StepRequest};
use crate::ground::Displacement;
use crate::plan::{Planner, Remainder};
use crate::source::buffers::StepBuffers;
use footfall_core::ease::smooth_step;
use std::sync::Arc;

impl StepWindow {
    /// Replans the current step from a frame on, if one foot is in the air and enough of the step is left; returns true if it did. `request` derives the new
    /// request from the current one, the frames of the whole step and the share that has passed.
    pub(crate) fn replan(
        &mut self,
        planner: &mut Planner,
        frame: usize,
        request: impl FnOnce(&StepRequest, f64, f64) -> StepRequest,
        buffers: &mut StepBuffers,
    ) -> bool {
        let shape = self.plans[1].shape;
        let before = self.origin.request;
        let same = Arc::ptr_eq(&self.blend_before, &self.blend);
        let usual = before.amplitude == Amplitude::WALK && before.manner.detail == Detail::Full;
        let (Some(begun), true) = (self.origin.planter, same && usual) else {
            return false;
        };
        let Some(remainder) = Remainder::of(&self.plans[1], frame, self.origin.remainder) else {
            return false;
        };
        let blends = [&*self.blend_before, &*self.blend];
        let placing = placing(&self.origin, &self.plans, blends, 1);
        let Some(feet) = self.planted.cut(&shape, frame, &begun, &placing) else {
            return false;
        };
        // The solved trajectory was not kept.
        self.solve(buffers);
        let tie = buffers.tie_at(frame);
        let whole = shape.timing.frames as f64 / (1.0 - self.passed());
        let [facing_before, facing] = [self.origin.facing_before, before.facing];
        let share = smooth_step(frame as f32 / shape.timing.frames as f32);
        self.origin = Origin {
            request: request(&before, whole, f64::from(remainder.passed)),
            manner_before: before.manner,
            facing_before: facing_before + share * (facing - facing_before),
            velocity_before_mps: before.velocity_mps,
            planter: Some(feet),
            tie,
            remainder: Some(remainder),
            displacement: Displacement::NONE,
        };
        self.planted.resume(&feet);
        self.stale = false;
        self.plan(planner, 1, buffers);
        self.solve_and_plant(buffers);
        true
    }
}
