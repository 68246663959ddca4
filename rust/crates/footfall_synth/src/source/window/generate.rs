//! The way of a step: planned, solved as a trajectory, and planted.

use super::StepWindow;
use super::origin::Origin;
use crate::detail::Detail;
use crate::gait::{Gait, Manner};
use crate::ground::{Displacement, Placing};
use crate::plan::{Planner, Remainder, StepPlan, TIE, WINDOW};
use crate::source::buffers::{Change, StepBuffers};
use crate::source::style_space::Blend;
use crate::trajectory::{Scale, add_leap, neighbours};
use footfall_core::StepPosition;
use footfall_core::ease::smooth_step;
use footfall_model::FEATURE_COUNT;
use glam::Vec2;

/// Distance below which two paces are the same.
const SAME_PACE: f64 = 0.05;

/// No fine motion.
const NO_SCALE: Scale = [0.0; FEATURE_COUNT];

impl StepWindow {
    /// Plans the steps of the window from this one on.
    pub(super) fn plan(&mut self, planner: &mut Planner, first: usize, buffers: &mut StepBuffers) {
        let request = self.origin.request;
        let changes = first <= 1 && self.changes_gait();
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
        // The step ahead is planned as if the walk continued.
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
            let manner = if changes {
                request.manner
            } else {
                self.origin.manner_before
            };
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

    /// Returns true when the current step goes over from one gait to another.
    pub(super) fn changes_gait(&self) -> bool {
        self.blend_before.gait != self.blend.gait
    }

    /// Solves the current step and the one ahead, tied to the previous step, and plants the current one.
    pub(super) fn solve_and_plant(&mut self, buffers: &mut StepBuffers) {
        self.solve(buffers);
        self.plant(1, TIE - 1, buffers);
    }

    /// Solves the window, tied to the previous step.
    pub(super) fn solve(&self, buffers: &mut StepBuffers) {
        let before = self.origin.manner_before.pace;
        let change = if self.changes_gait() {
            Change::Gait
        } else if self.origin.request.manner.pace.distance(&before) > SAME_PACE {
            Change::Pace
        } else {
            Change::None
        };
        let statistics = &self.blend.statistics;
        buffers.go_on(statistics, &self.plans, &self.origin.tie, change);
    }

    /// Plants a step of the window, which begins at frame `first` of the solved trajectory.
    pub(super) fn plant(&mut self, step: usize, first: usize, buffers: &mut StepBuffers) {
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
        // Each gait has its own fine motion; they cross-fade in a change of gait.
        let fading = self
            .changes_gait()
            .then_some((before, [&before.fine_scale, &NO_SCALE]));
        let scale_before = if fading.is_some() {
            &NO_SCALE
        } else {
            &before.fine_scale
        };
        let motions = fading
            .into_iter()
            .chain([(now, [scale_before, &now.fine_scale])]);
        let paces = [self.origin.manner_before, self.origin.request.manner];
        let [calm_before, calm] = paces.map(|manner| manner.pace.fine_share());
        let length = (shape.timing.frames + 1) * FEATURE_COUNT;
        let shown = &mut shown[..length];
        shown.copy_from_slice(&trajectory[..length]);
        for (blend, scales) in motions {
            let Some(tables) = &blend.fine else { continue };
            fine.prepare(tables, shape.timing.leading, &neighbours(&self.plans, step));
            let rows = shown.chunks_exact_mut(FEATURE_COUNT).enumerate();
            for (frame, row) in rows.step_by(shape.detail.stride()) {
                let part = frame as f32 / shape.timing.frames as f32;
                let share = calm_before + smooth_step(part) * (calm - calm_before);
                fine.add(Remainder::phase(remainder, part), share, scales, row);
            }
        }
        if let Some(rise_m) = self.origin.request.leap_m.filter(|_| step == 1) {
            add_leap(shown, &shape.timing, rise_m);
        }
        self.planted
            .put(shown.chunks_exact(FEATURE_COUNT), &placing, generated);
    }
}

/// Returns the placing of a step of the window, between two mixtures.
pub(super) fn placing<'a>(
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
        walking: [&before.walking, &now.walking],
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
        // What far walkers of a crowd show as they stand is recorded in the coarsest detail, and repeats.
        rights_itself: now.model.standing.is_some() && plans[step].shape.detail != Detail::Quarter,
        keeps_lengths: true,
    }
}
