//! Yost 3-Space: big-endian answers behind the head that [`SETUP`] asks for: success, time, echo, sum, length.

use super::{Format, Taken, bytes_at, sum};
use crate::live::clock::Counter;
use crate::live::reading::{Quantity, Reading};
use crate::sample::GRAVITY_MPS2;
use glam::Vec3;

/// Data of an answer: corrected rates (rad/s), then corrected forces (g).
const DATA: usize = 6 * 4;
const HEAD: usize = 8;

/// The echo of what streams.
const STREAMED: u8 = 0xFF;

/// Commands that make a device stream at 100 Hz: head with success, time, echo, sum and length; slots for rates and forces; interval; start.
pub(super) const SETUP: [&[u8]; 4] = [
    &[0xF7, 0xDD, 0, 0, 0, 0x4F, 0x2C],
    &[
        0xF7, 0x50, 0x26, 0x27, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x97,
    ],
    &[
        0xF7, 0x52, 0, 0, 0x27, 0x10, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0x85,
    ],
    &[0xF9, 0x55, 0x55],
];

/// The time goes round after 2³² µs.
#[derive(Default)]
pub(super) struct ThreeSpace {
    micros: Counter,
}

impl Format for ThreeSpace {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        if bytes[0] != 0 {
            return Taken::Garbage(
                bytes
                    .iter()
                    .position(|byte| *byte == 0)
                    .unwrap_or(bytes.len()),
            );
        }
        let Some([_, t0, t1, t2, t3, echo, checksum, length]) = bytes_at::<HEAD>(bytes, 0) else {
            return Taken::More;
        };
        if echo != STREAMED || usize::from(length) != DATA {
            return Taken::Garbage(1);
        }
        let Some(data) = bytes_at::<DATA>(bytes, HEAD) else {
            return Taken::More;
        };
        if sum(&data) != checksum {
            return Taken::Garbage(1);
        }
        let number = |n: usize| {
            let at = 4 * n;
            f32::from_be_bytes([data[at], data[at + 1], data[at + 2], data[at + 3]])
        };
        let micros = self
            .micros
            .unwrapped(u64::from(u32::from_be_bytes([t0, t1, t2, t3])), 32);
        give(Reading {
            time_secs: Some(micros as f64 * 1e-6),
            quantity: Quantity::Both {
                rate: Vec3::new(number(0), number(1), number(2)),
                force: Vec3::new(number(3), number(4), number(5)) * GRAVITY_MPS2,
            },
        });
        Taken::Message(HEAD + DATA)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_carries_its_sum() {
        for command in SETUP {
            let (sum, rest) = command.split_last().unwrap();
            let own = rest[1..]
                .iter()
                .fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
            assert_eq!(own, *sum, "{command:x?}");
        }
    }
}
