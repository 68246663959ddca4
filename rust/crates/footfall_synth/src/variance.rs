//! Keeps the global variance of the corpus.

use crate::error::SynthError;
use crate::plan::{Planner, StepPlan};
use crate::trajectory::TrajectorySolver;
use footfall_model::{FEATURE_COUNT, GaitModel};

/// A solver.
pub(crate) fn solver_with_pull(model: &GaitModel) -> Result<TrajectorySolver, SynthError> {
    Ok(TrajectorySolver::new(
        model,
        4,
        4 * Planner::longest_step(model),
    ))
}

pub(crate) fn solve_sentence(
    model: &GaitModel,
    plans: &[StepPlan],
) -> Result<Vec<f64>, SynthError> {
    let mut solver = solver_with_pull(model)?;
    let frames = solver.load(plans.iter(), 0);
    let mut trajectory = vec![0.0; frames * FEATURE_COUNT];
    solver.solve(&mut trajectory, 0)?;
    Ok(trajectory)
}
