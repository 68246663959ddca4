//! Style mixtures of a crowd: the model with its styles on the crowd's body, prepared once for all walkers with the same weights.

use footfall_core::Skeleton;
use footfall_model::{GaitModel, GaitStyle};
use footfall_synth::{StyleSpace, StyledBody, SynthError, Workshop};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Weights of styles are rounded to multiples of 1/8, so that a crowd needs few mixtures.
const WEIGHT_PARTS: f32 = 8.0;

/// Weights of styles in eighths; zeros at the end are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct StyleMixture(Vec<i8>);

impl StyleMixture {
    /// The nearest mixture to these weights; non-finite weights count as 0.
    pub(super) fn of(weights: &[f32]) -> Self {
        let part = |weight: &f32| {
            let weight = if weight.is_finite() { *weight } else { 0.0 };
            (weight * WEIGHT_PARTS).round().clamp(-32.0, 32.0) as i8
        };
        let mut parts: Vec<i8> = weights.iter().map(part).collect();
        while parts.last() == Some(&0) {
            parts.pop();
        }
        Self(parts)
    }

    /// A mixture from its weights in eighths.
    pub(super) fn of_parts(parts: &[i8]) -> Self {
        let weights: Vec<f32> = parts
            .iter()
            .map(|part| f32::from(*part) / WEIGHT_PARTS)
            .collect();
        Self::of(&weights)
    }

    /// The weights in eighths.
    pub(super) fn parts(&self) -> &[i8] {
        &self.0
    }

    /// One style alone.
    pub(super) fn of_one(style: usize, weight: f32) -> Self {
        let mut weights = vec![0.0; style + 1];
        weights[style] = weight;
        Self::of(&weights)
    }

    pub(super) fn weights(&self) -> Vec<f32> {
        let parts = self.0.iter();
        parts.map(|part| f32::from(*part) / WEIGHT_PARTS).collect()
    }
}

/// Walk, styles and body of a crowd's walkers.
#[derive(Clone, Debug)]
pub struct CrowdRecipe {
    /// The walk.
    pub model: Arc<GaitModel>,
    /// Styles of walkers.
    pub styles: Vec<Arc<GaitStyle>>,
    /// Model and styles prepared together, if that was done before.
    pub space: Option<Arc<StyleSpace>>,
    /// Proportions of the character.
    pub body: Skeleton,
}

/// Bodies of all style mixtures in use, and the workshops of a crowd.
#[derive(Debug)]
pub(super) struct Mixtures {
    pub(super) space: Arc<StyleSpace>,
    pub(super) plain: StyledBody,
    pub(super) workshops: Vec<Mutex<Workshop>>,
    bodies: Mutex<HashMap<StyleMixture, StyledBody>>,
}

impl Mixtures {
    /// Prepares model and styles, about 10 ms for each style.
    ///
    /// # Errors
    /// [`SynthError`] if the model and the body give no walk.
    pub(super) fn new(recipe: &CrowdRecipe) -> Result<Self, SynthError> {
        let space = match &recipe.space {
            Some(space) => Arc::clone(space),
            None => Arc::new(StyleSpace::new(&recipe.model, &recipe.styles)?),
        };
        let plain = StyledBody::new(&space, &[], &recipe.body)?;
        // One for each thread, and one for the caller.
        let threads = rayon::current_num_threads() + 1;
        let workshops = (0..threads).map(|_| Mutex::new(Workshop::new(&plain)));
        Ok(Self {
            workshops: workshops.collect(),
            bodies: Mutex::new(HashMap::from([(StyleMixture::default(), plain.clone())])),
            plain,
            space,
        })
    }

    /// The body of a mixture, if one was prepared already.
    pub(super) fn get(&self, mixture: &StyleMixture) -> Option<StyledBody> {
        self.bodies().get(mixture).cloned()
    }

    /// The body of a mixture; the first call for a mixture prepares it, which takes about 2 ms.
    pub(super) fn get_or_make(&self, mixture: &StyleMixture) -> StyledBody {
        if let Some(known) = self.get(mixture) {
            return known;
        }
        let body = self.plain.skeleton();
        // A mixture that gives no walk is replaced by the plain body.
        let styled = StyledBody::new(&self.space, &mixture.weights(), body)
            .unwrap_or_else(|_| self.plain.clone());
        let mut bodies = self.bodies();
        let number = bodies.len() as u32;
        let numbered = || styled.numbered(number);
        bodies
            .entry(mixture.clone())
            .or_insert_with(numbered)
            .clone()
    }

    /// Number of mixtures.
    pub(super) fn count(&self) -> usize {
        self.bodies().len()
    }

    /// Mixtures by their numbers: those from this one on.
    pub(super) fn numbered_from(&self, number: u32) -> Vec<StyledBody> {
        let bodies = self.bodies();
        let mut fresh: Vec<StyledBody> = bodies
            .values()
            .filter(|styled| styled.number() >= number)
            .cloned()
            .collect();
        fresh.sort_by_key(StyledBody::number);
        fresh
    }

    fn bodies(&self) -> MutexGuard<'_, HashMap<StyleMixture, StyledBody>> {
        self.bodies.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_rounded_and_nonsense_is_nothing() {
        assert_eq!(
            StyleMixture::of(&[0.0, 0.52, f32::NAN]).weights(),
            [0.0, 0.5]
        );
        assert_eq!(StyleMixture::of(&[0.0; 3]), StyleMixture::default());
        assert_eq!(StyleMixture::of_one(2, 1.0).weights(), [0.0, 0.0, 1.0]);
        assert_eq!(StyleMixture::of(&[1e9]).weights(), [4.0]);
    }
}
