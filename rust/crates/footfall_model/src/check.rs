//! Faults of models, and the checks that find them.

/// Fault of a model's content.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ModelError {
    /// A part has the wrong size.
    #[error(
        "{part} has {found} numbers instead of {expected}; train the model again with `footfall train`"
    )]
    Shape {
        /// The part.
        part: String,
        /// Number of values expected.
        expected: usize,
        /// Number of values found.
        found: usize,
    },
    /// A number is not finite, or not positive where it must be.
    #[error(
        "{part}: a number is not finite or out of range; train the model again with `footfall train`"
    )]
    Value {
        /// The part.
        part: String,
    },
}

pub(crate) fn check_len(part: &str, values: &[f64], expected: usize) -> Result<(), ModelError> {
    if values.len() == expected {
        return Ok(());
    }
    Err(ModelError::Shape {
        part: part.to_owned(),
        expected,
        found: values.len(),
    })
}

pub(crate) fn check_finite(part: &str, values: &[f64]) -> Result<(), ModelError> {
    check_values(part, values, f64::is_finite)
}

pub(crate) fn check_positive(part: &str, values: &[f64]) -> Result<(), ModelError> {
    check_values(part, values, |value| value.is_finite() && value > 0.0)
}

fn check_values(part: &str, values: &[f64], holds: impl Fn(f64) -> bool) -> Result<(), ModelError> {
    if values.iter().all(|value| holds(*value)) {
        return Ok(());
    }
    Err(ModelError::Value {
        part: part.to_owned(),
    })
}
