//! SlimeVR's protocol, which owoTrack on phones and trackers of ESP boards speak: big-endian, kind (4 bytes), number (8), content.

use crate::live::reading::{Quantity, Reading};
use glam::{Quat, Vec3};

/// Kinds of packets that matter here.
const HEARTBEAT: u32 = 0;
const ROTATION: u32 = 1;
const GYROSCOPE: u32 = 2;
const HANDSHAKE: u32 = 3;
const ACCELERATION: u32 = 4;
const ROTATION_OF_SENSOR: u32 = 17;
const BUNDLE: u32 = 100;

/// Kinds that there are; others are no packets of this protocol.
const MOST_KIND: u32 = 120;

/// Reply to a handshake, by which a tracker recognises a server.
pub const HANDSHAKE_REPLY: &[u8] = b"\x03Hey OVR =D 5";

/// Heartbeat without a number, sent to a tracker every second so that it keeps sending.
pub const HEARTBEAT_PACKET: &[u8] = &[0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0];

/// Answer that a packet asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packet {
    /// Nothing.
    Plain,
    /// The tracker looks for a server: answer with [`HANDSHAKE_REPLY`].
    Handshake,
}

/// Returns true when this can be a packet of the protocol.
pub fn is_packet(bytes: &[u8]) -> bool {
    u32_at(bytes, 0).is_some_and(|kind| kind <= MOST_KIND) && bytes.len() >= 12
}

/// Parses a packet and gives its readings with the number of the sensor on the tracker; `None` when it is broken.
pub fn parse(bytes: &[u8], mut give: impl FnMut(u8, Reading)) -> Option<Packet> {
    let kind = u32_at(bytes, 0)?;
    let content = bytes.get(12..)?;
    match kind {
        HANDSHAKE => return Some(Packet::Handshake),
        HEARTBEAT => {}
        BUNDLE => {
            let mut rest = content;
            while let Some(length) = rest.get(..2) {
                let length = usize::from(u16::from_be_bytes([length[0], length[1]]));
                let inner = rest.get(2..2 + length)?;
                part(u32_at(inner, 0)?, inner.get(4..)?, &mut give)?;
                rest = &rest[2 + length..];
            }
        }
        _ => part(kind, content, &mut give)?,
    }
    Some(Packet::Plain)
}

fn part(kind: u32, content: &[u8], give: &mut impl FnMut(u8, Reading)) -> Option<()> {
    let number = |n: usize| {
        content
            .get(4 * n..4 * n + 4)
            .map(|b| f32::from_be_bytes([b[0], b[1], b[2], b[3]]))
    };
    let vector = || Some(Vec3::new(number(0)?, number(1)?, number(2)?));
    let (sensor, quantity) = match kind {
        ROTATION => (
            0,
            Quantity::Orientation(Quat::from_vec4(vector()?.extend(number(3)?))),
        ),
        GYROSCOPE => (0, Quantity::Rate(vector()?)),
        // Newer trackers send the sensor after the numbers.
        ACCELERATION => (
            content.get(12).copied().unwrap_or(0),
            Quantity::Acceleration(vector()?),
        ),
        ROTATION_OF_SENSOR => {
            let (sensor, values) = (*content.first()?, content.get(2..18)?);
            let value = |n: usize| {
                f32::from_be_bytes([
                    values[4 * n],
                    values[4 * n + 1],
                    values[4 * n + 2],
                    values[4 * n + 3],
                ])
            };
            (
                sensor,
                Quantity::Orientation(Quat::from_xyzw(value(0), value(1), value(2), value(3))),
            )
        }
        // Battery, magnetometer and the like.
        _ => return Some(()),
    };
    give(
        sensor,
        Reading {
            time_secs: None,
            quantity,
        },
    );
    Some(())
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}
