//! The parameters that walks are cut into states by, tied between contexts.

use super::moments::Moments;
use super::trees::{Trees, pool};
use super::{CONTEXTS, context};
use crate::average::AverageWalk;
use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use crate::step_hsmm::{DURATION_VARIANCE_FLOOR, STATES, cut_steps, state_index};
use footfall_core::{Side, StepPosition};
use footfall_model::STATES_PER_STEP;
use footfall_prob::duration::{DurationDist, DurationStats, GaussianDuration};
use footfall_prob::gaussian::DiagonalGaussian;
use footfall_prob::hsmm::ChainState;

/// The parameters that a chain of steps is cut by, and which of them each context uses.
pub(super) struct Tied {
    pub(super) gaussians: Vec<DiagonalGaussian>,
    pub(super) durations: Vec<GaussianDuration>,
    /// Per context and state, the place of its Gaussian and of its duration.
    pub(super) states: Vec<[ChainState; STATES_PER_STEP]>,
}

impl Tied {
    /// All contexts as inside: where cutting begins.
    pub(super) fn untied(walk: &AverageWalk) -> Self {
        let states = StepPosition::ALL.iter().flat_map(|_| {
            Side::BOTH.map(|side| {
                core::array::from_fn(|state| {
                    let index = state_index(side, state);
                    ChainState {
                        emission: index,
                        duration: index,
                    }
                })
            })
        });
        debug_assert_eq!(walk.gaussians().len(), STATES);
        Self {
            gaussians: walk.gaussians().to_vec(),
            durations: walk.durations().to_vec(),
            states: states.collect(),
        }
    }

    pub(super) fn estimate(
        trees: &Trees,
        moments: &Moments,
        floor: &[f64],
        walk: &AverageWalk,
    ) -> Result<Self, TrainError> {
        let mut gaussians = Vec::new();
        let mut durations = Vec::new();
        let nothing = ChainState {
            emission: 0,
            duration: 0,
        };
        let mut states = vec![[nothing; STATES_PER_STEP]; CONTEXTS];
        for state in 0..STATES_PER_STEP {
            let tree = &trees.outputs[state];
            for (context, leaf) in tree.leaf_of().iter().enumerate() {
                states[context][state].emission = gaussians.len() + leaf;
            }
            for leaf in 0..tree.leaves() {
                let pooled = pool(tree, leaf, &moments.outputs[state]);
                gaussians.push(pooled.estimate(floor)?);
            }
            for (context, leaf) in trees.durations.leaf_of().iter().enumerate() {
                states[context][state].duration = durations.len() + leaf;
            }
            for leaf in 0..trees.durations.leaves() {
                let pooled = pool(&trees.durations, leaf, &moments.durations);
                let mut seen = DurationStats::new();
                // Two durations have any mean and variance.
                let spread = pooled.variance()[state].sqrt();
                for sign in [-1.0, 1.0] {
                    let frames = pooled.mean()[state] + sign * spread;
                    seen.add(frames.round().max(1.0) as usize, 0.5 * pooled.weight());
                }
                durations.push(seen.estimate(walk.max_duration(), DURATION_VARIANCE_FLOOR)?);
            }
        }
        Ok(Self {
            gaussians,
            durations,
            states,
        })
    }

    /// The boundaries of a walk's states.
    pub(super) fn cut(
        &self,
        sequence: &Sequence,
        durations: &[DurationDist],
    ) -> Result<Vec<usize>, TrainError> {
        let chain = |step: &LabelledStep| self.states[context(step.position, step.side)].to_vec();
        cut_steps(sequence, &self.gaussians, durations, chain)
    }
}
