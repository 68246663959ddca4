//! Size of the window of steps that is planned and solved at a time.

use footfall_model::FEATURE_COUNT;

/// Steps in a window: the one before, the one to be put on the ground, and one ahead, which shapes its end. What lies
/// beyond does not show: a frame's influence has died away after half a step.
pub(crate) const WINDOW: usize = 3;

/// Frames that tie a window to the one before: the longest dynamic window couples no more.
pub(crate) const TIE: usize = 4;

/// Numbers that tie a window to the one before.
pub(crate) const TIE_LEN: usize = TIE * FEATURE_COUNT;
