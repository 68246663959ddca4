//! One place for each player's phone.

use crate::live::device::{DeviceStatus, DeviceWriter, now_secs};
use crate::live::link::{LinkState, LinkWriter};
use crate::live::phone::parse;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Time of silence after which another phone may take a phone's place, seconds.
const KEPT_SECS: f64 = 3.0;

/// The players' codes and phones.
#[derive(Debug)]
pub(super) struct Slots {
    slots: Vec<Slot>,
}

#[derive(Debug)]
struct Slot {
    code: String,
    footsteps: AtomicU64,
    phone: Mutex<Phone>,
}

#[derive(Debug, Default)]
struct Phone {
    /// The page that holds the place: a number that it drew itself.
    page: String,
    heard_secs: Option<f64>,
    device: Option<DeviceWriter>,
}

impl Slots {
    pub(super) fn new(codes: Vec<String>) -> Self {
        let slot = |code| Slot {
            code,
            footsteps: AtomicU64::new(0),
            phone: Mutex::default(),
        };
        Self {
            slots: codes.into_iter().map(slot).collect(),
        }
    }

    /// Makes a device for every player, so that their order is the players'.
    pub(super) fn open(&self, link: &LinkWriter) {
        for (n, slot) in self.slots.iter().enumerate() {
            slot.lock().device = link.add(&format!("phone of player {}", n + 1), "browser");
        }
    }

    pub(super) fn code(&self, player: usize) -> Option<&str> {
        self.slots.get(player).map(|slot| slot.code.as_str())
    }

    /// The player of a code. Every code is compared to its end, so that the time taken reveals nothing.
    pub(super) fn player(&self, code: &str) -> Option<usize> {
        let same = |own: &str| {
            let differ = own
                .bytes()
                .zip(code.bytes())
                .fold(0, |sum, (a, b)| sum | (a ^ b));
            own.len() == code.len() && differ == 0
        };
        self.slots.iter().position(|slot| same(&slot.code))
    }

    pub(super) fn vibrate(&self, player: usize) {
        if let Some(slot) = self.slots.get(player) {
            slot.footsteps.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Footsteps so far.
    pub(super) fn footsteps(&self, player: usize) -> u64 {
        self.slots[player].footsteps.load(Ordering::Relaxed)
    }

    /// Takes a message of a page. An error is the text for the person.
    pub(super) fn take(
        &self,
        link: &LinkWriter,
        player: usize,
        page: &str,
        message: &[u8],
    ) -> Result<DeviceStatus, &'static str> {
        let now = now_secs();
        let mut phone = self.slots[player].lock();
        if phone.page != page {
            if phone
                .heard_secs
                .is_some_and(|heard| now - heard < KEPT_SECS)
            {
                return Err("Another phone drives this player. Close its page first.");
            }
            page.clone_into(&mut phone.page);
        }
        phone.heard_secs = Some(now);
        let Some(device) = &mut phone.device else {
            return Err("The game has no free place for this phone.");
        };
        if !parse(message, |reading| device.push(reading, now)) {
            device.rejected();
            link.count_garbage(1);
            return Err("The page does not match the game. Reload the page.");
        }
        link.set_state(LinkState::Receiving);
        Ok(device.device().status())
    }
}

impl Slot {
    fn lock(&self) -> MutexGuard<'_, Phone> {
        self.phone.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
