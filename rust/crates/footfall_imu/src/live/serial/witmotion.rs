//! WitMotion: messages of 11 bytes, `55 kind d0 … d7 sum`, four little-endian numbers each.

use super::{Format, Taken, bytes_at, garbage_until, sum};
use crate::live::reading::{Quantity, Reading};
use glam::Vec3;

const BEGINS: u8 = 0x55;
const LENGTH: usize = 11;

/// Kinds of messages: WitMotion's register numbers.
const FORCE: u8 = 0x51;
const RATE: u8 = 0x52;
const KINDS: core::ops::RangeInclusive<u8> = 0x50..=0x5F;

/// Full scales, g and °/s.
const MOST_G: f32 = 16.0;
const MOST_DPS: f32 = 2000.0;

/// A rate comes right after its force.
#[derive(Default)]
pub(super) struct WitMotion {
    force: Option<Vec3>,
}

impl Format for WitMotion {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        if bytes[0] != BEGINS {
            return garbage_until(bytes, BEGINS);
        }
        let Some(message) = bytes_at::<LENGTH>(bytes, 0) else {
            return Taken::More;
        };
        if sum(&message[..LENGTH - 1]) != message[LENGTH - 1] || !KINDS.contains(&message[1]) {
            return garbage_until(bytes, BEGINS);
        }
        let number = |n: usize| {
            f32::from(i16::from_le_bytes([message[2 + 2 * n], message[3 + 2 * n]])) / 32768.0
        };
        let vector = Vec3::new(number(0), number(1), number(2));
        match message[1] {
            FORCE => self.force = Some(vector * MOST_G),
            RATE => {
                if let Some(force) = self.force.take() {
                    give(Reading {
                        time_secs: None,
                        quantity: Quantity::of_g_and_degrees(force, vector * MOST_DPS),
                    });
                }
            }
            _ => {}
        }
        Taken::Message(LENGTH)
    }
}
