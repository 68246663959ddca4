//! Remainder of a step that is replanned while its foot is in the air.
//!
//! Controls may change in the middle of a swing. The remainder of the step then becomes a step of its own: it begins with a foot in the air, continues the
//! frames already shown, and takes the states of the new plan that have not passed yet. It need not fit the previous plan.

use super::step_plan::StepPlan;
use super::window::TIE;
use footfall_model::STATES_PER_STEP;

/// Last state in which a step can be replanned, and minimum number of frames left.
const LAST_STATE: usize = 2;
const LEAST_FRAMES: usize = 6;

/// Position within a step at which its remainder begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Remainder {
    /// Current state, and the share of it that is left.
    pub(crate) state: usize,
    pub(crate) left: f32,
    /// Share of the whole step that has passed.
    pub(crate) passed: f32,
}

impl Remainder {
    /// Returns the remainder of a plan from a frame on, after `before`; `None` when it is too late to replan.
    pub(crate) fn of<R>(plan: &StepPlan<R>, frame: usize, before: Option<Self>) -> Option<Self> {
        let frames = plan.shape.timing.frames;
        if frame + LEAST_FRAMES > frames {
            return None;
        }
        let mut begins = 0;
        let mut states = plan.state_frames.iter().enumerate();
        let (state, own) = states.find(|(_, own)| {
            begins += *own;
            frame < begins
        })?;
        let whole = before.filter(|before| before.state == state);
        let left = (begins - frame) as f32 / *own as f32 * whole.map_or(1.0, |before| before.left);
        let passed = before.map_or(0.0, |before| before.passed);
        (state <= LAST_STATE).then_some(Self {
            state,
            left,
            passed: passed + (1.0 - passed) * frame as f32 / frames as f32,
        })
    }

    /// Returns the share of the whole step that has passed at part `s` of its remainder.
    pub(crate) fn phase(remainder: Option<Self>, s: f32) -> f32 {
        remainder.map_or(s, |remainder| {
            remainder.passed + (1.0 - remainder.passed) * s
        })
    }

    /// Returns true when its values are valid.
    pub(crate) fn is_sensible(&self) -> bool {
        let shares = [self.left, self.passed];
        self.state <= LAST_STATE && shares.iter().all(|share| (0.0..=1.0).contains(share))
    }

    /// Reduces the plan of a whole step to the part that has not passed.
    pub(crate) fn keep<R>(&self, plan: &mut StepPlan<R>) {
        plan.state_frames[..self.state].fill(0);
        let own = &mut plan.state_frames[self.state];
        *own = ((*own as f32 * self.left).round() as usize).max(1);
        let frames: usize = plan.state_frames.iter().sum();
        let missing = LEAST_FRAMES.saturating_sub(frames);
        plan.state_frames[STATES_PER_STEP - 1] += missing;
        let timing = &mut plan.shape.timing;
        timing.frames = frames + missing;
        timing.terminal = 1;
    }

    /// Reduces the plan of the cut step to the frames that its remainder is tied to.
    pub(crate) fn hold<R>(&self, plan: &mut StepPlan<R>) {
        plan.state_frames.fill(0);
        plan.state_frames[self.state] = TIE - 1;
        plan.shape.timing.frames = TIE - 1;
    }
}
