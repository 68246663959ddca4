//! Progress reporting and cancellation.

use core::ops::ControlFlow;

/// Receives the progress of work. Called from the working thread.
pub trait Progress {
    /// `done` of `total` parts of `task` are finished. [`ControlFlow::Break`] asks the work to stop: it then ends with
    /// [`TrainError::Cancelled`](crate::TrainError::Cancelled).
    fn advance(&mut self, task: &str, done: usize, total: usize) -> ControlFlow<()>;

    /// Log-likelihood of the data under the present model; reported after every iteration of a fit.
    fn fit(&mut self, _log_likelihood: f64) {}
}

/// Ignores progress.
impl Progress for () {
    fn advance(&mut self, _task: &str, _done: usize, _total: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Reports progress; a cancellation is an error that `?` passes on.
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
