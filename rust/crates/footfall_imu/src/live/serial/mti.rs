//! Xsens MTi: `FA FF 36 length … sum`, where the content is a list of items, each `identifier (2) size (1) data`, big-endian.

use super::{Format, Taken, bytes_at, garbage_until, sum};
use crate::live::clock::Counter;
use crate::live::reading::{Quantity, Reading};
use glam::Vec3;

const BEGINS: u8 = 0xFA;
const MT_DATA2: u8 = 0x36;

/// A length of this value is followed by a longer one of two bytes.
const EXTENDED: u8 = 0xFF;
const LONGEST: usize = 2000;

/// Identifiers without the bits for the number format and the frame.
const ACCELERATION: u16 = 0x4020;
const RATE_OF_TURN: u16 = 0x8020;
const SAMPLE_TIME_FINE: u16 = 0x1060;

/// Ticks of the fine time in a second.
const TICKS: f64 = 10_000.0;

/// The fine time goes round after 2³² ticks.
#[derive(Default)]
pub(super) struct Mti {
    ticks: Counter,
}

impl Format for Mti {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        if bytes[0] != BEGINS {
            return garbage_until(bytes, BEGINS);
        }
        let Some([_, _, kind, length]) = bytes_at::<4>(bytes, 0) else {
            return Taken::More;
        };
        let (head, length) = if length == EXTENDED {
            let Some(length) = bytes_at::<2>(bytes, 4) else {
                return Taken::More;
            };
            (6, usize::from(u16::from_be_bytes(length)))
        } else {
            (4, usize::from(length))
        };
        if length > LONGEST {
            return garbage_until(bytes, BEGINS);
        }
        let whole = head + length + 1;
        let Some(message) = bytes.get(..whole) else {
            return Taken::More;
        };
        if sum(&message[1..]) != 0 {
            return garbage_until(bytes, BEGINS);
        }
        if kind == MT_DATA2
            && let Some(reading) = self.reading(&message[head..whole - 1])
        {
            give(reading);
        }
        Taken::Message(whole)
    }
}

impl Mti {
    fn reading(&mut self, mut items: &[u8]) -> Option<Reading> {
        let (mut force, mut rate, mut time_secs) = (None, None, None);
        while let Some([high, low, size]) = bytes_at::<3>(items, 0) {
            let identifier = u16::from_be_bytes([high, low]);
            let data = items.get(3..3 + usize::from(size))?;
            items = &items[3 + usize::from(size)..];
            match identifier & 0xFFF0 {
                ACCELERATION => force = vector(data, identifier),
                RATE_OF_TURN => rate = vector(data, identifier),
                SAMPLE_TIME_FINE => {
                    let ticks = u32::from_be_bytes(bytes_at(data, 0)?);
                    time_secs = Some(self.ticks.unwrapped(u64::from(ticks), 32) as f64 / TICKS);
                }
                // A counter alone gives no time: its rate is not known.
                _ => {}
            }
        }
        Some(Reading {
            time_secs,
            quantity: Quantity::Both {
                force: force?,
                rate: rate?,
            },
        })
    }
}

/// Three numbers in the format of the identifier's lowest bits.
fn vector(data: &[u8], identifier: u16) -> Option<Vec3> {
    let number = |n: usize| -> Option<f64> {
        Some(match identifier & 0x3 {
            0 => f64::from(f32::from_be_bytes(bytes_at(data, 4 * n)?)),
            1 => f64::from(i32::from_be_bytes(bytes_at(data, 4 * n)?)) / f64::from(1 << 20),
            2 => {
                let fraction = u32::from_be_bytes(bytes_at(data, 6 * n)?);
                let whole = i16::from_be_bytes(bytes_at(data, 6 * n + 4)?);
                f64::from(whole) + f64::from(fraction) / 4_294_967_296.0
            }
            _ => f64::from_be_bytes(bytes_at(data, 8 * n)?),
        })
    };
    Some(Vec3::new(
        number(0)? as f32,
        number(1)? as f32,
        number(2)? as f32,
    ))
}
