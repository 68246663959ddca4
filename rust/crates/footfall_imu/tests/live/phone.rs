//! The page for phones, over real TLS.

use crate::encode;
use crate::signal::{check_same, sample, samples, wait_for, wait_for_address, wait_for_samples};
use footfall_imu::live::phone::{PhoneConfig, PhoneServer, qr_code};
use footfall_imu::live::{Device, LinkState};
use rustls::pki_types::pem::PemObject as _;
use rustls::pki_types::{CertificateDer, ServerName};
use rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};
use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tungstenite::{Message, WebSocket};

type Tls = StreamOwned<ClientConnection, TcpStream>;

struct Game {
    server: PhoneServer,
    address: SocketAddr,
    folder: tempfile::TempDir,
}

impl Game {
    fn start(players: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let server = PhoneServer::start(PhoneConfig {
            port: 0,
            players,
            folder: folder.path().join("kept"),
        })
        .unwrap();
        let address = wait_for_address(server.link());
        Self {
            server,
            address,
            folder,
        }
    }

    /// A connection of someone who has accepted the certificate.
    fn connect(&self) -> Tls {
        let certificate = self.folder.path().join("kept/certificate.pem");
        let mut roots = RootCertStore::empty();
        roots
            .add(CertificateDer::from_pem_file(certificate).unwrap())
            .unwrap();
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let config = ClientConfig::builder_with_provider(provider)
            .with_safe_default_protocol_versions()
            .unwrap()
            .with_root_certificates(roots)
            .with_no_client_auth();
        let name = ServerName::try_from("localhost").unwrap();
        let connection = ClientConnection::new(Arc::new(config), name).unwrap();
        let stream = TcpStream::connect(self.address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(10)))
            .unwrap();
        StreamOwned::new(connection, stream)
    }

    fn path(&self, player: usize) -> String {
        let url = self.server.url(player).unwrap();
        url[url.find("/p/").unwrap()..].to_owned()
    }

    fn ask(&self, method: &str, path: &str, body: &[u8]) -> String {
        let mut stream = self.connect();
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
            body.len()
        );
        stream.write_all(head.as_bytes()).unwrap();
        drop(stream.write_all(body));
        let mut reply = Vec::new();
        drop(stream.read_to_end(&mut reply));
        String::from_utf8_lossy(&reply).into_owned()
    }

    fn open(&self, player: usize, page: &str) -> WebSocket<Tls> {
        let url = format!("wss://localhost{}/live/{page}", self.path(player));
        tungstenite::client::client(url, self.connect()).unwrap().0
    }

    fn device(&self, player: usize) -> Device {
        wait_for("the player's device", || self.server.link().device(player))
    }
}

/// The next text that holds these words.
fn wait_for_message(socket: &mut WebSocket<Tls>, words: &str) -> String {
    wait_for(words, || match socket.read() {
        Ok(Message::Text(text)) if text.contains(words) => Some(text.to_string()),
        _ => None,
    })
}

#[test]
fn a_page_streams_and_is_told_of_its_state() {
    let game = Game::start(1);
    let mut socket = game.open(0, "a");
    let sent = samples(300);
    for part in sent.chunks(4) {
        socket
            .send(Message::Binary(encode::browser(part).into()))
            .unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
    let device = game.device(0);
    let found = wait_for_samples(&device, sent.len());
    for (found, sent) in found.iter().zip(&sent) {
        check_same(found, sent, 1e-6);
    }
    assert_eq!(game.server.link().state(), LinkState::Receiving);
    let state = wait_for_message(&mut socket, "rate");
    assert!(
        state.contains("\"lost\":0") && state.contains("\"fault\":null"),
        "{state}"
    );
    game.server.vibrate(0);
    wait_for_message(&mut socket, "vibrate");
}

#[test]
fn a_page_that_may_not_open_a_websocket_posts() {
    let game = Game::start(1);
    let path = format!("{}/samples/b", game.path(0));
    let sent = samples(100);
    for part in sent.chunks(10) {
        let reply = game.ask("POST", &path, &encode::browser(part));
        assert!(
            reply.starts_with("HTTP/1.1 200") && reply.contains("\"rate\""),
            "{reply}"
        );
    }
    assert_eq!(wait_for_samples(&game.device(0), 100).len(), 100);
    for broken in [b"".as_slice(), b"\x02", b"\x01\x00\x00"] {
        let reply = game.ask("POST", &path, broken);
        assert!(reply.starts_with("HTTP/1.1 409"), "{reply}");
    }
    let reply = game.ask("POST", &path, &vec![1; 100_000]);
    assert!(
        reply.starts_with("HTTP/1.1 413") || reply.is_empty(),
        "{reply}"
    );
}

#[test]
fn strangers_stay_out_and_one_phone_drives_one_player() {
    let game = Game::start(2);
    let page = game.ask("GET", &game.path(0), b"");
    assert!(
        page.starts_with("HTTP/1.1 200") && page.contains("content-security-policy"),
        "{page:.400}"
    );
    assert!(page.contains("This phone is your sensor"));
    assert_ne!(game.path(0), game.path(1));
    for path in ["/p/guess", "/p/", "/p/guess/live/a", "/p/guess/samples/a"] {
        let reply = game.ask("GET", path, b"");
        assert!(reply.starts_with("HTTP/1.1 403"), "{path}: {reply}");
    }
    assert!(game.ask("GET", "/", b"").starts_with("HTTP/1.1 404"));
    assert!(game.server.url(2).is_none());

    let message = |n: u32| Message::Binary(encode::browser(&[sample(f64::from(n) * 0.01)]).into());
    let (mut first, mut second) = (game.open(0, "first"), game.open(0, "second"));
    first.send(message(1)).unwrap();
    wait_for("the first phone", || {
        (game.device(0).status().samples == 1).then_some(())
    });
    second.send(message(2)).unwrap();
    wait_for_message(&mut second, "Another phone");
    // The other player's code is free.
    let mut third = game.open(1, "third");
    third.send(message(1)).unwrap();
    wait_for("the second player", || {
        (game.device(1).status().samples == 1).then_some(())
    });
    assert_eq!(game.device(0).status().samples, 1);
    // The page of the first is loaded again after a while: it drives on.
    drop(first);
    std::thread::sleep(Duration::from_millis(3200));
    let mut again = game.open(0, "again");
    again.send(message(3)).unwrap();
    wait_for("the page that came again", || {
        (game.device(0).status().samples == 2).then_some(())
    });
}

#[test]
fn eight_phones_drive_eight_players() {
    let game = Game::start(8);
    let mut sockets: Vec<WebSocket<Tls>> = (0..8).map(|player| game.open(player, "x")).collect();
    let sent = samples(200);
    for sample in &sent {
        for socket in &mut sockets {
            socket
                .send(Message::Binary(
                    encode::browser(core::slice::from_ref(sample)).into(),
                ))
                .unwrap();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    for player in 0..8 {
        let device = game.device(player);
        assert_eq!(wait_for_samples(&device, sent.len()).len(), sent.len());
        let status = device.status();
        assert_eq!((status.lost, status.rejected), (0, 0), "player {player}");
    }
}

#[test]
fn the_certificate_is_made_once_and_kept_to_the_user() {
    let game = Game::start(1);
    let kept = game.folder.path().join("kept");
    let read = |folder: &Path| std::fs::read_to_string(folder.join("certificate.pem")).unwrap();
    let first = read(&kept);
    let again = PhoneServer::start(PhoneConfig {
        port: 0,
        players: 1,
        folder: kept.clone(),
    })
    .unwrap();
    wait_for_address(again.link());
    assert_eq!(read(&kept), first);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let mode = std::fs::metadata(kept.join("key.pem"))
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o600);
    }
    // Broken files are reported, with what to do.
    std::fs::write(kept.join("key.pem"), "nothing").unwrap();
    let broken = PhoneServer::start(PhoneConfig {
        port: 0,
        players: 1,
        folder: kept,
    })
    .unwrap();
    let problem = wait_for("the problem", || match broken.link().state() {
        LinkState::Failed(problem) => Some(problem),
        _ => None,
    });
    assert!(problem.contains("delete the folder"), "{problem}");
}

#[test]
fn an_address_becomes_a_code_to_scan() {
    let game = Game::start(1);
    let (width, modules) = qr_code(&game.server.url(0).unwrap()).unwrap();
    assert_eq!(modules.len(), width * width);
    // The three corners' marks.
    assert!(modules[0] && modules[width - 1] && modules[width * (width - 1)]);
    assert!(qr_code(&"x".repeat(5000)).is_none());
}
