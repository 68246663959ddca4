//! Disposal of crowds on other threads: freeing thousands of walkers takes longer than a frame.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};

/// Number of values up to which the caller's thread frees them: starting a thread would take longer.
const FEW: usize = 16;

/// Threads that free something, or finish what nobody waits for any more.
static ENDING: Mutex<Vec<JoinHandle<()>>> = Mutex::new(Vec::new());

fn ending() -> MutexGuard<'static, Vec<JoinHandle<()>>> {
    ENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Frees these values; many of them on another thread.
pub(super) fn dispose<T: Send + 'static>(values: Vec<T>) {
    if values.len() <= FEW {
        return;
    }
    let thread = Builder::new()
        .name("footfall disposal".to_owned())
        .spawn(move || drop(values));
    // If no thread can be started, the values are freed with the error.
    leave_to_end(thread.ok());
}

/// Keeps threads that will end by themselves for [`finish_disposals`].
pub(super) fn leave_to_end(threads: impl IntoIterator<Item = JoinHandle<()>>) {
    let mut ending = ending();
    ending.retain(|thread| !thread.is_finished());
    ending.extend(threads);
}

/// Waits until everything of dropped crowds is freed. Call it before this library is unloaded: threads must not run in it then.
pub fn finish_disposals() {
    for thread in ending().drain(..) {
        // A thread that panicked has reported so.
        let _ended = thread.join();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::thread::{self, ThreadId};

    /// Notes on which thread it is freed.
    struct Noted(Arc<Mutex<Vec<ThreadId>>>);

    impl Drop for Noted {
        fn drop(&mut self) {
            self.0.lock().unwrap().push(thread::current().id());
        }
    }

    fn freed_on(count: usize) -> Vec<ThreadId> {
        let freed = Arc::default();
        dispose((0..count).map(|_| Noted(Arc::clone(&freed))).collect());
        finish_disposals();
        let freed = freed.lock().unwrap();
        freed.clone()
    }

    #[test]
    fn many_values_are_freed_on_another_thread_and_few_on_the_callers() {
        let here = thread::current().id();
        let many = freed_on(FEW + 1);
        assert_eq!(many.len(), FEW + 1);
        assert!(many.iter().all(|thread| *thread != here));
        assert_eq!(freed_on(FEW), [here; FEW]);
    }
}
