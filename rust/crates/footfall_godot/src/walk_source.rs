//! Source of a walker's steps, prepared once for all walkers that share it.

use footfall_core::Skeleton;
use footfall_model::{DynamicsModel, GaitStyle, WalkModel};
use footfall_synth::{GaitGenerator, GeneratorConfig, StyleSpace, SynthError};
use std::sync::Arc;

/// A model as walkers use it.
#[derive(Clone, Debug)]
pub(crate) enum WalkSource {
    /// A trained walk and its styles.
    Styled(Arc<StyleSpace>),
    /// Two linear systems that take turns.
    Switching(Arc<DynamicsModel>),
}

impl WalkSource {
    /// A walker on this body.
    ///
    /// # Errors
    /// [`SynthError`] when the body cannot walk.
    pub(crate) fn generator(
        &self,
        style_weights: &[f32],
        body: &Skeleton,
        config: &GeneratorConfig,
    ) -> Result<GaitGenerator, SynthError> {
        match self {
            Self::Styled(space) => GaitGenerator::new(space, style_weights, body, config),
            Self::Switching(model) => GaitGenerator::switching(model, body, config),
        }
    }

    /// Returns whether both are one and the same.
    pub(crate) fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Styled(a), Self::Styled(b)) => Arc::ptr_eq(a, b),
            (Self::Switching(a), Self::Switching(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// Returns whether this was made of this model.
    pub(crate) fn is_of(&self, model: &WalkModel) -> bool {
        match (self, model) {
            (Self::Styled(space), WalkModel::Gait(model)) => Arc::ptr_eq(space.model(), model),
            (Self::Switching(own), WalkModel::Dynamics(model)) => Arc::ptr_eq(own, model),
            _ => false,
        }
    }

    /// The styles that its walkers can have.
    pub(crate) fn styles(&self) -> &[Arc<GaitStyle>] {
        match self {
            Self::Styled(space) => space.styles(),
            Self::Switching(_) => &[],
        }
    }
}
