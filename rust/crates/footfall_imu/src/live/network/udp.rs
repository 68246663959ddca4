//! One port for everything that comes as datagrams.

use super::{is_local, osc, slimevr};
use crate::live::device::now_secs;
use crate::live::json;
use crate::live::link::{
    LOOK_EVERY, Link, LinkState, LinkWriter, MOST_DEVICES, Senders, bind_problem,
};
use crate::live::reading::Reading;
use crate::live::serial::{Text, TextFormat};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::time::Duration;

/// The port that SlimeVR's trackers look for.
pub const DEFAULT_PORT: u16 = 6969;

/// Longer datagrams are no messages of a sensor, bytes.
const LONGEST: usize = 4096;

/// Interval of heartbeats to trackers, seconds; they give up after ten without one.
const HEARTBEAT_SECS: f64 = 1.0;

/// Time after which a port in use is tried again.
const RETRY: Duration = Duration::from_secs(2);

/// Address to listen on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UdpConfig {
    /// The port; 0 for any that is free.
    pub port: u16,
    /// Meaning of lines of numbers.
    pub text: TextFormat,
}

impl Default for UdpConfig {
    fn default() -> Self {
        Self {
            port: DEFAULT_PORT,
            text: TextFormat::default(),
        }
    }
}

/// Time for which a silent sender of lines is kept, seconds.
const TEXT_KEPT_SECS: f64 = 10.0;

/// A sender: its address, and which of its sensors.
type Sender = (SocketAddr, u8);

/// Listens until the link is dropped.
pub fn listen(config: UdpConfig) -> Link {
    Link::keep("udp", RETRY, move |link| {
        match UdpSocket::bind((Ipv4Addr::UNSPECIFIED, config.port)) {
            Ok(socket) => receive(link, &socket, &config),
            Err(error) => bind_problem("UDP", config.port, &error),
        }
    })
}

fn receive(link: &LinkWriter, socket: &UdpSocket, config: &UdpConfig) -> String {
    let address = match socket
        .set_read_timeout(Some(LOOK_EVERY))
        .and_then(|()| socket.local_addr())
    {
        Ok(address) => address,
        Err(error) => return format!("UDP port {}: {error}", config.port),
    };
    link.set_address(address);
    link.set_state(LinkState::Listening(format!(
        "waiting for a sensor on UDP port {}",
        address.port()
    )));
    let mut receiver = Receiver {
        link: link.clone(),
        senders: Senders::new(link.clone()),
        texts: Vec::new(),
        config: config.clone(),
    };
    let mut trackers: Vec<SocketAddr> = Vec::new();
    let mut beaten_secs = 0.0;
    let mut buffer = [0; LONGEST + 1];
    while !link.stopped() {
        match socket.recv_from(&mut buffer) {
            Ok((length, from)) if is_local(from.ip()) => {
                if receiver.datagram(&buffer[..length], from) == Some(slimevr::Packet::Handshake) {
                    // What cannot be sent the tracker asks for again.
                    drop(socket.send_to(slimevr::HANDSHAKE_REPLY, from));
                    if !trackers.contains(&from) && trackers.len() < MOST_DEVICES {
                        trackers.push(from);
                    }
                }
            }
            // Who is not on this network gets no answer.
            Ok(_) => link.count_garbage(1),
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock
                | io::ErrorKind::TimedOut
                | io::ErrorKind::Interrupted
                // Windows reports an answer that could not be delivered here.
                | io::ErrorKind::ConnectionReset => {}
                _ => return format!("UDP port {}: {error}", address.port()),
            },
        }
        let now = now_secs();
        if now - beaten_secs > HEARTBEAT_SECS {
            beaten_secs = now;
            for tracker in &trackers {
                drop(socket.send_to(slimevr::HEARTBEAT_PACKET, tracker));
            }
        }
    }
    String::new()
}

/// Finds out of each datagram what it is.
struct Receiver {
    link: LinkWriter,
    senders: Senders<Sender>,
    texts: Vec<TextSender>,
    config: UdpConfig,
}

impl Receiver {
    fn datagram(&mut self, bytes: &[u8], from: SocketAddr) -> Option<slimevr::Packet> {
        let now = now_secs();
        let mut readings = Vec::new();
        let mut asked = None;
        let format = if bytes.len() > LONGEST {
            None
        } else if slimevr::is_packet(bytes) {
            asked = slimevr::parse(bytes, |sensor, reading| readings.push((sensor, reading)));
            asked.map(|_| "slimevr")
        } else if osc::is_packet(bytes) {
            osc::parse(bytes, |reading| readings.push((0, reading))).then_some("osc")
        } else if bytes.starts_with(b"{")
            && json::parse(bytes, |reading| readings.push((0, reading)))
        {
            Some("json")
        } else {
            self.text(from, bytes, &mut |reading| readings.push((0, reading)))
                .then_some("text")
        };
        let Some(format) = format else {
            self.link.count_garbage(1);
            return None;
        };
        for (sensor, reading) in readings {
            let alike = |other: &Sender| other.0.ip() == from.ip() && other.1 == sensor;
            let name = || {
                if sensor == 0 {
                    from.to_string()
                } else {
                    format!("{from}, sensor {sensor}")
                }
            };
            if let Some(device) = self.senders.device((from, sensor), alike, name, format) {
                device.push(reading, now);
            }
        }
        asked
    }

    fn text(&mut self, from: SocketAddr, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> bool {
        let now = now_secs();
        let known = self.texts.iter().position(|text| text.from == from);
        let mut fresh = TextSender {
            from,
            heard_secs: now,
            text: Text::of_datagrams(&self.config.text),
        };
        let sender = match known {
            Some(place) => &mut self.texts[place],
            None => &mut fresh,
        };
        sender.heard_secs = now;
        let mut good = !bytes.trim_ascii().is_empty();
        for line in bytes.split(|byte| *byte == b'\n') {
            good &= sender.text.line(line, give);
        }
        // Who made sense once is kept; who fell silent makes room.
        if known.is_none() && good {
            if self.texts.len() == MOST_DEVICES {
                self.texts
                    .retain(|text| now - text.heard_secs < TEXT_KEPT_SECS);
            }
            if self.texts.len() < MOST_DEVICES {
                self.texts.push(fresh);
            }
        }
        good
    }
}

/// A sender of lines of numbers, whose units are being guessed or are known.
struct TextSender {
    from: SocketAddr,
    heard_secs: f64,
    text: Text,
}
