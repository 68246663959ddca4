//! Creation of walkers on separate threads, so that no frame waits for it. The order of creation does not change the walkers.

use super::disposal;
use super::mixtures::{CrowdRecipe, Mixtures, StyleMixture};
use footfall_synth::{CrowdWalker, GeneratorConfig, StyledBody, SynthError, Workshop};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};

/// Number of orders from which a second thread is started.
const FEW: usize = 16;
/// Most threads of one crowd.
const MOST_THREADS: usize = 4;
/// Number of walkers that a frame makes itself if no thread can be started.
const MADE_A_FRAME: usize = 8;

/// A walker to be made, or to get another mixture of styles.
#[derive(Debug)]
pub(super) struct Order {
    pub(super) place: usize,
    /// Ticket of the walker: another walker may have its place when the order is done.
    pub(super) ticket: u64,
    pub(super) mixture: StyleMixture,
    /// Settings of its walk; `None` for an existing walker that only changes its mixture.
    pub(super) config: Option<GeneratorConfig>,
    /// True for a walker with its own steps from the first one on, which takes some milliseconds.
    pub(super) alone: bool,
}

/// An order that was carried out.
#[derive(Debug)]
pub(super) struct Made {
    pub(super) order: Order,
    pub(super) styled: StyledBody,
    pub(super) walker: Option<CrowdWalker>,
}

#[derive(Debug, Default)]
struct Queue {
    orders: VecDeque<Order>,
    /// Threads that will return here.
    working: usize,
}

/// The mixtures, or the reason why the model gives no walk.
pub(super) type Prepared = Result<Arc<Mixtures>, Arc<SynthError>>;

#[derive(Debug)]
struct Shared {
    recipe: CrowdRecipe,
    mixtures: OnceLock<Prepared>,
    queue: Mutex<Queue>,
    made: Mutex<VecDeque<Made>>,
}

/// The threads of one crowd. They end when there is nothing to do, and soon after this is dropped.
#[derive(Debug)]
pub(super) struct Maker {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
    /// Number of orders that are not finished.
    waiting: usize,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Maker {
    /// Begins to prepare the style mixtures.
    pub(super) fn new(recipe: CrowdRecipe) -> Self {
        let shared = Shared {
            recipe,
            mixtures: OnceLock::new(),
            queue: Mutex::default(),
            made: Mutex::default(),
        };
        let mut maker = Self {
            shared: Arc::new(shared),
            threads: Vec::new(),
            waiting: 0,
        };
        maker.hire(1);
        maker
    }

    /// Recipe of the walkers.
    pub(super) fn recipe(&self) -> &CrowdRecipe {
        &self.shared.recipe
    }

    /// Number of styles.
    pub(super) fn styles(&self) -> usize {
        self.shared.recipe.styles.len()
    }

    /// The style mixtures once they are prepared, or the reason why they cannot be.
    pub(super) fn mixtures(&self) -> Option<&Prepared> {
        self.shared.mixtures.get()
    }

    /// Returns whether orders are not finished.
    pub(super) fn is_busy(&self) -> bool {
        self.waiting > 0
    }

    /// Takes orders.
    pub(super) fn take(&mut self, orders: impl Iterator<Item = Order>) {
        let mut queue = locked(&self.shared.queue);
        let before = queue.orders.len();
        queue.orders.extend(orders);
        let more = queue.orders.len() - before;
        let many = queue.orders.len() > FEW;
        drop(queue);
        self.waiting += more;
        if many {
            let cores = thread::available_parallelism().map_or(2, usize::from);
            self.hire((cores / 2).clamp(1, MOST_THREADS));
        } else if more > 0 {
            self.hire(1);
        }
    }

    /// Forgets all orders.
    pub(super) fn cancel(&mut self) {
        let left = core::mem::take(&mut locked(&self.shared.queue).orders);
        let made = core::mem::take(&mut *locked(&self.shared.made));
        self.waiting -= left.len() + made.len();
    }

    /// Returns finished orders, at most this many, without waiting.
    pub(super) fn hand_out(&mut self, most: usize, mut take: impl FnMut(Made)) {
        if !self.is_busy() {
            return;
        }
        if locked(&self.shared.queue).working == 0 {
            self.shared.work_at_most(MADE_A_FRAME);
        }
        // The thread that has the lock gives it back at once; the next frame takes what this one cannot.
        let Ok(mut made) = self.shared.made.try_lock() else {
            return;
        };
        let count = made.len().min(most);
        for made in made.drain(..count) {
            self.waiting -= 1;
            take(made);
        }
    }

    /// Waits until all orders are finished, and helps with them.
    pub(super) fn finish(&mut self) {
        if self.is_busy() || self.mixtures().is_none() {
            self.shared.work_at_most(usize::MAX);
            self.join();
        }
    }

    fn hire(&mut self, threads: usize) {
        self.threads.retain(|thread| !thread.is_finished());
        let mut queue = locked(&self.shared.queue);
        while queue.working < threads {
            let shared = Arc::clone(&self.shared);
            let hired = thread::Builder::new()
                .name("footfall crowd".to_owned())
                .spawn(move || shared.work());
            // Without threads, frames do the work.
            let Ok(hired) = hired else {
                break;
            };
            queue.working += 1;
            self.threads.push(hired);
        }
    }

    fn join(&mut self) {
        for thread in self.threads.drain(..) {
            // A thread that panicked has reported so.
            let _ended = thread.join();
        }
    }
}

impl Drop for Maker {
    fn drop(&mut self) {
        self.cancel();
        // They end after the current walker, or after the mixtures: longer than a frame.
        disposal::leave_to_end(self.threads.drain(..));
    }
}

impl Shared {
    fn prepared(&self) -> &Prepared {
        self.mixtures
            .get_or_init(|| Mixtures::new(&self.recipe).map(Arc::new).map_err(Arc::new))
    }

    /// A thread's whole life.
    fn work(&self) {
        let Ok(mixtures) = self.prepared() else {
            locked(&self.queue).working -= 1;
            return;
        };
        let mut workshop = None;
        loop {
            let mut queue = locked(&self.queue);
            let Some(order) = queue.orders.pop_front() else {
                queue.working -= 1;
                return;
            };
            drop(queue);
            let made = make(mixtures, order, || {
                workshop.get_or_insert_with(|| Workshop::new(&mixtures.plain))
            });
            locked(&self.made).push_back(made);
        }
    }

    /// Carries out this many orders on the caller's thread.
    fn work_at_most(&self, most: usize) {
        let Ok(mixtures) = self.prepared() else {
            return;
        };
        for _ in 0..most {
            let Some(order) = locked(&self.queue).orders.pop_front() else {
                break;
            };
            let mut workshop = locked(&mixtures.workshops[0]);
            let made = make(mixtures, order, || &mut workshop);
            drop(workshop);
            locked(&self.made).push_back(made);
        }
    }
}

fn make<'a>(
    mixtures: &Mixtures,
    order: Order,
    workshop: impl FnOnce() -> &'a mut Workshop,
) -> Made {
    let styled = mixtures.get_or_make(&order.mixture);
    let walker = order.config.as_ref().and_then(|config| {
        if !order.alone {
            // It takes steps of its own where it is seen to.
            return Some(CrowdWalker::sharing(&styled, config));
        }
        // A walker is of the plain walk when it begins, and dresses with its first step.
        let mut walker = CrowdWalker::new(&mixtures.plain, config, false, workshop()).ok()?;
        walker.wear(&styled);
        Some(walker)
    });
    Made {
        order,
        styled,
        walker,
    }
}
