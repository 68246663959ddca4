//! A bad network between a client and a server on one machine.

use anyhow::{Context as _, Result};
use std::collections::VecDeque;
use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Delay of every packet, and up to so much more.
const DELAY: Duration = Duration::from_millis(200);
const JITTER_MS: u32 = 10;
/// Of so many packets one is lost.
const LOST_OF: u32 = 20;
/// Time between two looks at the sockets.
const LOOK: Duration = Duration::from_millis(1);

/// A port that passes packets on to a server and back, late, and not all of them. It closes when it is dropped.
pub(super) struct Proxy {
    port: u16,
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Packet on its way.
struct Packet {
    due: Instant,
    to: SocketAddr,
    bytes: Vec<u8>,
}

/// One direction.
struct Direction {
    socket: UdpSocket,
    waiting: VecDeque<Packet>,
}

impl Proxy {
    /// Opens one in front of the server at this port of this machine; its chance is seeded.
    ///
    /// # Errors
    /// When there are no sockets.
    pub(super) fn start(server: u16, seed: u32) -> Result<Self> {
        let open = || -> Result<UdpSocket> {
            let socket = UdpSocket::bind(("127.0.0.1", 0)).context("cannot open a port")?;
            socket
                .set_nonblocking(true)
                .context("cannot set up a port")?;
            Ok(socket)
        };
        let (front, back) = (open()?, open()?);
        let port = front
            .local_addr()
            .context("cannot ask for the port")?
            .port();
        let over = Arc::new(AtomicBool::new(false));
        let ends = Arc::clone(&over);
        let thread = thread::Builder::new()
            .name("proxy".to_owned())
            .spawn(move || pass_on(front, back, server, seed, &ends))
            .context("cannot start a thread")?;
        Ok(Self {
            port,
            over,
            thread: Some(thread),
        })
    }

    /// The port that clients join at.
    pub(super) fn port(&self) -> u16 {
        self.port
    }
}

impl Drop for Proxy {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

fn pass_on(front: UdpSocket, back: UdpSocket, server: u16, seed: u32, over: &AtomicBool) {
    let server = SocketAddr::from(([127, 0, 0, 1], server));
    let mut client = None;
    let mut chance = seed;
    let mut directions = [front, back].map(|socket| Direction {
        socket,
        waiting: VecDeque::new(),
    });
    let mut bytes = [0; 4096];
    while !over.load(Ordering::Relaxed) {
        for from in 0..2 {
            loop {
                let (length, sender) = match directions[from].socket.recv_from(&mut bytes) {
                    Ok(received) => received,
                    // A server that has gone answers so.
                    Err(error) if error.kind() == ErrorKind::ConnectionRefused => continue,
                    Err(_) => break,
                };
                if from == 0 {
                    client = Some(sender);
                }
                let to = if from == 0 { Some(server) } else { client };
                chance = chance.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let drawn = chance >> 8;
                let Some(to) = to.filter(|_| !drawn.is_multiple_of(LOST_OF)) else {
                    continue;
                };
                let late = Duration::from_millis((drawn / LOST_OF % JITTER_MS).into());
                directions[1 - from].waiting.push_back(Packet {
                    due: Instant::now() + DELAY + late,
                    to,
                    bytes: bytes[..length].to_vec(),
                });
            }
        }
        for direction in &mut directions {
            while direction
                .waiting
                .front()
                .is_some_and(|next| next.due <= Instant::now())
            {
                if let Some(packet) = direction.waiting.pop_front() {
                    direction.socket.send_to(&packet.bytes, packet.to).ok();
                }
            }
        }
        thread::sleep(LOOK);
    }
}
