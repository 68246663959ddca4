//! x-IMU3: messages that end with a line feed, as text (`I,µs,gx,gy,gz,ax,ay,az`) or binary (the letter with its highest bit set, little-endian
//! numbers, line feeds in them escaped). Angular rate is in °/s, specific force in g.

use super::{Format, Taken, bytes_at};
use crate::live::reading::{Quantity, Reading};
use glam::Vec3;

const END: u8 = b'\n';
const ESCAPE: u8 = 0xDB;

/// Escaped, a message of binary numbers takes at most twice its length.
const LONGEST: usize = 512;

/// Time, then six numbers.
const INERTIAL_BYTES: usize = 8 + 6 * 4;

/// Letters that begin a message of text: measurements, notes, and replies to commands.
const LETTERS: &[u8] = b"IMQRALEHTBWSNF{";

pub(super) struct XImu3;

impl Format for XImu3 {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        let letter = bytes[0] & 0x7F;
        if !LETTERS.contains(&letter) {
            return Taken::Garbage(1);
        }
        let Some(length) = bytes.iter().take(LONGEST).position(|byte| *byte == END) else {
            return if bytes.len() < LONGEST {
                Taken::More
            } else {
                Taken::Garbage(1)
            };
        };
        let binary = bytes[0] & 0x80 != 0;
        let inertial = match (letter, binary) {
            (b'I', true) => inertial_of_binary(&bytes[1..length]),
            (b'I', false) => inertial_of_text(&bytes[1..length]),
            // Of other messages only their form is known.
            (_, true) | (b'{', false) => return Taken::Message(length + 1),
            (_, false) if bytes.get(1) == Some(&b',') => return Taken::Message(length + 1),
            _ => None,
        };
        let Some([time, gx, gy, gz, ax, ay, az]) = inertial else {
            return Taken::Garbage(length + 1);
        };
        let vector = |values: [f64; 3]| Vec3::from_array(values.map(|value| value as f32));
        give(Reading {
            time_secs: Some(time * 1e-6),
            quantity: Quantity::of_g_and_degrees(vector([ax, ay, az]), vector([gx, gy, gz])),
        });
        Taken::Message(length + 1)
    }
}

fn inertial_of_text(text: &[u8]) -> Option<[f64; 7]> {
    let text = core::str::from_utf8(text).ok()?.trim_end();
    let mut fields = text.strip_prefix(',')?.split(',');
    let mut values = [0.0; 7];
    for value in &mut values {
        *value = fields.next()?.trim().parse().ok()?;
    }
    fields.next().is_none().then_some(values)
}

fn inertial_of_binary(escaped: &[u8]) -> Option<[f64; 7]> {
    let mut bytes = [0; INERTIAL_BYTES];
    let mut places = bytes.iter_mut();
    let mut rest = escaped.iter();
    while let Some(byte) = rest.next() {
        *places.next()? = match (*byte, byte) {
            (ESCAPE, _) => match rest.next()? {
                0xDC => END,
                0xDD => ESCAPE,
                _ => return None,
            },
            (plain, _) => plain,
        };
    }
    if places.next().is_some() {
        return None;
    }
    let mut values = [0.0; 7];
    values[0] = u64::from_le_bytes(bytes_at(&bytes, 0)?) as f64;
    for (n, value) in values[1..].iter_mut().enumerate() {
        *value = f64::from(f32::from_le_bytes(bytes_at(&bytes, 8 + 4 * n)?));
    }
    Some(values)
}
