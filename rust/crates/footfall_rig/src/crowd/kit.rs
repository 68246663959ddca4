//! Kit of a crowd's walkers: the model with its styles on the crowd's body, and mixtures of them.

use footfall_core::Skeleton;
use footfall_model::{GaitModel, GaitStyle};
use footfall_synth::{StyleSpace, StyledBody, SynthError, Workshop};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Weights of styles are rounded to such parts, so that a crowd needs few mixtures.
const WEIGHT_PARTS: f32 = 8.0;

/// A mixture of styles: a weight each, in parts; styles at its end that nothing is worn of are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Outfit(Vec<i8>);

impl Outfit {
    /// The nearest to these weights; what is not finite counts as 0.
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

    /// One that was told in parts.
    pub(super) fn of_parts(parts: &[i8]) -> Self {
        let weights: Vec<f32> = parts
            .iter()
            .map(|part| f32::from(*part) / WEIGHT_PARTS)
            .collect();
        Self::of(&weights)
    }

    /// Its parts.
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
    /// Styles that walkers wear.
    pub styles: Vec<Arc<GaitStyle>>,
    /// The two prepared, if somebody else has done so.
    pub space: Option<Arc<StyleSpace>>,
    /// Proportions of the character.
    pub body: Skeleton,
}

/// Everything that all walkers of a crowd share.
#[derive(Debug)]
pub(super) struct Kit {
    pub(super) space: Arc<StyleSpace>,
    pub(super) plain: StyledBody,
    pub(super) workshops: Vec<Mutex<Workshop>>,
    worn: Mutex<HashMap<Outfit, StyledBody>>,
}

impl Kit {
    /// Prepares it, some 10 ms a style.
    ///
    /// # Errors
    /// [`SynthError`] when nobody can walk.
    pub(super) fn new(recipe: &CrowdRecipe) -> Result<Self, SynthError> {
        let space = match &recipe.space {
            Some(space) => Arc::clone(space),
            None => Arc::new(StyleSpace::new(&recipe.model, &recipe.styles)?),
        };
        let plain = StyledBody::new(&space, &[], &recipe.body)?;
        // One for each thread, and one for who calls.
        let threads = rayon::current_num_threads() + 1;
        let workshops = (0..threads).map(|_| Mutex::new(Workshop::new(&plain)));
        Ok(Self {
            workshops: workshops.collect(),
            worn: Mutex::new(HashMap::from([(Outfit::default(), plain.clone())])),
            plain,
            space,
        })
    }

    /// A mixture, if somebody wears it already.
    pub(super) fn known(&self, outfit: &Outfit) -> Option<StyledBody> {
        self.worn().get(outfit).cloned()
    }

    /// A mixture, measured if nobody wears it yet, some 2 ms.
    pub(super) fn tailor(&self, outfit: &Outfit) -> StyledBody {
        if let Some(known) = self.known(outfit) {
            return known;
        }
        let body = self.plain.skeleton();
        // A mixture that gives no walk is not worn.
        let styled = StyledBody::new(&self.space, &outfit.weights(), body)
            .unwrap_or_else(|_| self.plain.clone());
        let mut worn = self.worn();
        let number = worn.len() as u32;
        let numbered = || styled.numbered(number);
        worn.entry(outfit.clone()).or_insert_with(numbered).clone()
    }

    /// Number of mixtures.
    pub(super) fn count(&self) -> usize {
        self.worn().len()
    }

    /// Mixtures by their numbers: those from this one on.
    pub(super) fn numbered_from(&self, number: u32) -> Vec<StyledBody> {
        let worn = self.worn();
        let mut fresh: Vec<StyledBody> = worn
            .values()
            .filter(|styled| styled.number() >= number)
            .cloned()
            .collect();
        fresh.sort_by_key(StyledBody::number);
        fresh
    }

    fn worn(&self) -> MutexGuard<'_, HashMap<Outfit, StyledBody>> {
        self.worn.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_rounded_and_nonsense_is_nothing() {
        assert_eq!(Outfit::of(&[0.0, 0.52, f32::NAN]).weights(), [0.0, 0.5]);
        assert_eq!(Outfit::of(&[0.0; 3]), Outfit::default());
        assert_eq!(Outfit::of_one(2, 1.0).weights(), [0.0, 0.0, 1.0]);
        assert_eq!(Outfit::of(&[1e9]).weights(), [4.0]);
    }
}
