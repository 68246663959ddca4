//! How long work tells what it does, and how it is told to stop.

use core::ops::ControlFlow;

/// Receives how far a piece of work has come. Called from the working thread.
pub trait Progress {
    /// `done` of `total` parts of `task` are finished. [`ControlFlow::Break`] asks the work to stop: it then ends with
    /// [`TrainError::Cancelled`](crate::TrainError::Cancelled).
    fn advance(&mut self, task: &str, done: usize, total: usize) -> ControlFlow<()>;

    /// How well what there is now explains the data, as a log-likelihood; told after every iteration of a fit.
    fn fit(&mut self, _log_likelihood: f64) {}
}

/// For callers that do not want to know.
impl Progress for () {
    fn advance(&mut self, _task: &str, _done: usize, _total: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Tells progress, and whether to go on as an error that `?` passes on.
pub(crate) fn advance(
    progress: &mut dyn Progress,
    task: &str,
    done: usize,
    total: usize,
) -> Result<(), crate::TrainError> {
    match progress.advance(task, done, total) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(crate::TrainError::Cancelled),
    }
}
