//! Plan of the coming steps: durations and means of their states.

mod draw;
mod offsets;
mod planner;
pub(crate) mod remainder;
pub(crate) mod statistics;
pub(crate) mod timing;

use crate::detail::{Detail, MOST_GROUND_FRAMES};
use crate::gait::stand::{Amplitude, START_TERMINAL};
use crate::gait::{GRAVITY_MPS2, Gait};
use crate::trajectory::fine_motion::FineDraw;
use footfall_core::{Side, StepPosition};
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::mlpg::Real;
pub(crate) use offsets::Sum;
pub(crate) use planner::{MAX_COMPONENTS, Planner};
use statistics::STEP_MEANS;
use timing::StepTiming;

/// Share of a running step that is spent in the air at most.
const LONGEST_FLIGHT: f64 = 0.6;

/// When the other foot leaves the ground in a running step that follows a walking one, as a fraction of it.
const RUN_TERMINAL: f64 = 0.15;

/// Shares by which the states of a step in which the gait changes have gone over into the new one.
const GONE_OVER: [f32; STATES_PER_STEP] = [0.15, 0.4, 0.7, 0.9, 1.0];

/// Hips of somebody who takes off from one foot are higher by about this than they were in walking and in running, metres; the rest of a leap's rise is
/// flight, within these bounds.
const LEAP_GAINS_M: [f32; 2] = [0.04, -0.01];
const LEAST_LEAP_M: f32 = 0.02;
const MOST_LEAP_M: f32 = 0.6;

/// A leap's stance lasts at least so long, seconds: who rises high pushes off for longer than who runs.
const LEAP_STANCE_SECS: f64 = 0.28;

/// A step lasts at most this long, seconds.
pub(crate) const MAX_STEP_SECS: f64 = 3.0;

/// Pace of a step: the result of the speed response and the limits of the model for a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Place on the model's speed response, m/s.
    pub(crate) covariate_mps: f64,
    /// Factor on the rate at which states pass.
    pub(crate) tempo: f64,
    /// Factor on the legs' reach forwards and backwards.
    pub(crate) stride: f64,
}

/// Manner of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Manner {
    pub(crate) pace: Pace,
    /// Place in the walk.
    pub(crate) position: StepPosition,
    pub(crate) detail: Detail,
}

impl Manner {
    /// Inside a walk, in full detail.
    pub(crate) const fn inside(pace: Pace) -> Self {
        Self {
            pace,
            position: StepPosition::Inside,
            detail: Detail::Full,
        }
    }
}

/// Random draw of a step; its pace may still change.
#[derive(Clone, Debug)]
pub(crate) struct StepDraw {
    pub(crate) side: Side,
    pub(crate) weights: [f64; MAX_COMPONENTS],
}

/// Shape of a step as the ground has to know it.
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
    /// Fine motion that is added after its trajectory is solved.
    pub(crate) fine: FineDraw,
}

impl StepShape {
    /// A step of so many frames; `terminal` is when the other foot leaves the ground, as a fraction of it. Where that is before the step, it is one of
    /// a run, and ends with a flight as long as that.
    ///
    /// Frames become a whole number of those that are put on the ground.
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
                airborne: false,
                rests: false,
            },
            stride,
            amplitude: Amplitude::WALK,
            detail,
        }
    }

    /// Frames that are put on the ground, without the first of the next step.
    pub(crate) const fn ground_frames(&self) -> usize {
        self.timing.frames >> self.detail as u32
    }

    /// The timing in frames that are put on the ground.
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
    /// A plan that [`Planner::realise`] can fill without allocating.
    pub(crate) fn empty() -> Self {
        Self {
            shape: StepShape::of_walk(Side::Left, 1, 0.0, 1.0, Detail::Full),
            state_frames: [0; STATES_PER_STEP],
            means: vec![R::default(); STEP_MEANS],
            fine: FineDraw::default(),
        }
    }

    /// State that a frame of the step is in.
    fn state_at(&self, frame: usize) -> usize {
        let mut end = 0;
        let ends = self.state_frames.iter().map(|frames| {
            end += frames;
            end
        });
        let last = STATES_PER_STEP - 1;
        ends.take(last).take_while(|end| *end <= frame).count()
    }
}

impl StepPlan<f32> {
    /// Makes this the step in which one gait goes over into another: it begins as the same step of the gait `before` does. The first
    /// step of a run lasts as long as the walk's, whose foot has landed as far ahead; the first of a walk as long as the mean of both.
    pub(crate) fn go_over_from(&mut self, before: &Self) {
        let runs = self.shape.timing.take_off.is_some();
        let longer = self.state_frames.iter_mut().zip(before.state_frames);
        for (frames, before) in longer {
            *frames = if runs {
                before.max(*frames)
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
    }
}

impl StepPlan<f32> {
    /// Makes a step of a run a leap in which the hips rise this high above where they were in the steps before, of this gait: the stance lasts long enough to push off, and the
    /// flight as long as the rise and the fall take.
    pub(crate) fn leap(&mut self, rise_m: f32, before: Gait, frame_rate_hz: f64) {
        let Some(take_off) = self.shape.timing.take_off else {
            return;
        };
        let rise = (rise_m - LEAP_GAINS_M[before as usize]).clamp(LEAST_LEAP_M, MOST_LEAP_M);
        let flight = 2.0 * (2.0 * f64::from(rise / GRAVITY_MPS2)).sqrt() * frame_rate_hz;
        let least = LEAP_STANCE_SECS * frame_rate_hz;
        let mut stance = (take_off as f64).max(least);
        if stance + flight > MOST_GROUND_FRAMES as f64 {
            // Out of a slow step: nobody pushes off for so long, and parabolas need full detail.
            let room = (MOST_GROUND_FRAMES - STATES_PER_STEP) as f64 - flight;
            stance = stance.min(room).max(least);
        }
        let frames = self.shape.timing.frames;
        // The same step, slower before the take-off and slower still after it.
        let warped = |frame: usize| {
            let bearing = frame.min(take_off) as f64 / take_off as f64;
            let flying = frame.saturating_sub(take_off) as f64 / (frames - take_off) as f64;
            (bearing * stance + flying * flight).round() as usize
        };
        let mut passed = 0;
        for state in &mut self.state_frames {
            let [from, to] = [passed, passed + *state].map(warped);
            passed += *state;
            *state = (to - from).max(1);
        }
        let frames: usize = self.state_frames.iter().sum();
        let detail = Detail::Full.holding(frames);
        let whole = detail.whole_frames(frames);
        self.state_frames[STATES_PER_STEP - 1] += whole - frames;
        self.shape.detail = detail;
        let timing = &mut self.shape.timing;
        timing.frames = whole;
        timing.terminal = warped(timing.terminal).clamp(1, whole - 2);
        timing.take_off = Some(warped(take_off).clamp(2, whole - 1));
    }
}
