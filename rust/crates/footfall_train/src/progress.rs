//! How long work tells what it does.

/// Receives how far a piece of work has come. Called from the working thread.
pub trait Progress {
    /// `done` of `total` parts of `task` are finished.
    fn advance(&mut self, task: &str, done: usize, total: usize);
}

/// For callers that do not want to know.
impl Progress for () {
    fn advance(&mut self, _task: &str, _done: usize, _total: usize) {}
}
