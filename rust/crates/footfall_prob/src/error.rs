//! Errors in the numbers that a caller hands in.

use thiserror::Error;

/// Reason for which an inference function refused its input.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProbError {
    /// A slice has the wrong length for the other arguments.
    #[error("{what} holds {found} values, expected {expected}: check its rows and columns")]
    Shape {
        /// The argument.
        what: &'static str,
        /// The length that the other arguments ask for.
        expected: usize,
        /// The length that was given.
        found: usize,
    },
    /// A value is NaN or infinite.
    #[error("{what}[{index}] is {value}: remove frames or parameters that are not finite")]
    NotFinite {
        /// The argument.
        what: &'static str,
        /// Place in the slice (row-major).
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// A value that must be above zero is not.
    #[error("{what}[{index}] is {value}, it must be above zero: raise it or set a floor")]
    NotPositive {
        /// The argument.
        what: &'static str,
        /// Place in the slice.
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// An index points past the end of the table that it selects from.
    #[error("{what}[{index}] is {value}, but only {len} exist")]
    IndexOutOfRange {
        /// The argument.
        what: &'static str,
        /// Place in the slice.
        index: usize,
        /// The offending index.
        value: usize,
        /// Number of entries in the table.
        len: usize,
    },
    /// An argument that needs at least one entry is empty.
    #[error("{what} is empty: give at least one")]
    Empty {
        /// The argument.
        what: &'static str,
    },
    /// The sequence has fewer frames than the chain has segments.
    #[error(
        "{frames} frames are too few for a chain of {segments} segments: every segment lasts at \
         least one frame, so shorten the chain or drop the sequence"
    )]
    SequenceTooShort {
        /// Frames in the sequence.
        frames: usize,
        /// Segments in the chain.
        segments: usize,
    },
    /// The sequence is longer than all segments at their longest.
    #[error(
        "{frames} frames are too many for a chain that can last {longest} at most: raise the \
         maximum duration or label more steps"
    )]
    SequenceTooLong {
        /// Frames in the sequence.
        frames: usize,
        /// The sum of the segments' maximum durations.
        longest: usize,
    },
    /// Every segmentation has probability zero.
    #[error(
        "no segmentation of the {frames} frames has a probability above zero: check the duration tables"
    )]
    NoSegmentation {
        /// Frames in the sequence.
        frames: usize,
    },
    /// A distribution cannot be estimated because no data reached it.
    #[error("{what} received no data: tie it to another state or add sequences that visit it")]
    NoData {
        /// The distribution.
        what: &'static str,
    },
    /// A matrix that must be positive definite is not.
    #[error(
        "the trajectory of dimension {dim} is not determined: give every state a static precision \
         above zero, or a weaker pull"
    )]
    NotPositiveDefinite {
        /// Feature dimension.
        dim: usize,
    },
    /// A linear transform is not determined by its data.
    #[error("the {what} is singular: give more or more varied frames, or a prior")]
    Degenerate {
        /// Name of the quantity that is not determined.
        what: &'static str,
    },
}

/// Checks a slice length.
pub(crate) fn check_len(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), ProbError> {
    if found == expected {
        Ok(())
    } else {
        Err(ProbError::Shape {
            what,
            expected,
            found,
        })
    }
}

/// Checks that every value is finite.
pub(crate) fn check_finite(what: &'static str, values: &[f64]) -> Result<(), ProbError> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(index) => Err(ProbError::NotFinite {
            what,
            index,
            value: values[index],
        }),
    }
}

/// Checks that every value is finite and above zero.
pub(crate) fn check_positive(what: &'static str, values: &[f64]) -> Result<(), ProbError> {
    check_finite(what, values)?;
    match values.iter().position(|&v| v <= 0.0) {
        None => Ok(()),
        Some(index) => Err(ProbError::NotPositive {
            what,
            index,
            value: values[index],
        }),
    }
}
