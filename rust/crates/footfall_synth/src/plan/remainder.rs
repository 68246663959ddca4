//! Remainder of a step that is replanned while its foot is in the air.
//!
//! Controls may change in the middle of a swing. The remainder of the step then becomes a step of its own: it begins with a foot in the air, continues the
//! frames already shown, and takes the states of the new plan that have not passed yet. It need not fit the previous plan.

use super::step_plan::StepPlan;
use super::window::TIE;
use footfall_model::STATES_PER_STEP;

/// Minimum number of frames left of the step.
const LEAST_FRAMES: usize = 6;

/// Latest moment of a step at which it is replanned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    last_state: usize,
    /// Minimum number of frames left of a runner's stance.
    pub(crate) bearing_frames: usize,
}

impl Deadline {
    /// For a walker's own controls.
    pub(crate) const OWN: Self = Self {
        last_state: 2,
        bearing_frames: 7,
    };

    /// For the controls of another machine, which come late: changes before this one may have been lost, so that other states have passed.
    pub(crate) const LED: Self = Self {
        last_state: 3,
        bearing_frames: 3,
    };
}

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
    /// Returns the remainder of a plan from a frame on, after `before`; `None` after the deadline.
    pub(crate) fn of<R>(
        plan: &StepPlan<R>,
        frame: usize,
        before: Option<Self>,
        deadline: Deadline,
    ) -> Option<Self> {
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
        (state <= deadline.last_state).then_some(Self {
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
        self.state <= Deadline::LED.last_state
            && shares.iter().all(|share| (0.0..=1.0).contains(share))
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
        timing.borne = timing.frames.saturating_sub(frames);
        timing.frames = frames + missing;
        timing.terminal = 1;
        timing.take_off = timing.take_off.map(|last| {
            let left = last.saturating_sub(timing.borne);
            left.clamp(2, timing.frames - 1)
        });
    }

    /// Reduces the plan of the cut step to the frames that its remainder is tied to.
    pub(crate) fn hold<R>(&self, plan: &mut StepPlan<R>) {
        plan.state_frames.fill(0);
        plan.state_frames[self.state] = TIE - 1;
        plan.shape.timing.frames = TIE - 1;
    }
}
