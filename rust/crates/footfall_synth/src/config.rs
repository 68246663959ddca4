//! Settings of one walker.

use crate::error::SynthError;
use footfall_core::{Side, Skeleton};

/// Longest time that a single call advances, seconds.
pub(crate) const MAX_DT_SECS: f32 = 10.0;

/// Settings that distinguish one walker from another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratorConfig {
    /// Seed of the walker's manner and of the variation of its steps.
    pub seed: u64,
    /// Initial phase of the stride: 0 is the left foot's initial contact, 0.5 the right's.
    pub phase: f32,
    /// Deviation of walkers and steps from the average: 0 none, 1 as in the recordings.
    pub variation: f32,
}

/// Checks the inputs of a walker, and returns the foot that lands first.
pub(crate) fn check(skeleton: &Skeleton, config: &GeneratorConfig) -> Result<Side, SynthError> {
    skeleton.check()?;
    for (setting, value) in [("phase", config.phase), ("variation", config.variation)] {
        if !value.is_finite() {
            return Err(SynthError::Setting { setting, value });
        }
    }
    let phase = config.phase.rem_euclid(1.0);
    Ok(if phase < 0.5 { Side::Left } else { Side::Right })
}
