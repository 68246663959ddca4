//! Identity of a walker, sent once and after each change.

use super::ReplicaError;
use super::update::FORMAT;
use crate::config::GeneratorConfig;
use crate::generator::GaitGenerator;
use crate::source::Steps;
use footfall_core::hash::fnv1a;
use serde::{Deserialize, Serialize};

/// Maximum number of styles in an identity, and maximum weight of one.
const MOST_STYLES: usize = 64;
const MOST_WEIGHT: f32 = 16.0;
const MOST_VARIATION: f32 = 16.0;
/// Maximum size without the styles, bytes.
const UNSTYLED_BYTES: usize = 40;

/// Model, seed, settings and styles of a walker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WalkIdentity {
    format: u8,
    model: u32,
    seed: u64,
    phase: f32,
    variation: f32,
    epoch: u8,
    /// Weights of the styles, as of [`GaitGenerator::set_style_weights`].
    pub style_weights: Vec<f32>,
}

impl WalkIdentity {
    /// Makes the identity of a walker; `times` counts its moves elsewhere.
    ///
    /// # Errors
    /// [`ReplicaError::Switching`].
    pub(super) fn of(generator: &GaitGenerator, epoch: u8) -> Result<Self, ReplicaError> {
        let Steps::Styled(steps) = &generator.steps else {
            return Err(ReplicaError::Switching);
        };
        Ok(Self {
            format: FORMAT,
            model: steps.space.fingerprint(),
            seed: generator.config.seed,
            phase: generator.config.phase,
            variation: generator.config.variation,
            epoch,
            style_weights: steps.blend().weights.clone(),
        })
    }

    /// Returns the settings for the walker.
    pub fn config(&self) -> GeneratorConfig {
        GeneratorConfig {
            seed: self.seed,
            phase: self.phase,
            variation: self.variation,
        }
    }

    /// Returns true when both are the same walker, regardless of styles and place.
    pub fn is_same_walker(&self, other: &Self) -> bool {
        (self.model, self.config()) == (other.model, other.config())
    }

    /// Checks that a walker uses this identity's model.
    ///
    /// # Errors
    /// [`ReplicaError::OtherModel`] or [`ReplicaError::Switching`].
    pub fn check(&self, generator: &GaitGenerator) -> Result<(), ReplicaError> {
        match &generator.steps {
            Steps::Switching(_) => Err(ReplicaError::Switching),
            Steps::Styled(steps) if steps.space.fingerprint() != self.model => {
                Err(ReplicaError::OtherModel)
            }
            Steps::Styled(_) => Ok(()),
        }
    }

    /// Packs it: some 25 bytes, and four per style.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Writing to memory does not fail; an empty message is refused like any other that is no identity.
        postcard::to_stdvec(self).unwrap_or_default()
    }

    /// Unpacks it.
    ///
    /// # Errors
    /// [`ReplicaError::Format`] or [`ReplicaError::Identity`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ReplicaError> {
        if let Some(format) = bytes.first()
            && *format != FORMAT
        {
            return Err(ReplicaError::Format(*format));
        }
        let longest = UNSTYLED_BYTES + 4 * MOST_STYLES;
        let identity: Self = (bytes.len() <= longest)
            .then(|| postcard::from_bytes(bytes).ok())
            .flatten()
            .ok_or(ReplicaError::Identity)?;
        let weights = &identity.style_weights;
        let sensible = identity.phase.is_finite()
            && (0.0..=MOST_VARIATION).contains(&identity.variation)
            && weights.len() <= MOST_STYLES
            && weights.iter().all(|weight| weight.abs() <= MOST_WEIGHT);
        sensible.then_some(identity).ok_or(ReplicaError::Identity)
    }

    /// Returns the tag of this walker's updates.
    pub(super) fn tag(&self) -> u16 {
        tag(self.model, &self.config(), self.epoch)
    }
}

/// Returns the tag of a walker's updates, which changes with the model, the seed, the settings and each move elsewhere.
pub(super) fn tag(model: u32, config: &GeneratorConfig, epoch: u8) -> u16 {
    let numbers = [
        u64::from(model),
        config.seed,
        u64::from(config.phase.to_bits()),
        u64::from(config.variation.to_bits()),
        u64::from(epoch),
    ];
    let hash = fnv1a(numbers.into_iter().flat_map(u64::to_le_bytes));
    (hash ^ hash >> 16 ^ hash >> 32 ^ hash >> 48) as u16
}
