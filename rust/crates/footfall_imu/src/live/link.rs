//! A port that is listened to, on a thread of its own, and the devices that are heard there.

use super::device::{Device, DeviceWriter};
use std::io;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Most devices at one port.
pub(super) const MOST_DEVICES: usize = 16;

/// A thread looks this often whether it is to stop.
pub(super) const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Time of silence after which a new device from the same sender takes a device's place, seconds.
const PLACE_KEPT_SECS: f64 = 2.0;

/// State of a port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkState {
    /// It is being opened, or its format is being detected.
    Opening(String),
    /// It is open; nothing has been received yet.
    Listening(String),
    /// Devices are heard.
    Receiving,
    /// It cannot be opened now: the reason, and what to do. It is tried again.
    Failed(String),
}

impl LinkState {
    /// Its name, for scripts and tables.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Opening(_) => "opening",
            Self::Listening(_) => "listening",
            Self::Receiving => "receiving",
            Self::Failed(_) => "failed",
        }
    }

    /// Message for a person.
    pub fn message(&self) -> &str {
        match self {
            Self::Opening(text) | Self::Listening(text) | Self::Failed(text) => text,
            Self::Receiving => "",
        }
    }
}

#[derive(Debug)]
struct Shared {
    devices: Mutex<Vec<Device>>,
    state: Mutex<LinkState>,
    address: Mutex<Option<SocketAddr>>,
    stop: AtomicBool,
    garbage: AtomicU64,
}

/// A port that is listened to; it is closed when this is dropped.
#[derive(Debug)]
pub struct Link {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Link {
    /// Runs `listen` on a thread until it returns; it has to, soon after [`LinkWriter::stopped`].
    fn run(name: &str, listen: impl FnOnce(LinkWriter) + Send + 'static) -> Self {
        let shared = Arc::new(Shared {
            devices: Mutex::default(),
            state: Mutex::new(LinkState::Opening("opening".to_owned())),
            address: Mutex::default(),
            stop: AtomicBool::new(false),
            garbage: AtomicU64::new(0),
        });
        let writer = LinkWriter {
            shared: Arc::clone(&shared),
        };
        let thread = std::thread::Builder::new()
            .name(format!("footfall {name}"))
            .spawn(move || listen(writer));
        let thread = match thread {
            Ok(thread) => Some(thread),
            Err(error) => {
                *lock(&shared.state) = LinkState::Failed(format!("cannot start a thread: {error}"));
                None
            }
        };
        Self { shared, thread }
    }

    /// Runs `listen` on a thread, and again some time after it returned a problem, until it is time to stop.
    pub(super) fn keep(
        name: &str,
        retry: Duration,
        mut listen: impl FnMut(&LinkWriter) -> String + Send + 'static,
    ) -> Self {
        Self::run(name, move |link| {
            while !link.stopped() {
                let problem = listen(&link);
                if !link.stopped() {
                    link.set_state(LinkState::Failed(problem));
                    link.wait(retry);
                }
            }
        })
    }

    /// State of the port.
    pub fn state(&self) -> LinkState {
        lock(&self.shared.state).clone()
    }

    /// Every device that was heard, in the order in which they came.
    pub fn devices(&self) -> Vec<Device> {
        lock(&self.shared.devices).clone()
    }

    /// Number of devices that were heard.
    pub fn device_count(&self) -> usize {
        lock(&self.shared.devices).len()
    }

    /// The device that came first, second, …
    pub fn device(&self, place: usize) -> Option<Device> {
        lock(&self.shared.devices).get(place).cloned()
    }

    /// Bytes or packets so far that were no message of any known form.
    pub fn garbage(&self) -> u64 {
        self.shared.garbage.load(Ordering::Relaxed)
    }

    /// Address that a network's link listens on, once it does.
    pub fn address(&self) -> Option<SocketAddr> {
        *lock(&self.shared.address)
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        let Some(thread) = self.thread.take() else {
            return;
        };
        // A port is free again when this returns; one that the system holds up must not hold up a game.
        let mut waited = Duration::ZERO;
        while !thread.is_finished() && waited < 3 * LOOK_EVERY {
            std::thread::sleep(LOOK_EVERY / 10);
            waited += LOOK_EVERY / 10;
        }
    }
}

/// The end of a link that its thread holds.
#[derive(Clone, Debug)]
pub(super) struct LinkWriter {
    shared: Arc<Shared>,
}

impl LinkWriter {
    pub(super) fn stopped(&self) -> bool {
        self.shared.stop.load(Ordering::Relaxed)
    }

    /// Waits, but no longer than until it is time to stop.
    fn wait(&self, time: Duration) {
        let mut left = time;
        while !self.stopped() && !left.is_zero() {
            let part = left.min(LOOK_EVERY);
            std::thread::sleep(part);
            left -= part;
        }
    }

    pub(super) fn set_state(&self, state: LinkState) {
        *lock(&self.shared.state) = state;
    }

    pub(super) fn set_address(&self, address: SocketAddr) {
        *lock(&self.shared.address) = Some(address);
    }

    pub(super) fn count_garbage(&self, count: u64) {
        self.shared.garbage.fetch_add(count, Ordering::Relaxed);
    }

    /// A new device, or `None` when there are too many.
    pub(super) fn add(&self, name: &str, format: &'static str) -> Option<DeviceWriter> {
        let mut devices = lock(&self.shared.devices);
        if devices.len() == MOST_DEVICES {
            return None;
        }
        let writer = DeviceWriter::new(name, format);
        devices.push(writer.device());
        drop(devices);
        self.set_state(LinkState::Receiving);
        Some(writer)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // Each value is whole at every moment, whatever became of the thread that wrote it.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The devices of a link by their senders.
#[derive(Debug)]
pub(super) struct Senders<K> {
    link: LinkWriter,
    known: Vec<(K, DeviceWriter)>,
}

impl<K: PartialEq> Senders<K> {
    pub(super) const fn new(link: LinkWriter) -> Self {
        Self {
            link,
            known: Vec::new(),
        }
    }

    /// The device of a sender; `alike` decides who may take over the place of one that has fallen silent. `None` when there are too many.
    pub(super) fn device(
        &mut self,
        sender: K,
        alike: impl Fn(&K) -> bool,
        name: impl FnOnce() -> String,
        format: &'static str,
    ) -> Option<&mut DeviceWriter> {
        let known = self.known.iter().position(|(key, _)| *key == sender);
        let place = match known {
            Some(place) => place,
            None => self.place_of_new(sender, alike, name, format)?,
        };
        Some(&mut self.known[place].1)
    }

    fn place_of_new(
        &mut self,
        sender: K,
        alike: impl Fn(&K) -> bool,
        name: impl FnOnce() -> String,
        format: &'static str,
    ) -> Option<usize> {
        let silent = |writer: &DeviceWriter| {
            let status = writer.device().status();
            status.format == format && status.silent_secs() > PLACE_KEPT_SECS
        };
        let left = self
            .known
            .iter()
            .position(|(key, writer)| alike(key) && silent(writer));
        if let Some(place) = left {
            self.known[place].0 = sender;
            return Some(place);
        }
        let writer = self.link.add(&name(), format)?;
        self.known.push((sender, writer));
        Some(self.known.len() - 1)
    }
}

/// Message for a person when a port of the network cannot be opened.
pub(super) fn bind_problem(what: &str, port: u16, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            format!(
                "{what} port {port} is taken by another program; close the program, or choose another port"
            )
        }
        io::ErrorKind::PermissionDenied => {
            format!("this user may not open {what} port {port}; choose a port above 1023")
        }
        _ => format!("{what} port {port} cannot be opened: {error}"),
    }
}
