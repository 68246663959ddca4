//! Style space: a model and its styles, prepared once for fast mixtures.

use super::buffers::{BufferPool, StepBuffers};
use crate::error::SynthError;
use crate::gait::{Gait, Posture, mean_posture, standing_features};
use crate::moves::MoveTables;
use crate::plan::Statistics;
use crate::standing::StandingTables;
use crate::trajectory::{FineTables, Scale, variance};
use footfall_model::{FEATURE_COUNT, GaitModel, GaitStyle};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A model and its styles, shared by any number of walkers.
#[derive(Debug)]
pub struct StyleSpace {
    model: Arc<GaitModel>,
    fingerprint: u32,
    styles: Vec<Arc<GaitStyle>>,
    /// Pull per feature that preserves the variance of the base walk and of each style.
    base_pull: Vec<f64>,
    style_pulls: Vec<Vec<f64>>,
    /// Parts of the model's run; `None` where it only walks.
    running: Option<RunningParts>,
    fine: Option<Arc<FineTables>>,
    /// Standing of the model's people; `None` where it stands still.
    standing: Option<Arc<StandingTables>>,
    /// Crouches and jumps of its people.
    moves: Arc<MoveTables>,
    /// Mixtures in use.
    blends: Mutex<Vec<Weak<Blend>>>,
    buffers: BufferPool,
}

/// Parts that all runs of a model share.
#[derive(Debug)]
struct RunningParts {
    pull: Vec<f64>,
    fine: Option<Arc<FineTables>>,
}

/// One mixture of styles, ready to walk.
#[derive(Debug)]
pub(crate) struct Blend {
    /// One weight per style.
    pub(crate) weights: Vec<f32>,
    pub(crate) model: Arc<GaitModel>,
    pub(crate) statistics: Statistics<f32>,
    pub(crate) standing: Posture,
    /// Mean posture of its steps.
    pub(crate) walking: Posture,
    pub(crate) fine: Option<Arc<FineTables>>,
    /// Factors on the features of the fine motion.
    pub(crate) fine_scale: Scale,
    /// Gait of its steps.
    pub(crate) gait: Gait,
    /// The run of the same mixture; `None` in a run, and where the model only walks.
    pub(crate) running: Option<Arc<Self>>,
}

impl Blend {
    /// Returns the mixture of a walk, or its run.
    pub(crate) fn of_gait(self: &Arc<Self>, gait: Gait) -> &Arc<Self> {
        match (gait, &self.running) {
            (Gait::Run, Some(running)) => running,
            _ => self,
        }
    }
}

impl StyleSpace {
    /// Prepares a model and its styles, which takes some 10 ms each.
    ///
    /// # Errors
    /// [`SynthError`] when the model cannot be used, or a style does not fit it.
    pub fn new(model: &Arc<GaitModel>, styles: &[Arc<GaitStyle>]) -> Result<Self, SynthError> {
        model.check()?;
        let all: Vec<&GaitStyle> = styles.iter().map(AsRef::as_ref).collect();
        model.check_styles(&all)?;
        let style_pulls = all
            .iter()
            .map(|style| variance::pull(&Arc::new(model.mixture(&[(style, 1.0)]))))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            fingerprint: model.fingerprint()?,
            base_pull: variance::pull(model)?,
            style_pulls,
            running: match &model.running {
                Some(running) => Some(RunningParts::of(running)?),
                None => None,
            },
            fine: FineTables::of(model).map(Arc::new),
            standing: model
                .standing
                .as_ref()
                .map(StandingTables::of)
                .map(Arc::new),
            moves: Arc::new(MoveTables::of(model)),
            model: Arc::clone(model),
            styles: styles.to_vec(),
            blends: Mutex::default(),
            buffers: BufferPool::default(),
        })
    }

    /// Returns the base model.
    pub fn model(&self) -> &Arc<GaitModel> {
        &self.model
    }

    /// Returns the [`GaitModel::fingerprint`] of the base model.
    pub(crate) fn fingerprint(&self) -> u32 {
        self.fingerprint
    }

    /// Returns the styles, in the order of their weights.
    pub fn styles(&self) -> &[Arc<GaitStyle>] {
        &self.styles
    }

    /// Standing of the model's people; `None` where it stands still.
    pub(crate) fn standing(&self) -> Option<&Arc<StandingTables>> {
        self.standing.as_ref()
    }

    /// Crouches and jumps of the model's people.
    pub(crate) fn moves(&self) -> &Arc<MoveTables> {
        &self.moves
    }

    /// Returns the weights in use: one per style, 0 for missing and non-finite ones.
    pub(crate) fn weights(&self, weights: &[f32]) -> impl Iterator<Item = f32> {
        (0..self.styles.len()).map(|style| match weights.get(style) {
            Some(weight) if weight.is_finite() => *weight,
            _ => 0.0,
        })
    }

    /// Runs work with buffers that all walkers of the space share.
    pub(crate) fn with_buffers<R>(&self, work: impl FnOnce(&mut StepBuffers) -> R) -> R {
        self.buffers.with_one(&self.model, work)
    }

    /// Returns the mixture by these weights, shared by all walkers that use it at the same time.
    pub(crate) fn blend(&self, weights: &[f32]) -> Arc<Blend> {
        let weights: Vec<f32> = self.weights(weights).collect();
        let mut in_use = self.blends.lock().unwrap_or_else(PoisonError::into_inner);
        in_use.retain(|blend| blend.strong_count() > 0);
        let mut known = in_use.iter().filter_map(Weak::upgrade);
        if let Some(blend) = known.find(|blend| blend.weights == weights) {
            return blend;
        }
        let blend = Arc::new(self.mix(weights));
        in_use.push(Arc::downgrade(&blend));
        blend
    }

    fn mix(&self, weights: Vec<f32>) -> Blend {
        let parts: Vec<(&GaitStyle, f64)> = self
            .styles
            .iter()
            .zip(&weights)
            .map(|(style, weight)| (style.as_ref(), f64::from(*weight)))
            .collect();
        let model = Arc::new(self.model.mixture(&parts));
        let mut statistics = Statistics::new(&model);
        statistics.set_pull(&self.pull(&weights));
        let standing = standing_features(&model);
        let parts = self.running.as_ref().zip(model.running.as_ref());
        let running =
            parts.map(|(parts, running)| Arc::new(parts.mix(running, &standing, &weights)));
        Blend {
            gait: Gait::Walk,
            running,
            standing,
            walking: mean_posture(&model),
            fine: self.fine.clone(),
            fine_scale: model
                .fine
                .as_ref()
                .map_or([1.0; FEATURE_COUNT], FineTables::scale),
            model,
            statistics,
            weights,
        }
    }

    /// Returns the pull of a mixture: between those of the base and of its styles.
    fn pull(&self, weights: &[f32]) -> Vec<f64> {
        let in_use = || {
            let pairs = self.style_pulls.iter().zip(weights);
            pairs.filter(|(_, weight)| weight.abs() > 0.0)
        };
        let mix = |(dim, base): (usize, &f64)| {
            let ways = in_use().map(|(pull, weight)| f64::from(*weight) * (pull[dim] - base));
            let corners = || in_use().map(|(pull, _)| pull[dim]).chain([*base]);
            let low = corners().fold(f64::INFINITY, f64::min);
            let high = corners().fold(f64::NEG_INFINITY, f64::max);
            (base + ways.sum::<f64>()).clamp(low, high)
        };
        self.base_pull.iter().enumerate().map(mix).collect()
    }
}

impl RunningParts {
    fn of(model: &GaitModel) -> Result<Self, SynthError> {
        Ok(Self {
            pull: variance::pull(&Arc::new(model.clone()))?,
            fine: FineTables::of(model).map(Arc::new),
        })
    }

    /// Returns the run of a mixture of styles by these weights, for a person with this standing posture.
    fn mix(&self, model: &GaitModel, standing: &Posture, weights: &[f32]) -> Blend {
        let mut statistics = Statistics::new(model);
        statistics.set_pull(&self.pull);
        Blend {
            weights: weights.to_vec(),
            statistics,
            standing: *standing,
            walking: mean_posture(model),
            fine: self.fine.clone(),
            fine_scale: model
                .fine
                .as_ref()
                .map_or([1.0; FEATURE_COUNT], FineTables::scale),
            model: Arc::new(model.clone()),
            gait: Gait::Run,
            running: None,
        }
    }
}
