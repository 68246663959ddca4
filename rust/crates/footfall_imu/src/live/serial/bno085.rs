//! BNO085 in UART-RVC mode: `AA AA index yaw pitch roll ax ay az 0 0 0 sum`, little-endian, 100 a second, angles in 0.01°, forces in mg.
//!
//! It is recognised so that a person learns why nothing moves: without angular rates no gait can be reconstructed.

use super::{Format, Taken, bytes_at, garbage_until, sum};
use crate::live::reading::{Quantity, Reading};
use crate::sample::GRAVITY_MPS2;
use glam::Vec3;

const BEGINS: u8 = 0xAA;
const LENGTH: usize = 19;

pub(super) struct Bno085;

impl Format for Bno085 {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        if bytes[0] != BEGINS || bytes.get(1).is_some_and(|byte| *byte != BEGINS) {
            return garbage_until(bytes, BEGINS);
        }
        let Some(message) = bytes_at::<LENGTH>(bytes, 0) else {
            return Taken::More;
        };
        if sum(&message[2..LENGTH - 1]) != message[LENGTH - 1] {
            return garbage_until(bytes, BEGINS);
        }
        let number = |n: usize| {
            f32::from(i16::from_le_bytes([
                message[9 + 2 * n],
                message[10 + 2 * n],
            ])) * 1e-3
        };
        give(Reading {
            time_secs: None,
            quantity: Quantity::Force(Vec3::new(number(0), number(1), number(2)) * GRAVITY_MPS2),
        });
        Taken::Message(LENGTH)
    }
}
