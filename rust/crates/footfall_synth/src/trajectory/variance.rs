//! Preservation of the corpus' global variance: generated joints swing as far as captured ones (equations 12 to 15 of the
//! paper, solved to their optimum).
//!
//! A whole walk is solved with the global variance in its objective. The streaming generator never sees the
//! whole walk, but the optimum is an ordinary trajectory under a constant pull per feature. The pull is found once on a
//! sample walk and then used on every window.

use super::TrajectorySolver;
use crate::error::SynthError;
use crate::gait::{Manner, Pace};
use crate::plan::{Planner, Statistics, StepPlan};
use footfall_core::Side;
use footfall_model::{FEATURE_COUNT, GaitModel};
use footfall_prob::global_variance::{
    GlobalVarianceTarget, global_variance, hts_weight, temporal_moments,
};
use std::sync::Arc;

/// Steps of the sample walk, enough for its ends to be negligible.
const SAMPLE_STEPS: usize = 12;

/// Bounds of the ratio between the variance of a walk and that of the corpus: styles and speeds differ.
const VARIANCE_RATIO: [f64; 2] = [0.25, 4.0];

/// The pull per feature under which a walk of the model keeps the corpus' variance.
pub(crate) fn pull(model: &Arc<GaitModel>) -> Result<Vec<f64>, SynthError> {
    let statistics = Statistics::new(model);
    let mut solver = TrajectorySolver::new(SAMPLE_STEPS, 0);
    let frames = solver.load(&statistics, &sample_walk(model, &statistics), 0);
    let mut trajectory = vec![0.0; frames * FEATURE_COUNT];
    let target = GlobalVarianceTarget {
        mean: &model.global_variance.mean,
        variance: &model.global_variance.variance,
        trajectory_weight: hts_weight(frames),
    };
    let problem = solver.problem(&statistics, 0);
    Ok(global_variance(&problem, &target, &mut trajectory)?.strength)
}

/// The trajectory of a whole walk, T × [`FEATURE_COUNT`].
///
/// The corpus' variance belongs to its mean walk. A walk planned with a larger or smaller swing, because of its speed or
/// walker, gets proportionally more or less variance.
pub(crate) fn solve_walk(
    model: &Arc<GaitModel>,
    statistics: &Statistics<f64>,
    plans: &[StepPlan<f64>],
) -> Result<Vec<f64>, SynthError> {
    let mut solver = TrajectorySolver::new(plans.len(), 0);
    let sample = sample_walk(model, statistics);
    let sample_variance = plain_variance(statistics, &mut solver, &sample)?;
    let variance = plain_variance(statistics, &mut solver, plans)?;
    let mean: Vec<f64> = (0..FEATURE_COUNT)
        .map(|dim| {
            let ratio = variance[dim] / sample_variance[dim].max(f64::MIN_POSITIVE);
            model.global_variance.mean[dim] * ratio.clamp(VARIANCE_RATIO[0], VARIANCE_RATIO[1])
        })
        .collect();
    let frames = solver.load(statistics, plans, 0);
    let mut trajectory = vec![0.0; frames * FEATURE_COUNT];
    let target = GlobalVarianceTarget {
        mean: &mean,
        variance: &model.global_variance.variance,
        trajectory_weight: hts_weight(frames),
    };
    global_variance(&solver.problem(statistics, 0), &target, &mut trajectory)?;
    Ok(trajectory)
}

/// Variance over time of every feature without any correction.
fn plain_variance(
    statistics: &Statistics<f64>,
    solver: &mut TrajectorySolver<f64>,
    plans: &[StepPlan<f64>],
) -> Result<Vec<f64>, SynthError> {
    let frames = solver.load(statistics, plans, 0);
    let mut trajectory = vec![0.0; frames * FEATURE_COUNT];
    solver.solve(statistics, &mut trajectory, 0, FEATURE_COUNT)?;
    Ok(temporal_moments(&trajectory, FEATURE_COUNT).1)
}

/// The average walk without chance.
fn sample_walk(model: &Arc<GaitModel>, statistics: &Statistics<f64>) -> Vec<StepPlan<f64>> {
    let planner = Planner::new(model, 0, 0.0);
    let pace = Pace {
        covariate_mps: model.speed.reference_mps,
        tempo: 1.0,
        stride: 1.0,
    };
    let mut side = Side::Left;
    (0..SAMPLE_STEPS)
        .map(|_| {
            let mut plan = StepPlan::empty();
            let draw = Planner::mean_draw(side);
            planner.plan_step(&draw, Manner::inside(pace), statistics, &mut plan);
            side = side.other();
            plan
        })
        .collect()
}
