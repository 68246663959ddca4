//! Window of three steps of one walker, which moves from step to step.

mod aim;
mod displace;
mod generate;
mod origin;
mod replan;

pub(crate) use aim::Aim;
pub(crate) use origin::Origin;

use super::buffers::StepBuffers;
use super::step_source::Stretches;
use super::style_space::Blend;
use crate::error::SynthError;
use crate::gait::{Amplitude, Manner, Pace, StepRequest};
use crate::ground::{Displacement, PlantedFrame, PlantedStep};
use crate::plan::{Planner, StepDraw, StepPlan, StepShape, TIE, TIE_LEN, WINDOW};
use footfall_core::{Side, Skeleton, StepPosition};
use glam::Vec2;
use std::sync::Arc;

/// Window of steps between the planner's draws and the step on the ground. Allocates only in [`new`](Self::new).
#[derive(Debug)]
pub(crate) struct StepWindow {
    blend: Arc<Blend>,
    /// Mixture of the previous step.
    blend_before: Arc<Blend>,
    draws: [StepDraw; WINDOW],
    plans: [StepPlan<f32>; WINDOW],
    /// True when the plans of the steps ahead are outdated.
    stale: bool,
    origin: Origin,
    /// Last frames of the current step, to which the next one is tied.
    end: [f32; TIE_LEN],
    planted: PlantedStep,
}

impl StepWindow {
    pub(crate) fn new(skeleton: &Skeleton, blend: &Arc<Blend>) -> Self {
        let longest = Planner::longest_step(&blend.model);
        let nothing = StepRequest {
            manner: Manner::inside(Pace {
                covariate_mps: 0.0,
                tempo: 1.0,
                stride: 1.0,
            }),
            amplitude: Amplitude::STAND,
            turn_rate: 0.0,
            velocity_mps: Vec2::ZERO,
            facing: 0.0,
            leap_m: None,
        };
        Self {
            blend: Arc::clone(blend),
            blend_before: Arc::clone(blend),
            draws: [(); WINDOW].map(|()| Planner::mean_draw(Side::Left)),
            plans: [(); WINDOW].map(|()| StepPlan::empty()),
            stale: true,
            end: [0.0; TIE_LEN],
            origin: Origin {
                request: nothing,
                manner_before: nothing.manner,
                facing_before: 0.0,
                velocity_before_mps: Vec2::ZERO,
                planter: None,
                tie: [0.0; TIE_LEN],
                remainder: None,
                displacement: Displacement::NONE,
            },
            planted: PlantedStep::new(skeleton, blend.model.frame_rate_hz, longest),
        }
    }

    /// Restarts with these steps: the second is the first to be shown, after a hidden one.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn start(
        &mut self,
        planner: &mut Planner,
        blend: &Arc<Blend>,
        draws: [StepDraw; WINDOW],
        request: StepRequest,
        buffers: &mut StepBuffers,
    ) -> Result<(), SynthError> {
        self.blend = Arc::clone(blend);
        self.blend_before = Arc::clone(blend);
        self.draws = draws;
        self.stale = request.amplitude != Amplitude::WALK;
        self.origin.request = request;
        self.origin.manner_before = request.manner;
        self.origin.facing_before = request.facing;
        self.origin.velocity_before_mps = request.velocity_mps;
        self.origin.planter = None;
        self.origin.remainder = None;
        self.origin.displacement = Displacement::NONE;
        for (draw, plan) in self.draws.iter().zip(&mut self.plans) {
            planner.plan_step(draw, request.manner, &blend.statistics, plan);
            plan.shape.set_amplitude(request.amplitude);
        }
        buffers.start(&blend.statistics, &self.plans)?;
        self.planted.clear();
        self.plant(0, 0, buffers);
        self.plant(1, self.plans[0].shape.timing.frames, buffers);
        Ok(())
    }

    /// Generates the next step; `draw` is that of the step after it.
    pub(crate) fn advance(
        &mut self,
        planner: &mut Planner,
        blend: &Arc<Blend>,
        draw: StepDraw,
        request: StepRequest,
        buffers: &mut StepBuffers,
    ) {
        // A new pace or style applies to all steps ahead, so that it takes effect at once.
        let same = !self.stale
            && self.origin.request.manner == request.manner
            && request.manner.position == StepPosition::Inside
            && [request.leap_m, self.origin.request.leap_m] == [None; 2]
            && Arc::ptr_eq(&self.blend, blend);
        self.origin = self.next_origin(request);
        self.draws.rotate_left(1);
        self.plans.rotate_left(1);
        self.draws[WINDOW - 1] = draw;
        self.blend_before = core::mem::replace(&mut self.blend, Arc::clone(blend));
        self.stale = false;
        self.plan(planner, if same { WINDOW - 1 } else { 1 }, buffers);
        self.solve_and_plant(buffers);
    }

    /// Plants the current step again, quicker by the factor `haste` and shorter by the same factor, and then with the factors on the
    /// legs' reach that `next` returns. Returns their product. The very first step stays unchanged.
    pub(crate) fn stretch(
        &mut self,
        planner: &mut Planner,
        haste: f64,
        next: &mut Stretches<'_>,
        buffers: &mut StepBuffers,
    ) -> f32 {
        let mut whole = 1.0;
        let Some(feet) = self.origin.planter else {
            return whole;
        };
        let mut solved = false;
        if haste > 1.0 {
            let pace = &mut self.origin.request.manner.pace;
            *pace = pace.quicker(haste);
            self.planted.resume(&feet);
            self.plan(planner, 1, buffers);
            self.solve_and_plant(buffers);
            solved = true;
        }
        while let Some(share) = next(&self.plans[1].shape, &self.planted) {
            whole *= share;
            let stride = self.origin.request.manner.pace.stride * f64::from(share);
            self.origin.request.manner.pace.stride = stride;
            self.plans[1].shape.stride = stride;
            self.planted.resume(&feet);
            if solved {
                self.plant(1, TIE - 1, buffers);
            } else {
                // The solved trajectory was not kept.
                self.solve_and_plant(buffers);
                solved = true;
            }
        }
        whole
    }

    /// Returns the origin of the step after the current one, for this request.
    pub(crate) fn next_origin(&self, request: StepRequest) -> Origin {
        Origin {
            request,
            manner_before: self.origin.request.manner,
            facing_before: self.origin.request.facing,
            velocity_before_mps: self.origin.request.velocity_mps,
            planter: self.planted.planter_state(),
            tie: self.end,
            remainder: None,
            displacement: Displacement::NONE,
        }
    }

    /// Generates a step again from its origin.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn restore(
        &mut self,
        planner: &mut Planner,
        [blend_before, blend]: [&Arc<Blend>; 2],
        draws: [StepDraw; WINDOW],
        origin: Origin,
        buffers: &mut StepBuffers,
    ) -> Result<(), SynthError> {
        let Some(state) = origin.planter else {
            planner.set_model(&blend.model);
            return self.start(planner, blend, draws, origin.request, buffers);
        };
        self.draws = draws;
        planner.set_model(&blend_before.model);
        // Only the last frames of the previous step matter.
        planner.plan_step_end(
            &self.draws[0],
            origin.manner_before,
            TIE,
            &blend_before.statistics,
            &mut self.plans[0],
        );
        planner.set_model(&blend.model);
        self.blend_before = Arc::clone(blend_before);
        self.blend = Arc::clone(blend);
        self.planted.resume(&state);
        self.origin = origin;
        self.stale = false;
        self.plan(planner, 1, buffers);
        self.solve_and_plant(buffers);
        Ok(())
    }

    /// Returns true when all frames of the current step are finite, and none turns far from the one before: poses between them are blended as near ones.
    pub(crate) fn is_sound(&self) -> bool {
        let frames = &self.planted.frames[..=self.plans[1].shape.ground_frames()];
        frames.iter().all(PlantedFrame::is_finite)
            && frames.windows(2).all(|pair| pair[0].is_near(&pair[1]))
    }

    /// Returns the share of the current step that had passed when it was replanned.
    fn passed(&self) -> f64 {
        self.origin
            .remainder
            .map_or(0.0, |remainder| f64::from(remainder.passed))
    }

    /// Returns the shape of the current step.
    pub(crate) fn step(&self) -> &StepShape {
        &self.plans[1].shape
    }

    /// Returns the current step on the ground.
    pub(crate) fn planted(&self) -> &PlantedStep {
        &self.planted
    }

    /// Returns the origin of the current step.
    pub(crate) fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Returns the random draws of the steps in the window.
    pub(crate) fn draws(&self) -> &[StepDraw; WINDOW] {
        &self.draws
    }

    /// Returns the mixtures of the previous step and of the current one.
    pub(crate) fn blends(&self) -> [&Arc<Blend>; 2] {
        [&self.blend_before, &self.blend]
    }
}
