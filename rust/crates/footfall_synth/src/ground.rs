//! Puts generated rotations on the ground, one step at a time: root travel, planted feet, legs that reach them.
//!
//! The model generates rotations only; the travel of the body follows from the foot that stands (Tilmanne et al. 2012,
//! section 5.2.3). Here the standing foot rolls on its plant without sliding ([`footfall_ik::rocker`]), the hips follow from
//! it through the generated leg, and both legs are then solved so that each foot is exactly where it belongs. What
//! generated rotations and planted feet disagree about is spread over the swing.

mod arrival;
mod balance;
mod bounce;
mod course;
mod cut;
mod displacement;
mod even_travel;
mod flight;
mod frame;
mod generated;
mod heel_rise;
mod height_smoothing;
mod hip_height;
mod landing;
mod lean;
mod placing;
mod plant_step;
mod planted_step;
mod planter;
mod planter_state;
mod reach;
mod run_travel;
mod speed_change;
mod strafe;
mod support;
mod swing;
mod travel;

pub(crate) use arrival::{Arrival, landings};
pub(crate) use course::Course;
pub(crate) use displacement::Displacement;
pub(crate) use frame::PlantedFrame;
pub(crate) use generated::{GeneratedFrame, Stride};
pub(crate) use placing::Placing;
pub(crate) use planted_step::PlantedStep;
pub(crate) use planter::Planter;
pub(crate) use planter_state::{Airborne, Lean, PlanterState};
pub(crate) use speed_change::SpeedChange;
pub(crate) use strafe::Strafe;
