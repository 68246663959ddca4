//! Motion of a body that rests: sway, looks about and breath, above the posture in which it stands.
//!
//! [`sway`] computes the body's offset from its posture, [`carry`] applies it over planted feet, and [`life`] holds its amount.

mod carry;
mod life;
mod noise;
mod sway;

pub(crate) use life::{Life, Moment};
pub(crate) use sway::StandingTables;
