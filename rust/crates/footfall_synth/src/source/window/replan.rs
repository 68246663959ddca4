//! Replanning of the remainder of a step.

use super::generate::placing;
use super::{Origin, StepWindow};
use crate::detail::Detail;
use crate::gait::{Passed, StepRequest};
use crate::ground::Displacement;
use crate::plan::{Deadline, Planner, Remainder};
use crate::source::buffers::StepBuffers;
use footfall_core::ease::smooth_step;
use std::sync::Arc;

impl StepWindow {
    /// Replans the current step from a frame on, if one foot is in the air and enough of the step is left; returns true if it did. `request` derives the new
    /// request from the current one and the part of the step that has passed.
    pub(crate) fn replan(
        &mut self,
        planner: &mut Planner,
        (frame, deadline): (usize, Deadline),
        request: impl FnOnce(&StepRequest, &Passed) -> StepRequest,
        buffers: &mut StepBuffers,
    ) -> bool {
        let shape = self.plans[1].shape;
        let before = self.origin.request;
        let changes_gait = self.changes_gait();
        let same = changes_gait || Arc::ptr_eq(&self.blend_before, &self.blend);
        let usual = before.amplitude.walks_on()
            && before.manner.detail == Detail::Full
            && before.leap_m.is_none();
        let (Some(begun), true) = (self.origin.planter, same && usual) else {
            return false;
        };
        let Some(remainder) = Remainder::of(&self.plans[1], frame, self.origin.remainder, deadline)
        else {
            return false;
        };
        let blends = [&*self.blend_before, &*self.blend];
        let placing = placing(&self.origin, &self.plans, blends, 1);
        let cut_at = (frame, deadline.bearing_frames);
        let Some(feet) = self.planted.cut(&shape, cut_at, &begun, &placing) else {
            return false;
        };
        // The solved trajectory was not kept.
        self.solve(buffers);
        let tie = buffers.tie_at(frame);
        let [facing_before, facing] = [self.origin.facing_before, before.facing];
        let timing = &shape.timing;
        let share = frame as f32 / timing.frames as f32;
        let (hips_mps, room_m) = feet.room(timing.leading);
        let passed = Passed {
            whole_frames: timing.frames as f64 / (1.0 - self.passed()),
            share: f64::from(remainder.passed),
            standing: timing.leading,
            borne: timing.take_off.map_or(remainder.passed, |last| {
                (timing.borne + frame) as f32 / (timing.borne + last) as f32
            }),
            velocity_mps: self
                .origin
                .velocity_before_mps
                .lerp(before.velocity_mps, share),
            hips_mps,
            room_m,
        };
        let share = smooth_step(share);
        self.origin = Origin {
            request: request(&before, &passed),
            // A change of gait still comes from the pace of the previous one.
            manner_before: if changes_gait {
                self.origin.manner_before
            } else {
                before.manner
            },
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
