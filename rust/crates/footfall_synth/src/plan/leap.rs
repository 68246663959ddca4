//! Leaps: steps of a run whose flight lasts as long as the rise of the hips takes.

use super::step_plan::StepPlan;
use crate::detail::{Detail, MOST_GROUND_FRAMES};
use crate::gait::{GRAVITY_MPS2, Gait};
use footfall_model::STATES_PER_STEP;

/// Rise of the hips at the take-off from one foot above their height in walking and in running, metres. The rest of a leap's rise is
/// flight, within these bounds.
const LEAP_GAINS_M: [f32; 2] = [0.03, 0.015];
const LEAST_LEAP_M: f32 = 0.02;
const MOST_LEAP_M: f32 = 0.6;

/// Share of the rise by which the hips land lower than they took off: who falls lands on a bent leg.
const LANDING_LOWER: f32 = 0.1;

/// Minimum duration of a leap's stance, seconds: a high leap takes a longer push-off than a run.
const LEAP_STANCE_SECS: f64 = 0.28;

impl StepPlan<f32> {
    /// Turns a step of a run into a leap in which the hips rise by `rise_m` above their height in the previous steps, of the gait `before`. The stance lasts long enough to push
    /// off, and the flight as long as rise and fall take.
    pub(crate) fn leap(&mut self, rise_m: f32, before: Gait, frame_rate_hz: f64) {
        let Some(take_off) = self.shape.timing.take_off else {
            return;
        };
        let rise = (rise_m - LEAP_GAINS_M[before as usize]).clamp(LEAST_LEAP_M, MOST_LEAP_M);
        let secs = |way: f32| f64::from(2.0 * way / GRAVITY_MPS2).sqrt();
        let flight = (secs(rise) + secs(rise * (1.0 + LANDING_LOWER))) * frame_rate_hz;
        let least = LEAP_STANCE_SECS * frame_rate_hz;
        let mut stance = (take_off as f64).max(least);
        if stance + flight > MOST_GROUND_FRAMES as f64 {
            // From a slow step: nobody pushes off for so long, and parabolas need full detail.
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
