//! OSC of ZIG SIM and GyrOSC. Both give accelerations in g with iOS's sign: what pushes the other way.
//!
//! GyrOSC's forms are those that programs which read it expect; its makers publish none.

use crate::live::reading::{Quantity, Reading};
use crate::sample::GRAVITY_MPS2;
use glam::Vec3;
use rosc::{OscMessage, OscPacket, OscType};

/// Returns true when this can be a packet of OSC.
pub fn is_packet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"/") || bytes.starts_with(b"#bundle\0")
}

/// Parses a packet and gives its readings; false when it is broken.
pub fn parse(bytes: &[u8], mut give: impl FnMut(Reading)) -> bool {
    let Ok((_, packet)) = rosc::decoder::decode_udp(bytes) else {
        return false;
    };
    read(&packet, &mut give);
    true
}

fn read(packet: &OscPacket, give: &mut impl FnMut(Reading)) {
    match packet {
        OscPacket::Message(message) => {
            if let Some(quantity) = quantity(message) {
                give(Reading {
                    time_secs: None,
                    quantity,
                });
            }
        }
        OscPacket::Bundle(bundle) => {
            for packet in &bundle.content {
                read(packet, give);
            }
        }
    }
}

fn quantity(message: &OscMessage) -> Option<Quantity> {
    let gyrosc = message.addr.starts_with("/gyrosc/");
    let name = message.addr.rsplit('/').next()?;
    let number = |n: usize| match message.args.get(n)? {
        OscType::Float(value) => Some(*value),
        OscType::Double(value) => Some(*value as f32),
        OscType::Int(value) => Some(*value as f32),
        _ => None,
    };
    let vector = Vec3::new(number(0)?, number(1)?, number(2)?);
    match (name, gyrosc) {
        ("gravity" | "grav", _) => Some(Quantity::Gravity(-vector * GRAVITY_MPS2)),
        ("accel", _) => Some(Quantity::Acceleration(-vector * GRAVITY_MPS2)),
        // GyrOSC calls angles "gyro".
        ("rrate", true) | ("gyro", false) => Some(Quantity::Rate(vector)),
        _ => None,
    }
}
