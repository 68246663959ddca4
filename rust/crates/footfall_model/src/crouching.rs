//! Crouching: the posture of a low body, standing or walking.

use crate::check::{ModelError, check_finite, check_len};
use crate::jumping::BESIDE_COUNT;

/// Posture of crouching people.
#[derive(Clone, Debug, PartialEq)]
pub struct CrouchModel {
    /// The deepest crouch of the recordings beside the same person upright: [`BESIDE_COUNT`] numbers, the same left and right but for the arms. The hips' way upwards
    /// is negative; legs are 0, for they follow from the feet.
    pub beside: Vec<f64>,
    /// Fastest that people go as low as that, leg lengths a second.
    pub fastest: f64,
}

impl CrouchModel {
    /// Checks every shape and value.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        check_len("crouch", &self.beside, BESIDE_COUNT)?;
        check_finite("crouch", &self.beside)?;
        if self.fastest.is_finite() && self.fastest > 0.0 {
            return Ok(());
        }
        Err(ModelError::Value {
            part: "speed of a crouch".to_owned(),
        })
    }
}
