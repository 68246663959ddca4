//! Background jobs: progress, cancellation, and result.

use crate::progress::Progress;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Arc, Mutex, PoisonError};

/// Progress report of a worker.
#[derive(Clone, Debug, Default)]
pub struct JobProgress {
    /// Current stage.
    pub task: String,
    /// Number of finished parts.
    pub done: usize,
    /// Number of all parts; 0 if unknown.
    pub total: usize,
    /// Log-likelihoods so far.
    pub fits: Vec<f64>,
}

struct Shared {
    cancelled: AtomicBool,
    progress: Mutex<JobProgress>,
    wake: Box<dyn Fn() + Send + Sync>,
}

/// The worker's end.
pub struct Reporter(Arc<Shared>);

impl core::fmt::Debug for Reporter {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Reporter").finish_non_exhaustive()
    }
}

impl Reporter {
    /// Reports the current stage; returns whether to continue.
    pub fn report(&self, task: &str, done: usize, total: usize) -> ControlFlow<()> {
        self.update(|progress| {
            task.clone_into(&mut progress.task);
            progress.done = done;
            progress.total = total;
        });
        if self.0.cancelled.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    fn update(&self, change: impl FnOnce(&mut JobProgress)) {
        change(
            &mut self
                .0
                .progress
                .lock()
                .unwrap_or_else(PoisonError::into_inner),
        );
        (self.0.wake)();
    }
}

impl Progress for Reporter {
    fn advance(&mut self, task: &str, done: usize, total: usize) -> ControlFlow<()> {
        self.report(task, done, total)
    }

    fn fit(&mut self, log_likelihood: f64) {
        self.update(|progress| progress.fits.push(log_likelihood));
    }
}

/// Running work. Dropping it cancels the work and discards the result.
pub struct Job<T> {
    shared: Arc<Shared>,
    receiver: Receiver<T>,
}

impl<T> core::fmt::Debug for Job<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Job")
            .field("progress", &self.progress())
            .finish_non_exhaustive()
    }
}

impl<T> Job<T> {
    /// Returns the last report.
    pub fn progress(&self) -> JobProgress {
        self.shared
            .progress
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Requests cancellation.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }
}

impl<T: Send + 'static> Job<T> {
    /// Starts work on a thread; calls `wake` there whenever there is news.
    pub fn start(
        name: &str,
        wake: impl Fn() + Send + Sync + 'static,
        work: impl FnOnce(&mut Reporter) -> T + Send + 'static,
    ) -> Self {
        let shared = Arc::new(Shared {
            cancelled: AtomicBool::new(false),
            progress: Mutex::new(JobProgress {
                task: name.to_owned(),
                ..JobProgress::default()
            }),
            wake: Box::new(wake),
        });
        let (sender, receiver) = mpsc::channel();
        let worker = Arc::clone(&shared);
        // Where no thread can be had the sender is dropped, which shows as work that broke off.
        drop(
            std::thread::Builder::new()
                .name(name.to_owned())
                .spawn(move || {
                    let made = work(&mut Reporter(Arc::clone(&worker)));
                    // Without a receiver the result is dropped.
                    drop(sender.send(made));
                    (worker.wake)();
                }),
        );
        Self { shared, receiver }
    }

    /// Outcome: `None` while the job runs, an error if it failed. A cancelled job has no result, even if it was
    /// finished by then.
    pub fn poll(&self) -> Option<Result<T, String>> {
        match self.receiver.try_recv() {
            Ok(_) if self.shared.cancelled.load(Ordering::Relaxed) => {
                Some(Err("stopped before the end; nothing was written".to_owned()))
            }
            Ok(made) => Some(Ok(made)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(format!(
                "{}: the work broke off; please report this, with what was being done",
                self.progress().task
            ))),
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }
}

/// An optional job: polls it and drops it at its end.
pub fn finished<T: Send + 'static>(job: &mut Option<Job<T>>) -> Option<Result<T, String>> {
    let ended = job.as_ref()?.poll()?;
    *job = None;
    Some(ended)
}
