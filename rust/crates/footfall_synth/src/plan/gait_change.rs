//! Steps in which the gait changes.

use super::step_plan::StepPlan;
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP};

/// Share of the new gait in each state of a step in which the gait changes.
const GONE_OVER: [f32; STATES_PER_STEP] = [0.15, 0.4, 0.7, 0.9, 1.0];

impl StepPlan<f32> {
    /// Turns this plan into a change of gait that begins like `before`, the same step in the previous gait. It lasts as long as the mean of both, and the first step of a run
    /// at least as long as others: hips that had a walked step's time to pass the foot ahead would not gain speed.
    pub(crate) fn go_over_from(&mut self, before: &Self) {
        let runs = self.shape.timing.take_off.is_some();
        for (frames, before) in self.state_frames.iter_mut().zip(before.state_frames) {
            *frames = if runs {
                *frames + before.saturating_sub(*frames).div_ceil(2)
            } else {
                frames.midpoint(before).max(1)
            };
        }
        let states = self.means.chunks_exact_mut(OBSERVATION_COUNT);
        let states = states.zip(before.means.chunks_exact(OBSERVATION_COUNT));
        for ((means, before), share) in states.zip(GONE_OVER) {
            for (mean, before) in means.iter_mut().zip(before) {
                *mean = before + share * (*mean - before);
            }
        }
        let frames: usize = self.state_frames.iter().sum();
        let detail = self.shape.detail.holding(frames);
        let whole = detail.whole_frames(frames);
        self.state_frames[STATES_PER_STEP - 1] += whole - frames;
        self.shape.detail = detail;
        let timing = &mut self.shape.timing;
        let scaled = |frame: usize| frame * whole / timing.frames;
        let (terminal, take_off) = (scaled(timing.terminal), timing.take_off.map(scaled));
        timing.terminal = terminal.clamp(1, whole - 2);
        timing.take_off = take_off.map(|last| last.clamp(2, whole - 1));
        timing.frames = whole;
        timing.sets_off = runs;
    }
}
