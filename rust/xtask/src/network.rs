//! `cargo verify godot-network`: a game over a bad network, each of its peers a Godot of its own.
//!
//! A server and two clients, one of whom joins late, and one who lies and floods and leaves. Whatever comes and goes between them takes 200 ms, and one packet in twenty is lost.

mod judge;
mod proxy;

use crate::godot::Engine;
use crate::{demo, engine_run, godot, link, open, paths};
use anyhow::{Context as _, Result};
use proxy::Proxy;
use std::net::UdpSocket;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

/// A machine of the game: its name, when it comes and leaves, seconds, and its further arguments.
struct Peer {
    name: &'static str,
    comes: f32,
    leaves: f32,
    lies: bool,
}

const HOST: Peer = Peer {
    name: "host",
    comes: 0.0,
    leaves: 28.0,
    lies: false,
};

const GUESTS: [Peer; 3] = [
    Peer {
        name: "early",
        comes: 1.0,
        leaves: 26.5,
        lies: false,
    },
    Peer {
        name: "liar",
        comes: 2.0,
        leaves: 14.0,
        lies: true,
    },
    Peer {
        name: "late",
        comes: 7.0,
        leaves: 27.0,
        lies: false,
    },
];

/// Plays the game and judges what every peer has seen.
///
/// # Errors
/// The first thing that was not as it should be.
pub(crate) fn check() -> Result<()> {
    let engine = godot::provision()?;
    link::ensure()?;
    let project = paths::repository_root().join("tests/godot");
    demo::import(&engine, &project, "network")?;
    let port = free_port()?;
    let proxies = (1..)
        .take(GUESTS.len())
        .map(|seed| Proxy::start(port, seed))
        .collect::<Result<Vec<_>>>()?;
    let begin = Instant::now();
    let mut peers = vec![(HOST.name, start(&engine, &HOST, "--host", port)?)];
    for (guest, proxy) in GUESTS.iter().zip(&proxies) {
        peers.push((guest.name, start(&engine, guest, "--join", proxy.port())?));
    }
    let mut said = Vec::new();
    for (name, peer) in peers {
        let ended = peer
            .join()
            .map_err(|_panic| anyhow::anyhow!("{name} ended badly"))?;
        said.push((name, ended.with_context(|| format!("the peer `{name}`"))?));
    }
    drop(proxies);
    let verdict = judge::judge(&said)?;
    eprintln!("{verdict}, in {:.0} s", begin.elapsed().as_secs_f32());
    Ok(())
}

/// Starts a peer as soon as it is to come, on a thread that waits for its end and returns what it has said.
fn start(
    engine: &Engine,
    peer: &Peer,
    flag: &str,
    port: u16,
) -> Result<thread::JoinHandle<Result<String>>> {
    let mut command = open::headless(engine, &paths::repository_root().join("tests/godot"));
    let secs = peer.leaves - peer.comes;
    command.args(["res://net/peer.tscn", "--", flag, &port.to_string()]);
    command.args(["--name", peer.name, "--secs", &secs.to_string()]);
    if peer.lies {
        command.arg("--lies");
    }
    let log: PathBuf = paths::target_folder()
        .join("verify")
        .join(format!("network_{}.log", peer.name));
    let comes = Duration::from_secs_f32(peer.comes);
    thread::Builder::new()
        .name(peer.name.to_owned())
        .spawn(move || {
            thread::sleep(comes);
            engine_run::judged(&mut command, &log)
        })
        .context("cannot start a thread")
}

/// A free port.
fn free_port() -> Result<u16> {
    let socket = UdpSocket::bind(("127.0.0.1", 0)).context("cannot open a port")?;
    let address = socket.local_addr().context("cannot ask for the port")?;
    Ok(address.port())
}
