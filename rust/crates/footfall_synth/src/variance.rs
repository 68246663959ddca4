//! Keeps the global variance of the corpus.

use crate::error::SynthError;
use crate::plan::Planner;
use crate::trajectory::TrajectorySolver;
use footfall_model::GaitModel;

/// A solver.
pub(crate) fn solver_with_pull(model: &GaitModel) -> Result<TrajectorySolver, SynthError> {
    Ok(TrajectorySolver::new(
        model,
        4,
        4 * Planner::longest_step(model),
    ))
}
