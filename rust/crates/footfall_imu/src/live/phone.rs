//! A phone's browser as a sensor: the game serves a page, the page sends what the phone measures.
//!
//! Browsers give motion to pages over HTTPS alone, so the server has a certificate that it signed itself; the person accepts it
//! once. Each player has a code in the address of the page, and one phone at a time. Samples come over a secure WebSocket, or, where a browser
//! refuses that for such a certificate, in posts.
//!
//! A message holds the byte [`VERSION`], then for each sample eight little-endian numbers: time (f64, s), specific force x, y, z (f32, m/s²),
//! angular rate x, y, z (f32, rad/s).

mod certificate;
mod server;
mod slots;

use super::link::{LOOK_EVERY, Link, LinkWriter, MOST_DEVICES};
use super::reading::{Quantity, Reading};
use glam::Vec3;
use slots::Slots;
use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The port that is proposed to users.
pub const DEFAULT_PORT: u16 = 8443;

/// First byte of a message.
pub const VERSION: u8 = 1;

const SAMPLE_BYTES: usize = 32;

/// Longest message: a second at 200 Hz is shorter.
const LONGEST: usize = 1 + 256 * SAMPLE_BYTES;

/// Time after which a port in use is tried again.
const RETRY: Duration = Duration::from_secs(2);

/// Settings of a server of pages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhoneConfig {
    /// The port; 0 for any that is free.
    pub port: u16,
    /// Players, each with a code.
    pub players: usize,
    /// Folder of the certificate and the key.
    pub folder: PathBuf,
}

/// A server of pages for phones; it stops when this is dropped.
#[derive(Debug)]
pub struct PhoneServer {
    link: Link,
    slots: Arc<Slots>,
    own: IpAddr,
    port: u16,
}

impl PhoneServer {
    /// Begins to serve. Devices of the [`link`](Self::link) are the players' phones, in order.
    ///
    /// # Errors
    /// The system gives no randomness for codes.
    pub fn start(config: PhoneConfig) -> Result<Self, getrandom::Error> {
        let codes = (0..config.players.clamp(1, MOST_DEVICES)).map(|_| code());
        let codes: Vec<String> = codes.collect::<Result<_, _>>()?;
        let slots = Arc::new(Slots::new(codes));
        let (own, port) = (own_address(), config.port);
        let shared = Arc::clone(&slots);
        let mut opened = false;
        let link = Link::keep("phone", RETRY, move |link| {
            if !opened {
                shared.open(link);
                opened = true;
            }
            let server = server::serve(link.clone(), config.clone(), own, Arc::clone(&shared));
            until_stopped(link, server)
        });
        Ok(Self {
            link,
            slots,
            own,
            port,
        })
    }

    /// Its state and the players' phones.
    pub const fn link(&self) -> &Link {
        &self.link
    }

    /// The address of a player's page, as a phone on the same network reaches it; `None` for a player that there is not.
    pub fn url(&self, player: usize) -> Option<String> {
        let port = self
            .link
            .address()
            .map_or(self.port, |address| address.port());
        let code = self.slots.code(player)?;
        Some(format!("https://{}:{port}/p/{code}", self.own))
    }

    /// Makes a player's phone vibrate briefly, as for a footstep.
    pub fn vibrate(&self, player: usize) {
        self.slots.vibrate(player);
    }
}

/// A QR code: modules in a row, and all of them row by row, true where dark. `None` for a text that is too long.
pub fn qr_code(text: &str) -> Option<(usize, Vec<bool>)> {
    let code = qrcode::QrCode::new(text).ok()?;
    let dark = |color: qrcode::Color| color == qrcode::Color::Dark;
    Some((
        code.width(),
        code.to_colors().into_iter().map(dark).collect(),
    ))
}

/// The address of this machine in the local network; its own alone when there is no network.
fn own_address() -> IpAddr {
    let own = if_addrs::get_if_addrs().unwrap_or_default();
    let private = own.iter().filter_map(|interface| match interface.ip() {
        IpAddr::V4(v4) if v4.is_private() => Some(v4),
        _ => None,
    });
    // Homes use 192.168; the other ranges are often those of virtual machines.
    let rank = |address: &Ipv4Addr| {
        [192, 10]
            .iter()
            .position(|first| *first == address.octets()[0])
            .unwrap_or(2)
    };
    private
        .min_by_key(rank)
        .map_or(IpAddr::V4(Ipv4Addr::LOCALHOST), IpAddr::V4)
}

/// Letters and digits that are not mistaken for each other.
const LETTERS: &[u8; 32] = b"abcdefghijkmnpqrstuvwxyz23456789";

/// Forty random bits.
fn code() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 8];
    getrandom::fill(&mut bytes)?;
    let letter = |byte: u8| char::from(LETTERS[usize::from(byte) % LETTERS.len()]);
    Ok(bytes.map(letter).iter().collect())
}

/// Runs a server on this thread until it ends or it is time to stop. Returns why it ended.
pub(super) fn until_stopped(link: &LinkWriter, server: impl Future<Output = String>) -> String {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build();
    let runtime = match runtime {
        Ok(runtime) => runtime,
        Err(error) => return format!("cannot create an event queue: {error}"),
    };
    let stopped = async {
        while !link.stopped() {
            tokio::time::sleep(LOOK_EVERY).await;
        }
    };
    let problem = runtime.block_on(async {
        tokio::select! {
            problem = server => problem,
            () = stopped => String::new(),
        }
    });
    runtime.shutdown_background();
    problem
}

/// Parses a message and gives its readings; false when it is none.
pub fn parse(bytes: &[u8], mut give: impl FnMut(Reading)) -> bool {
    let Some((&VERSION, samples)) = bytes.split_first() else {
        return false;
    };
    if bytes.len() > LONGEST || samples.len() % SAMPLE_BYTES != 0 {
        return false;
    }
    for sample in samples.chunks_exact(SAMPLE_BYTES) {
        let (time, values) = sample.split_at(8);
        let mut values = values
            .chunks_exact(4)
            .map(|v| f32::from_le_bytes([v[0], v[1], v[2], v[3]]));
        let mut next = || values.next().unwrap_or(f32::NAN);
        let mut vector = || Vec3::new(next(), next(), next());
        give(Reading {
            time_secs: time.try_into().ok().map(f64::from_le_bytes),
            quantity: Quantity::Both {
                force: vector(),
                rate: vector(),
            },
        });
    }
    true
}
