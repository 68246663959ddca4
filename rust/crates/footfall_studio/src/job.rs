//! Work on a thread of its own, in the window.

pub(crate) use footfall_train::job::{Job, Reporter, finished};

use eframe::egui::{Context, ProgressBar, Ui};

/// Starts work; the window is painted anew when there is something new.
pub(crate) fn start<T: Send + 'static>(
    context: &Context,
    name: &str,
    work: impl FnOnce(&mut Reporter) -> T + Send + 'static,
) -> Job<T> {
    let context = context.clone();
    Job::start(name, move || context.request_repaint(), work)
}

/// A button that stops work, and its progress.
pub(crate) fn show<T>(job: &Job<T>, ui: &mut Ui) {
    let progress = job.progress();
    ui.horizontal(|ui| {
        // First, for what comes behind the progress moves with its words.
        if ui.button("Cancel").clicked() {
            job.cancel();
        }
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
    });
}
