//! Alignment and transform estimation in turn.

mod alignment;
mod estimate;

use super::AdaptMethod;
use crate::error::TrainError;
use crate::progress::{Progress, advance};
use crate::sequence::{Sequence, step_lengths};
use crate::step_hsmm::{DURATION_VARIANCE_FLOOR, STATES};
use footfall_model::{FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::ProbError;
use footfall_prob::duration::GaussianDuration;
use footfall_prob::gaussian::DiagonalGaussian;
use footfall_prob::regression::{LinearTransform, RegressionTree};
use std::ops::Range;

/// Depth of the tree of states: four classes of at least two states.
const TREE_DEPTH: usize = 2;
const LEAST_STATES: usize = 2;

/// Alignments at the root and at each deeper level.
const ROOT_ITERATIONS: usize = 3;
const LEVEL_ITERATIONS: usize = 2;

/// Strength of the prior in frames, on the bias and on the matrix: how a style holds itself shows at once, how it moves
/// one joint with another needs more evidence.
const CSMAPLR_FRAMES: [f64; 2] = [1.0, 60.0];

/// Enough to keep joints that a recording holds still from infinite likelihood; no more.
const CMLLR_FRAMES: [f64; 2] = [0.1, 2.0];

/// The transforms of one class of states.
#[derive(Clone, Debug)]
struct Class {
    members: Vec<usize>,
    /// One for each block of features.
    blocks: Vec<LinearTransform>,
    duration: LinearTransform,
    /// Centre of the prior: the transforms of the class that this one is a part of.
    centres: Vec<LinearTransform>,
    duration_centre: LinearTransform,
}

/// A base model on its way to a style.
///
/// All features are measured in deviations of the base model from its mean, so that a transform has no units and its bias
/// does not depend on its matrix.
pub(super) struct Adapting {
    centre: Vec<f64>,
    deviation: Vec<f64>,
    /// ln of the product of all deviations: what a density per unit loses.
    log_unit: f64,
    /// Features that a transform may mix.
    ranges: Vec<Range<usize>>,
    gaussians: Vec<DiagonalGaussian>,
    /// Per state and block.
    parts: Vec<Vec<DiagonalGaussian>>,
    durations: Vec<DiagonalGaussian>,
    duration_centre: f64,
    duration_deviation: f64,
    max_duration: usize,
    tree: RegressionTree,
    prior_frames: [f64; 2],
    classes: Vec<Class>,
}

impl Adapting {
    pub(super) fn new(
        base: &GaitModel,
        corpus: &[Sequence],
        method: AdaptMethod,
    ) -> Result<Self, TrainError> {
        let states: Vec<_> = base.steps.iter().flat_map(|step| &step.states).collect();
        let total: f64 = states.iter().map(|state| state.duration_mean).sum();
        let pooled = |of: &dyn Fn(usize) -> f64| -> f64 {
            (0..STATES)
                .map(|s| states[s].duration_mean / total * of(s))
                .sum()
        };
        let centre: Vec<f64> = (0..OBSERVATION_COUNT)
            .map(|dim| pooled(&|s| states[s].mean[dim]))
            .collect();
        let deviation: Vec<f64> = (0..OBSERVATION_COUNT)
            .map(|dim| {
                pooled(&|s| states[s].variance[dim] + (states[s].mean[dim] - centre[dim]).powi(2))
                    .sqrt()
            })
            .collect();
        let gaussians: Vec<DiagonalGaussian> = states
            .iter()
            .map(|state| {
                let units = || (0..OBSERVATION_COUNT).map(|dim| (dim, deviation[dim]));
                DiagonalGaussian::new(
                    units()
                        .map(|(d, unit)| (state.mean[d] - centre[d]) / unit)
                        .collect(),
                    units()
                        .map(|(d, unit)| state.variance[d] / (unit * unit))
                        .collect(),
                )
            })
            .collect::<Result<_, _>>()?;
        let block = match method {
            AdaptMethod::Cmllr => 3,
            AdaptMethod::Csmaplr => FEATURE_COUNT,
        };
        let ranges: Vec<Range<usize>> = (0..OBSERVATION_COUNT / block)
            .map(|index| index * block..(index + 1) * block)
            .collect();
        let part = |gaussian: &DiagonalGaussian, range: &Range<usize>| {
            DiagonalGaussian::new(
                gaussian.mean()[range.clone()].to_vec(),
                gaussian.variance()[range.clone()].to_vec(),
            )
        };
        let parts = gaussians
            .iter()
            .map(|gaussian| ranges.iter().map(|range| part(gaussian, range)).collect())
            .collect::<Result<_, ProbError>>()?;
        let duration_centre = states.iter().map(|s| s.duration_mean).sum::<f64>() / STATES as f64;
        let duration_deviation =
            (states.iter().map(|s| s.duration_variance).sum::<f64>() / STATES as f64).sqrt();
        let durations = states
            .iter()
            .map(|state| {
                DiagonalGaussian::new(
                    vec![(state.duration_mean - duration_centre) / duration_deviation],
                    vec![state.duration_variance / duration_deviation.powi(2)],
                )
            })
            .collect::<Result<_, _>>()?;
        let points: Vec<&[f64]> = gaussians
            .iter()
            .map(|g| &g.mean()[..FEATURE_COUNT])
            .collect();
        let depth = match method {
            AdaptMethod::Cmllr => 0,
            AdaptMethod::Csmaplr => TREE_DEPTH,
        };
        let tree = RegressionTree::by_distance(&points, depth, LEAST_STATES)?;
        let longest = step_lengths(corpus).max().ok_or(TrainError::NoSteps)?;
        let shortest = step_lengths(corpus).min().unwrap_or(longest);
        if shortest < STATES_PER_STEP {
            return Err(TrainError::StepTooShort { frames: shortest });
        }
        Ok(Self {
            log_unit: deviation.iter().map(|unit| unit.ln()).sum(),
            centre,
            deviation,
            ranges,
            gaussians,
            parts,
            durations,
            duration_centre,
            duration_deviation,
            max_duration: longest.max(total.ceil() as usize),
            tree,
            prior_frames: match method {
                AdaptMethod::Cmllr => CMLLR_FRAMES,
                AdaptMethod::Csmaplr => CSMAPLR_FRAMES,
            },
            classes: Vec::new(),
        })
    }

    pub(super) fn max_duration(&self) -> usize {
        self.max_duration
    }

    /// The states of every class, in the order of both steps' states.
    pub(super) fn classes(&self) -> Vec<Vec<usize>> {
        self.classes
            .iter()
            .map(|class| class.members.clone())
            .collect()
    }

    /// Estimates all transforms, level by level of the tree. Returns the log-likelihood in the end, and at every alignment
    /// the log-likelihood less the prior's charge.
    ///
    /// A class begins a level with its parent's transforms, which are the centre of its prior: nothing is charged then, so
    /// from one level to the next the objective does not fall either.
    pub(super) fn run(
        &mut self,
        corpus: &[Sequence],
        progress: &mut dyn Progress,
    ) -> Result<(f64, Vec<f64>), TrainError> {
        let frames: Vec<Vec<f64>> = corpus.iter().map(|s| self.in_units(s)).collect();
        let rounds = ROOT_ITERATIONS + LEVEL_ITERATIONS * self.tree.depth();
        let mut objectives = Vec::new();
        let mut done = 0;
        for depth in 0..=self.tree.depth() {
            self.descend(depth);
            let iterations = if depth == 0 {
                ROOT_ITERATIONS
            } else {
                LEVEL_ITERATIONS
            };
            for _ in 0..iterations {
                advance(progress, "adapting", done, rounds)?;
                let alignment = if done == 0 {
                    // The base knows neither the style's posture nor its tempo: the first alignment is by the steps.
                    self.even_alignment(corpus, &frames)
                } else {
                    let alignment = self.align(corpus, &frames)?;
                    let objective = alignment.log_likelihood + self.log_prior();
                    progress.fit(objective);
                    objectives.push(objective);
                    alignment
                };
                self.maximise(&alignment)?;
                done += 1;
            }
        }
        let last = self.align(corpus, &frames)?;
        objectives.push(last.log_likelihood + self.log_prior());
        advance(progress, "adapting", rounds, rounds)?;
        Ok((last.log_likelihood, objectives))
    }

    /// The base's Gaussians, moved.
    pub(super) fn adapted_gaussians(&self) -> Result<Vec<DiagonalGaussian>, TrainError> {
        let mut adapted: Vec<[Vec<f64>; 2]> =
            vec![[vec![0.0; OBSERVATION_COUNT], vec![0.0; OBSERVATION_COUNT]]; STATES];
        for class in &self.classes {
            for (block, range) in self.ranges.iter().enumerate() {
                let parts: Vec<DiagonalGaussian> = class
                    .members
                    .iter()
                    .map(|state| self.parts[*state][block].clone())
                    .collect();
                let moved = class.blocks[block].adapt(&parts)?;
                for (state, gaussian) in class.members.iter().zip(&moved) {
                    for (offset, dim) in range.clone().enumerate() {
                        let unit = self.deviation[dim];
                        adapted[*state][0][dim] = self.centre[dim] + unit * gaussian.mean()[offset];
                        adapted[*state][1][dim] = unit * unit * gaussian.variance()[offset];
                    }
                }
            }
        }
        Ok(adapted
            .into_iter()
            .map(|[mean, variance]| DiagonalGaussian::new(mean, variance))
            .collect::<Result<_, _>>()?)
    }

    /// The base's durations, moved.
    pub(super) fn adapted_durations(&self) -> Result<Vec<GaussianDuration>, TrainError> {
        let mut adapted = vec![
            GaussianDuration {
                mean: 0.0,
                variance: 0.0
            };
            STATES
        ];
        for class in &self.classes {
            for state in &class.members {
                adapted[*state] = self.adapted_duration(*state, &class.duration)?;
            }
        }
        Ok(adapted)
    }

    fn adapted_duration(
        &self,
        state: usize,
        transform: &LinearTransform,
    ) -> Result<GaussianDuration, ProbError> {
        let moved = transform.adapt(&self.durations[state..=state])?;
        let unit = self.duration_deviation;
        Ok(GaussianDuration {
            mean: self.duration_centre + unit * moved[0].mean()[0],
            variance: (unit * unit * moved[0].variance()[0]).max(DURATION_VARIANCE_FLOOR),
        })
    }

    /// Replaces the classes by those at a depth of the tree.
    fn descend(&mut self, depth: usize) {
        let next = self.tree.cut(depth).into_iter().map(|node| {
            let node = &self.tree.nodes[node];
            let parent = self
                .classes
                .iter()
                .find(|class| class.members.contains(&node.members[0]));
            let (blocks, duration) = parent.map_or_else(
                || {
                    let sizes = self.ranges.iter().map(ExactSizeIterator::len);
                    (
                        sizes.map(LinearTransform::identity).collect(),
                        LinearTransform::identity(1),
                    )
                },
                |parent| (parent.blocks.clone(), parent.duration.clone()),
            );
            Class {
                members: node.members.clone(),
                centres: blocks.clone(),
                duration_centre: duration.clone(),
                blocks,
                duration,
            }
        });
        self.classes = next.collect();
    }
}
