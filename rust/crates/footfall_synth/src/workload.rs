//! Benchmark workloads, outside the public interface.

use crate::config::GeneratorConfig;
use crate::error::SynthError;
use crate::source::SwitchingSteps;
use footfall_core::{Side, Skeleton};
use footfall_model::DynamicsModel;
use std::sync::Arc;

/// Switching model that generates the features of one segment after another, without ground.
#[derive(Debug)]
pub struct SwitchingWorkload(SwitchingSteps);

impl SwitchingWorkload {
    /// # Errors
    /// [`SynthError`] when the model cannot be used.
    pub fn new(model: &Arc<DynamicsModel>) -> Result<Self, SynthError> {
        let config = GeneratorConfig {
            seed: 1,
            phase: 0.0,
            variation: 1.0,
        };
        SwitchingSteps::new(model, &Skeleton::standard(), &config, Side::Left).map(Self)
    }

    /// Generates the next segment; returns its number of frames.
    pub fn segment(&mut self) -> usize {
        self.0.generate_next()
    }
}
