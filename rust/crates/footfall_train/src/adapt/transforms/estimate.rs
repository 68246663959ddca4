//! Estimation of the transforms from an alignment, each held near its parent's.

use super::alignment::Alignment;
use super::{Adapting, Class};
use crate::error::TrainError;
use footfall_prob::ProbError;
use footfall_prob::regression::{
    LinearTransform, RegressionMember, TransformPrior, estimate_transform,
};
use rayon::prelude::*;

/// Sweeps over the rows of a transform between two alignments.
const SWEEPS: usize = 8;

/// Strength of the prior of durations in segments, on the bias and on the matrix.
const DURATION_SEGMENTS: [f64; 2] = [0.5, 20.0];

impl Adapting {
    /// The most probable transforms by an alignment.
    pub(super) fn maximise(&mut self, alignment: &Alignment) -> Result<(), TrainError> {
        let jobs: Vec<(usize, usize)> = (0..self.classes.len())
            .flat_map(|class| (0..self.ranges.len()).map(move |block| (class, block)))
            .collect();
        let found: Vec<LinearTransform> = jobs
            .par_iter()
            .map(|(class, block)| self.best_block(alignment, &self.classes[*class], *block))
            .collect::<Result<_, _>>()?;
        for ((class, block), transform) in jobs.into_iter().zip(found) {
            self.classes[class].blocks[block] = transform;
        }
        for index in 0..self.classes.len() {
            self.classes[index].duration = self.best_duration(alignment, &self.classes[index])?;
        }
        Ok(())
    }

    fn best_block(
        &self,
        alignment: &Alignment,
        class: &Class,
        block: usize,
    ) -> Result<LinearTransform, ProbError> {
        let members: Vec<RegressionMember<'_>> = class
            .members
            .iter()
            .map(|state| RegressionMember {
                gaussian: &self.parts[*state][block],
                stats: &alignment.frames[*state][block],
            })
            .collect();
        let row_precision = self.row_precision(class, block);
        let prior = prior(&class.centres[block], &row_precision, self.prior_frames);
        Ok(estimate_transform(&members, Some(&prior), &class.blocks[block], SWEEPS)?.transform)
    }

    /// The regression takes durations for plain Gaussians, but they are cut to whole frames from one on: a change that is none
    /// for the better after the cut is taken in part, or not at all.
    fn best_duration(
        &self,
        alignment: &Alignment,
        class: &Class,
    ) -> Result<LinearTransform, ProbError> {
        let members: Vec<RegressionMember<'_>> = class
            .members
            .iter()
            .map(|state| RegressionMember {
                gaussian: &self.durations[*state],
                stats: &alignment.durations[*state],
            })
            .collect();
        let row_precision = self.duration_precision(class);
        let prior = prior(&class.duration_centre, &row_precision, DURATION_SEGMENTS);
        let wanted = estimate_transform(&members, Some(&prior), &class.duration, SWEEPS)?.transform;
        let objective = |transform: &LinearTransform| -> Result<f64, ProbError> {
            let mut sum = prior.log_density(transform);
            for state in &class.members {
                let dist = self
                    .adapted_duration(*state, transform)?
                    .discretise(self.max_duration)?;
                let terms = (1..).zip(&alignment.histograms[*state]);
                sum += terms
                    .filter(|(_, weight)| **weight > 0.0)
                    .map(|(duration, weight)| weight * dist.log_pmf(duration))
                    .sum::<f64>();
            }
            Ok(sum)
        };
        let before = objective(&class.duration)?;
        for share in [1.0, 0.5, 0.25, 0.1, 0.03] {
            let pairs = class.duration.rows().iter().zip(wanted.rows());
            let rows = pairs.map(|(from, to)| from + share * (to - from)).collect();
            let candidate = LinearTransform::from_rows(1, rows)?;
            if objective(&candidate).is_ok_and(|value| value >= before) {
                return Ok(candidate);
            }
        }
        Ok(class.duration.clone())
    }

    fn row_precision(&self, class: &Class, block: usize) -> Vec<f64> {
        let mean = |dim: usize| {
            let of = |state: &usize| self.parts[*state][block].precision()[dim];
            class.members.iter().map(of).sum::<f64>() / class.members.len() as f64
        };
        (0..self.ranges[block].len()).map(mean).collect()
    }

    fn duration_precision(&self, class: &Class) -> [f64; 1] {
        let of = |state: &usize| self.durations[*state].precision()[0];
        [class.members.iter().map(of).sum::<f64>() / class.members.len() as f64]
    }

    /// Returns the log density that the priors give the transforms.
    pub(super) fn log_prior(&self) -> f64 {
        let of = |class: &Class| {
            let blocks = class.blocks.iter().zip(&class.centres).enumerate();
            let features: f64 = blocks
                .map(|(block, (transform, centre))| {
                    let row_precision = self.row_precision(class, block);
                    prior(centre, &row_precision, self.prior_frames).log_density(transform)
                })
                .sum();
            let row_precision = self.duration_precision(class);
            let durations = prior(&class.duration_centre, &row_precision, DURATION_SEGMENTS);
            features + durations.log_density(&class.duration)
        };
        self.classes.iter().map(of).sum()
    }
}

fn prior<'a>(
    centre: &'a LinearTransform,
    row_precision: &'a [f64],
    [bias_weight, matrix_weight]: [f64; 2],
) -> TransformPrior<'a> {
    TransformPrior {
        centre,
        row_precision,
        bias_weight,
        matrix_weight,
    }
}
