//! The ground: from generated features to a planted step, with root travel, planted feet and legs that reach them.
//!
//! [`PlantedStep`] holds the step on the ground. `PlantedStep::put` decodes features to legs ([`generated`]), turns them towards the direction of travel ([`strafe`]), and
//! `Planter::plant_step` plants them part by part ([`plant_step`]).
//!
//! The model generates rotations only; the travel of the body follows from the standing foot (Tilmanne et al. 2012,
//! section 5.2.3). Here the standing foot rolls on its plant without sliding ([`footfall_ik::rocker`]), the hips follow from
//! it through the generated leg, and both legs are then solved so that each foot is exactly in its place. Differences
//! between generated rotations and planted feet are spread over the swing.

mod arrival;
mod balance;
mod bounce;
mod braked_travel;
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
mod look;
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
mod turning;

pub(crate) use arrival::{Arrival, landings};
pub(crate) use course::Course;
pub(crate) use displacement::Displacement;
pub(crate) use frame::PlantedFrame;
pub(crate) use generated::{GeneratedFrame, Stride};
pub(crate) use lean::HEAD_KEPT;
pub(crate) use look::{Look, look};
pub(crate) use placing::Placing;
pub(crate) use planted_step::PlantedStep;
pub(crate) use planter::Planter;
pub(crate) use planter_state::{Airborne, Lean, PlanterState};
pub(crate) use speed_change::SpeedChange;
pub(crate) use strafe::Strafe;
pub(crate) use turning::spread;
