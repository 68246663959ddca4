//! Work on a thread of its own: how far it is, whether it is to stop, and what comes of it.

use eframe::egui::{Context, ProgressBar, Ui};
use footfall_train::Progress;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Arc, Mutex, PoisonError};

/// What the worker tells while it works.
#[derive(Clone, Debug, Default)]
pub(crate) struct JobProgress {
    /// What is being done.
    pub(crate) task: String,
    /// Parts of it that are finished, and all of them; 0 when nobody knows.
    pub(crate) done: usize,
    pub(crate) total: usize,
    /// Log-likelihoods so far.
    pub(crate) fits: Vec<f64>,
}

struct Shared {
    cancelled: AtomicBool,
    progress: Mutex<JobProgress>,
    context: Context,
}

/// The worker's end.
pub(crate) struct Reporter(Arc<Shared>);

impl Reporter {
    /// Tells what is being done; whether to go on with it.
    pub(crate) fn tell(&self, task: &str, done: usize, total: usize) -> ControlFlow<()> {
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
        self.0.context.request_repaint();
    }
}

impl Progress for Reporter {
    fn advance(&mut self, task: &str, done: usize, total: usize) -> ControlFlow<()> {
        self.tell(task, done, total)
    }

    fn fit(&mut self, log_likelihood: f64) {
        self.update(|progress| progress.fits.push(log_likelihood));
    }
}

/// Work that goes on. Dropping it asks it to stop, and forgets what it makes.
pub(crate) struct Job<T> {
    shared: Arc<Shared>,
    receiver: Receiver<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts work; `context` is woken when there is something new.
    pub(crate) fn start(
        context: &Context,
        name: &str,
        work: impl FnOnce(&mut Reporter) -> T + Send + 'static,
    ) -> Self {
        let shared = Arc::new(Shared {
            cancelled: AtomicBool::new(false),
            progress: Mutex::new(JobProgress {
                task: name.to_owned(),
                ..JobProgress::default()
            }),
            context: context.clone(),
        });
        let (sender, receiver) = mpsc::channel();
        let worker = Arc::clone(&shared);
        // Where no thread can be had the sender is dropped, which shows as work that broke off.
        drop(
            std::thread::Builder::new()
                .name(name.to_owned())
                .spawn(move || {
                    let context = worker.context.clone();
                    let made = work(&mut Reporter(worker));
                    // Nobody waits any more when the receiver is gone.
                    drop(sender.send(made));
                    context.request_repaint();
                }),
        );
        Self { shared, receiver }
    }

    /// What came of it: `None` while it goes on, an error when it broke off. Whoever cancels gets nothing, even where it was
    /// done by then.
    pub(crate) fn poll(&self) -> Option<Result<T, String>> {
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

    /// What it told last.
    pub(crate) fn progress(&self) -> JobProgress {
        self.shared
            .progress
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Asks it to stop soon.
    pub(crate) fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// A bar and a button to stop it.
    pub(crate) fn show(&self, ui: &mut Ui) {
        let progress = self.progress();
        ui.horizontal(|ui| {
            if progress.total == 0 {
                ui.spinner();
                ui.label(&progress.task);
            } else {
                let share = progress.done as f32 / progress.total as f32;
                ui.add(ProgressBar::new(share).desired_width(180.0).text(format!(
                    "{} {}/{}",
                    progress.task, progress.done, progress.total
                )));
            }
            if ui.button("Cancel").clicked() {
                self.cancel();
            }
        });
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }
}

/// A job that there may be: polls it and forgets it when it has ended.
pub(crate) fn finished<T: Send + 'static>(job: &mut Option<Job<T>>) -> Option<Result<T, String>> {
    let ended = job.as_ref()?.poll()?;
    *job = None;
    Some(ended)
}
