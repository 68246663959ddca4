//! Standing motion: sway, glances and breathing on top of the standing posture.
//!
//! [`sway`] computes the body's offset from its posture, [`righting`] that of a body that stopped, [`carry`] applies them over planted feet, and [`life`] fades them in and out.

mod carry;
mod fade;
mod life;
mod noise;
mod righting;
mod sway;

pub(crate) use life::{Life, Moment};
pub(crate) use righting::Righting;
pub(crate) use sway::StandingTables;
