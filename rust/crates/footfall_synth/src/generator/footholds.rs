//! Footholds: coming landings, and steps adapted to the terrain.

use super::GaitGenerator;
use crate::ground::{PlantedStep, landings};
use crate::plan::StepShape;
use crate::source::{Aim, Steps};
use footfall_core::GroundTransform;
use footfall_ik::placement::Landing;
use std::sync::Arc;

/// Share of a step until which it can still change.
const STRETCHED_UNTIL: f32 = 0.25;
/// Limits of shortening and lengthening a step.
const SHORTEST: f32 = 0.25;
const LONGEST: f32 = 1.5;
/// Greatest factor on its tempo: people do not hurry up stairs.
const MOST_HASTE: f32 = 1.5;
/// Shortest step and tolerance of its length, metres, and the maximum number of trials for it.
const SHORT_STEP_M: f32 = 0.05;
const SAME_LENGTH_M: f32 = 0.01;
const STRETCHES: usize = 3;

impl GaitGenerator {
    /// Returns the next landing of each foot and the body's place then, for callers that place feet on real ground.
    pub fn landings(&self) -> [Option<Landing>; 2] {
        let arrival = &self.steps.source().planted().arrival;
        landings(self.next_footstep(), &self.plan_from_character(), arrival)
    }

    /// Returns the place where the current step ends, relative to the start of the walk: that of the landing foot, under the walker's heading, or that of a
    /// resting walker.
    pub(crate) fn start_from_aim(&self, rests: bool) -> GroundTransform {
        let source = self.steps.source();
        source
            .planted()
            .aim(&self.plan_from_start, self.shape(), rests)
    }

    /// Displaces the current step, which has just been planned, towards its aim, as far as one step can.
    pub(crate) fn aim_at(&mut self, aim: &Aim) {
        let plan_from_start = self.plan_from_start;
        if let Steps::Styled(steps) = &mut self.steps {
            let (space, window) = (Arc::clone(&steps.space), &mut steps.window);
            space.with_buffers(|buffers| window.aim_at(aim, &plan_from_start, buffers));
        }
    }

    /// Keeps the current step unchanged: new controls wait for the next one. For callers that have chosen a foothold for it.
    pub fn keep_step(&mut self) {
        self.steps.source_mut().keep();
    }

    /// Sets the grade of the way, rise over run, positive uphill: the trunk leans into it. Holds until the next call.
    ///
    /// A grade that is not finite counts as level. A switching model ignores it.
    pub fn set_grade(&mut self, grade: f32) {
        if let Some(moves) = &mut self.moves {
            moves.climb(grade);
        }
    }

    /// Scales the length of the step that has just begun by this share, within people's limits. The walk continues at the resulting
    /// speed and returns to the requested one over the next steps. A step further under way stays as it is.
    pub fn stretch_step(&mut self, share: f32) {
        let timing = self.shape().timing;
        let begun = self.position < STRETCHED_UNTIL * timing.frames as f32;
        if !begun || timing.rests || !share.is_finite() {
            return;
        }
        let length = step_length(self.shape(), self.steps.source().planted());
        let wanted = share.clamp(SHORTEST, LONGEST) * length;
        if wanted < SHORT_STEP_M {
            return;
        }
        // Shorter steps at the same speed are quicker; less so when the walker brakes.
        let secs = timing.frames as f32 / self.frame_rate_hz;
        let quickest = (secs * self.requested_mps / wanted).min(length / wanted);
        let haste = quickest.clamp(1.0, MOST_HASTE);
        let mut trials = 0..STRETCHES;
        let mut next = |shape: &StepShape, planted: &PlantedStep| {
            trials.next()?;
            let length = step_length(shape, planted);
            let far = (length - wanted).abs() >= SAME_LENGTH_M;
            far.then(|| wanted / length.max(SHORT_STEP_M))
        };
        self.steps.source_mut().stretch(haste, &mut next);
    }
}

/// Returns the distance of the landing foot ahead of the standing one, metres.
fn step_length(shape: &StepShape, planted: &PlantedStep) -> f32 {
    let way = planted.travel(shape).normalize_or_zero();
    let leading = shape.timing.leading;
    let [from, to] = [leading, leading.other()].map(|side| planted.plant(side));
    from.zip(to)
        .map_or(0.0, |(from, to)| (to.flat_ankle - from.flat_ankle).dot(way))
}
