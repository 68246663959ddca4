//! One walker, step after step: planning, trajectory and planting in a row.

mod aim;
mod displace;
mod origin;
mod replan;

pub(crate) use aim::Aim;
pub(crate) use origin::Origin;

use super::buffers::StepBuffers;
use super::step_source::Stretches;
use super::style_space::Blend;
use crate::error::SynthError;
use crate::gait::{Amplitude, Gait, Manner, Pace, StepRequest};
use crate::ground::{Displacement, Placing, PlantedStep};
use crate::plan::{Planner, Remainder, StepDraw, StepPlan, StepShape, TIE, TIE_LEN, WINDOW};
use crate::trajectory::{Scale, neighbours};
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_model::FEATURE_COUNT;
use glam::Vec2;
use std::sync::Arc;

/// No fine motion.
const NO_SCALE: Scale = [0.0; FEATURE_COUNT];

/// One walker between the planner's draws and frames on the ground; allocates nothing after it was made.
#[derive(Debug)]
pub(crate) struct StepWindow {
    blend: Arc<Blend>,
    /// The mixture of the step before.
    blend_before: Arc<Blend>,
    draws: [StepDraw; WINDOW],
    plans: [StepPlan<f32>; WINDOW],
    /// True when the steps ahead are not those of the last request.
    stale: bool,
    origin: Origin,
    /// The last frames of the current step, which tie the next one to it.
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

    /// Starts over with these steps: the second is the first that shows, and the one before brings it into its stride.
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

    /// Goes on to the next step; `draw` is one that lies ahead of it.
    pub(crate) fn advance(
        &mut self,
        planner: &mut Planner,
        blend: &Arc<Blend>,
        draw: StepDraw,
        request: StepRequest,
        buffers: &mut StepBuffers,
    ) {
        // A new pace or style is taken up by every step ahead: what is asked now takes effect at once.
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

    /// Puts the current step on the ground anew, quicker by the factor `haste` and shorter by as much, and then with the factors on the
    /// legs' reach that `next` gives; returns what these make together. The first step came from nowhere and stays.
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
            pace.tempo *= haste;
            pace.stride /= haste;
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
                // Nobody kept what it was made of.
                self.solve_and_plant(buffers);
                solved = true;
            }
        }
        whole
    }

    /// Origin of the step after the current one when this is requested of it.
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

    /// Makes a step from where it comes from.
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
        // Of the step before only the last frames count.
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

    fn plan(&mut self, planner: &mut Planner, first: usize, buffers: &mut StepBuffers) {
        let request = self.origin.request;
        let changes = first <= 1 && self.blend_before.gait != self.blend.gait;
        if changes {
            planner.set_model(&self.blend_before.model);
            let before = &self.blend_before.statistics;
            let manner = Manner {
                detail: request.manner.detail,
                ..Manner::inside(self.origin.manner_before.pace)
            };
            planner.plan_step(&self.draws[1], manner, before, &mut buffers.going_over);
            planner.set_model(&self.blend.model);
        }
        // The step ahead is that of someone who walks on.
        let ahead = match request.manner.position {
            StepPosition::First => StepPosition::Second,
            _ => StepPosition::Inside,
        };
        let positions = [request.manner.position, request.manner.position, ahead];
        let steps = self.draws.iter().zip(&mut self.plans).zip(positions);
        for ((draw, plan), position) in steps.skip(first) {
            let manner = Manner {
                position,
                ..request.manner
            };
            planner.plan_step(draw, manner, &self.blend.statistics, plan);
        }
        if changes {
            self.plans[1].go_over_from(&buffers.going_over);
        }
        if let Some(rise_m) = request.leap_m {
            let before = self.blend_before.gait;
            self.plans[1].leap(rise_m, before, self.blend.model.frame_rate_hz);
        }
        self.plans[1].shape.set_amplitude(request.amplitude);
        if let Some(remainder) = self.origin.remainder
            && first <= 1
        {
            remainder.keep(&mut self.plans[1]);
            let fine = self.plans[0].fine;
            let manner = self.origin.manner_before;
            planner.plan_step(
                &self.draws[1],
                manner,
                &self.blend.statistics,
                &mut self.plans[0],
            );
            remainder.hold(&mut self.plans[0]);
            self.plans[0].fine = fine;
        }
    }

    /// The share of the current step that had passed when it was planned anew.
    fn passed(&self) -> f64 {
        self.origin
            .remainder
            .map_or(0.0, |remainder| f64::from(remainder.passed))
    }

    /// Solves the current step and the one ahead, tied to the step before, and puts the current one on the ground.
    fn solve_and_plant(&mut self, buffers: &mut StepBuffers) {
        let changes = self.blend_before.gait != self.blend.gait;
        buffers.go_on(
            &self.blend.statistics,
            &self.plans,
            &self.origin.tie,
            changes,
        );
        self.plant(1, TIE - 1, buffers);
    }

    /// The step that is on the ground now.
    pub(crate) fn step(&self) -> &StepShape {
        &self.plans[1].shape
    }

    /// The ground that it is on.
    pub(crate) fn planted(&self) -> &PlantedStep {
        &self.planted
    }

    /// Origin of the current step.
    pub(crate) fn origin(&self) -> &Origin {
        &self.origin
    }

    /// Random draws of the steps in the window.
    pub(crate) fn draws(&self) -> &[StepDraw; WINDOW] {
        &self.draws
    }

    /// The mixtures of the step before and of the current one.
    pub(crate) fn blends(&self) -> [&Arc<Blend>; 2] {
        [&self.blend_before, &self.blend]
    }

    /// Puts a step of the window, which begins with frame `first` of what was solved, on the ground.
    fn plant(&mut self, step: usize, first: usize, buffers: &mut StepBuffers) {
        let shape = &self.plans[step].shape;
        let remainder = self.origin.remainder.filter(|_| step == 1);
        self.end = buffers.tie_at(first + shape.timing.frames + 1 - TIE);
        let blends = [&*self.blend_before, &*self.blend];
        let placing = placing(&self.origin, &self.plans, blends, step);
        let StepBuffers {
            trajectory,
            generated,
            fine,
            shown,
            ..
        } = buffers;
        let trajectory = &trajectory[first * FEATURE_COUNT..];
        let [before, now] = [&self.blend_before, &self.blend];
        // A gait has a fine motion of its own: that of the one before goes as that of the other comes.
        let fading = (before.gait != now.gait).then_some((before, [&before.fine_scale, &NO_SCALE]));
        let scale_before = if fading.is_some() {
            &NO_SCALE
        } else {
            &before.fine_scale
        };
        let motions = fading
            .into_iter()
            .chain([(now, [scale_before, &now.fine_scale])]);
        let length = (shape.timing.frames + 1) * FEATURE_COUNT;
        let shown = &mut shown[..length];
        shown.copy_from_slice(&trajectory[..length]);
        for (blend, scales) in motions {
            let Some(tables) = &blend.fine else { continue };
            fine.prepare(tables, shape.timing.leading, &neighbours(&self.plans, step));
            let rows = shown.chunks_exact_mut(FEATURE_COUNT).enumerate();
            for (frame, row) in rows.step_by(shape.detail.stride()) {
                let phase = Remainder::phase(remainder, frame as f32 / shape.timing.frames as f32);
                fine.add(phase, scales, row);
            }
        }
        self.planted
            .put(shown.chunks_exact(FEATURE_COUNT), &placing, generated);
    }
}

/// Placing of a step of the window on the ground, after a step in one mixture and in another.
fn placing<'a>(
    origin: &Origin,
    plans: &'a [StepPlan<f32>; WINDOW],
    [before, now]: [&'a Blend; 2],
    step: usize,
) -> Placing<'a> {
    let remainder = origin.remainder.filter(|_| step == 1);
    let velocity = origin.request.velocity_mps;
    let runs = now.gait == Gait::Run && velocity != Vec2::ZERO;
    Placing {
        shape: &plans[step].shape,
        standing: [&before.standing, &now.standing],
        turn_rate: origin.request.turn_rate,
        facing: [origin.facing_before, origin.request.facing],
        velocity_mps: now.gait.seen_from_steps(velocity),
        velocity_before_mps: before.gait.seen_from_steps(origin.velocity_before_mps),
        direction: runs.then(|| velocity.x.atan2(velocity.y)),
        passed: remainder.map_or(0.0, |remainder| remainder.passed),
        displacement: if step == 1 {
            origin.displacement
        } else {
            Displacement::NONE
        },
        keeps_lengths: true,
    }
}
