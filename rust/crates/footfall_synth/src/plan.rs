//! Plans: from the request for a step to the timing, durations and means of its states.
//!
//! [`Planner`] draws a step by chance and adds speed, position in the walk, person and chance to the model's average step. A plan can become the change to another gait
//! ([`gait_change`]), a leap ([`leap`]), or the remainder of a step that is replanned ([`remainder`]).

mod fine_draw;
mod gait_change;
mod leap;
mod numbering;
mod offsets;
mod planner;
mod remainder;
mod statistics;
mod step_draw;
mod step_plan;
mod timing;
mod window;

pub(crate) use fine_draw::FineDraw;
pub(crate) use numbering::step_number;
pub(crate) use planner::Planner;
pub(crate) use remainder::{Deadline, Remainder};
pub(crate) use statistics::Statistics;
pub(crate) use step_draw::{MAX_COMPONENTS, StepDraw};
pub(crate) use step_plan::{MAX_STEP_SECS, StepPlan, StepShape};
pub(crate) use timing::StepTiming;
pub(crate) use window::{TIE, TIE_LEN, WINDOW};
