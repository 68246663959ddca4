//! Plan of the coming steps: durations and means of their states.

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
pub(crate) use planner::Planner;
pub(crate) use remainder::Remainder;
pub(crate) use statistics::Statistics;
pub(crate) use step_draw::{MAX_COMPONENTS, StepDraw};
pub(crate) use step_plan::{MAX_STEP_SECS, StepPlan, StepShape};
pub(crate) use timing::StepTiming;
pub(crate) use window::{TIE, TIE_LEN, WINDOW};
