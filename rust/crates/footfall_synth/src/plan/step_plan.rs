//! The plan of one step: its shape, and the durations and means of its states.

use super::fine_draw::FineDraw;
use super::statistics::STEP_MEANS;
use super::timing::StepTiming;
use crate::detail::Detail;
use crate::gait::Amplitude;
use footfall_core::Side;
use footfall_model::STATES_PER_STEP;
use footfall_prob::mlpg::Real;

/// Longest flight, as a share of a running step.
const LONGEST_FLIGHT: f64 = 0.6;

/// Terminal contact of the other foot in a running step that follows a walking one, as a fraction of the step.
const RUN_TERMINAL: f64 = 0.15;

/// Minimum part of a starting step in which both feet stand.
const START_TERMINAL: f64 = 0.22;

/// Maximum duration of a step, seconds.
pub(crate) const MAX_STEP_SECS: f64 = 3.0;

/// Shape of a step: the part of a plan that planting needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepShape {
    pub(crate) timing: StepTiming,
    /// Factor on the legs' reach.
    pub(crate) stride: f64,
    /// Amplitude of the walk in the step.
    pub(crate) amplitude: Amplitude,
    pub(crate) detail: Detail,
}

/// A step ready to be generated.
#[derive(Clone, Debug)]
pub(crate) struct StepPlan<R> {
    pub(crate) shape: StepShape,
    /// Frames of each state.
    pub(crate) state_frames: [usize; STATES_PER_STEP],
    /// The means of every state, state by state.
    pub(crate) means: Vec<R>,
    /// Fine motion, added after the trajectory is solved.
    pub(crate) fine: FineDraw,
}

impl StepShape {
    /// Makes the shape of a step of this many frames. `terminal` is the time at which the other foot leaves the ground, as a fraction of the step; a negative
    /// one makes it a step of a run, which ends with a flight of that length.
    ///
    /// The length is rounded up to a whole number of planted frames.
    pub(crate) fn of_walk(
        leading: Side,
        frames: usize,
        terminal: f64,
        stride: f64,
        detail: Detail,
    ) -> Self {
        let detail = detail.holding(frames);
        let frames = detail.whole_frames(frames);
        let of_step = |share: f64| (share * frames as f64).round() as usize;
        let take_off = (terminal < 0.0)
            .then(|| of_step(1.0 + terminal.max(-LONGEST_FLIGHT)).clamp(2, frames - 1));
        let terminal = if take_off.is_some() {
            of_step(RUN_TERMINAL)
        } else {
            of_step(terminal.clamp(0.02, 0.6))
        };
        Self {
            timing: StepTiming {
                leading,
                frames,
                terminal: terminal.clamp(1, frames - 2),
                take_off,
                sets_off: false,
                borne: 0,
                airborne: false,
                rests: false,
            },
            stride,
            amplitude: Amplitude::WALK,
            detail,
        }
    }

    /// Number of planted frames, without the first of the next step.
    pub(crate) const fn ground_frames(&self) -> usize {
        self.timing.frames >> self.detail as u32
    }

    /// The timing in planted frames.
    pub(crate) fn ground_timing(&self) -> StepTiming {
        let stride = self.detail.stride();
        let frames = self.ground_frames();
        StepTiming {
            frames,
            terminal: (self.timing.terminal / stride).clamp(1, frames - 2),
            take_off: self
                .timing
                .take_off
                .map(|last| (last / stride).clamp(2, frames - 1)),
            borne: self.timing.borne / stride,
            ..self.timing
        }
    }

    /// Makes the step start or end a walk, or stand.
    pub(crate) fn set_amplitude(&mut self, amplitude: Amplitude) {
        self.amplitude = amplitude;
        self.timing.rests = amplitude.to <= 0.0;
        if amplitude.from < amplitude.to {
            let least = (START_TERMINAL * self.timing.frames as f64).round() as usize;
            self.timing.terminal = self.timing.terminal.max(least);
        }
    }
}

impl<R: Real> StepPlan<R> {
    /// Makes a plan that the planner can fill without allocating.
    pub(crate) fn empty() -> Self {
        Self {
            shape: StepShape::of_walk(Side::Left, 1, 0.0, 1.0, Detail::Full),
            state_frames: [0; STATES_PER_STEP],
            means: vec![R::default(); STEP_MEANS],
            fine: FineDraw::default(),
        }
    }

    /// State that a frame of the step is in.
    pub(super) fn state_at(&self, frame: usize) -> usize {
        let mut end = 0;
        let ends = self.state_frames.iter().map(|frames| {
            end += frames;
            end
        });
        let last = STATES_PER_STEP - 1;
        ends.take(last).take_while(|end| *end <= frame).count()
    }
}
