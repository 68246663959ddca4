//! Size of the window of steps that are planned and solved together.

use footfall_model::FEATURE_COUNT;

/// Steps in a window: the previous step, the one to be planted, and one ahead, which shapes its end. Steps farther ahead
/// have no visible influence: that of a frame fades within half a step.
pub(crate) const WINDOW: usize = 3;

/// Frames that tie a window to the previous one: as many as the longest dynamic window couples.
pub(crate) const TIE: usize = 4;

/// Number of values that tie a window to the previous one.
pub(crate) const TIE_LEN: usize = TIE * FEATURE_COUNT;
