//! Standing motion: sway, glances and breathing on top of the standing posture.
//!
//! [`sway`] computes the body's offset from its posture, [`carry`] applies it over planted feet, and [`life`] fades it in and out.

mod carry;
mod life;
mod noise;
mod sway;

pub(crate) use life::{Life, Moment};
pub(crate) use sway::StandingTables;
