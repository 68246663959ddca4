//! Puts generated rotations on the ground, one step at a time: root travel, planted feet, legs that reach them.
//!
//! The model generates rotations only; the travel of the body follows from the foot that stands (Tilmanne et al. 2012,
//! section 5.2.3). Here the standing foot rolls on its plant without sliding ([`footfall_ik::rocker`]), the hips follow from
//! it through the generated leg, and both legs are then solved so that each foot is exactly where it belongs. What
//! generated rotations and planted feet disagree about is spread over the swing.

mod balance;
mod bounce;
pub(crate) mod cut;
pub(crate) mod displacement;
mod even_travel;
pub(crate) mod flight;
pub(crate) mod generated;
mod heel_rise;
mod height_smoothing;
mod hip_height;
mod landing;
pub(crate) mod lean;
pub(crate) mod planter;
pub(crate) mod planter_state;
mod reach;
mod run_travel;
pub(crate) mod speed_change;
pub(crate) mod step;
pub(crate) mod strafe;
mod support;
mod swing;
mod travel;
