//! Datagrams, posts and WebSockets over the machine's own loopback.

use crate::encode;
use crate::signal::{check_same, sample, samples, wait_for, wait_for_address, wait_for_samples};
use footfall_imu::live::network::udp::{self, UdpConfig};
use footfall_imu::live::network::{http, websocket};
use footfall_imu::live::{Link, LinkState};
use footfall_imu::{GRAVITY_MPS2, ImuSample};
use glam::Vec3;
use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType};
use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::time::{Duration, Instant};

fn udp_link() -> (Link, SocketAddr) {
    let link = udp::listen(UdpConfig {
        port: 0,
        ..UdpConfig::default()
    });
    let address = wait_for_address(&link);
    (link, address)
}

fn socket(to: SocketAddr) -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.connect(to).unwrap();
    socket
        .set_read_timeout(Some(Duration::from_secs(5)))
        .unwrap();
    socket
}

fn osc(address: &str, vector: Vec3) -> OscPacket {
    OscPacket::Message(OscMessage {
        addr: address.to_owned(),
        args: vector.to_array().map(OscType::Float).to_vec(),
    })
}

fn bundle(packets: Vec<OscPacket>) -> Vec<u8> {
    let bundle = OscBundle {
        timetag: OscTime {
            seconds: 0,
            fractional: 1,
        },
        content: packets,
    };
    rosc::encoder::encode(&OscPacket::Bundle(bundle)).unwrap()
}

/// The datagrams of a sample.
type Packets = Box<dyn Fn(&ImuSample) -> Vec<Vec<u8>>>;

/// Every form of a datagram: its name, and what is sent for a sample.
fn forms() -> Vec<(&'static str, Packets)> {
    let up = Vec3::Y * GRAVITY_MPS2;
    // iOS: what pushes the other way, in g.
    let apple = move |force: Vec3| -force / GRAVITY_MPS2;
    vec![
        ("text", Box::new(|s: &ImuSample| vec![encode::line(s)])),
        (
            "json",
            Box::new(|s: &ImuSample| {
                let force = encode::android("accelerometer", s.time_secs, s.force.to_array());
                vec![
                    force,
                    encode::android("gyroscope", s.time_secs, s.rate.to_array()),
                ]
            }),
        ),
        (
            "json",
            Box::new(|s: &ImuSample| vec![encode::zig_sim_json(s)]),
        ),
        (
            "osc",
            Box::new(move |s: &ImuSample| {
                let packets = vec![
                    osc("/a1b2/gravity", apple(up)),
                    osc("/a1b2/accel", apple(s.force - up)),
                    osc("/a1b2/gyro", s.rate),
                ];
                vec![bundle(packets)]
            }),
        ),
        (
            "osc",
            Box::new(move |s: &ImuSample| {
                let packets = vec![
                    osc("/gyrosc/grav", apple(up)),
                    osc("/gyrosc/gyro", Vec3::ONE),
                    osc("/gyrosc/accel", apple(s.force - up)),
                    osc("/gyrosc/rrate", s.rate),
                ];
                vec![bundle(packets)]
            }),
        ),
    ]
}

#[test]
fn every_form_of_a_datagram_is_known_at_one_port() {
    let (link, address) = udp_link();
    let sent = samples(150);
    for (place, (format, encode)) in forms().into_iter().enumerate() {
        let socket = socket(address);
        for sample in &sent {
            for packet in encode(sample) {
                socket.send(&packet).unwrap();
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let device = wait_for(format, || link.device(place));
        assert_eq!(device.status().format, format);
        // Forces may wait for the next rate.
        let found = wait_for_samples(&device, sent.len() - 2);
        for (found, sent) in found.iter().zip(&sent) {
            check_same(found, sent, 1e-4);
        }
    }
    assert_eq!(link.garbage(), 0);
    assert_eq!(link.state(), LinkState::Receiving);
}

#[test]
fn an_owotrack_phone_is_greeted_and_heard() {
    let (link, address) = udp_link();
    let socket = socket(address);
    let mut hello = encode::slimevr(3, 0, &[0; 32]);
    hello.extend(b"\x09owoTrack8\x01\x02\x03\x04\x05\x06\xFF");
    socket.send(&hello).unwrap();
    let mut reply = [0; 64];
    let length = socket.recv(&mut reply).unwrap();
    assert_eq!(&reply[..length], b"\x03Hey OVR =D 5");
    // Turning about its own x, which is level, while up is along its y: by the clock, for a busy machine sleeps longer.
    let begun = Instant::now();
    for n in 0_u64..150 {
        let angle = 2.0 * begun.elapsed().as_secs_f32();
        let turn = glam::Quat::from_rotation_x(std::f32::consts::FRAC_PI_2 + angle);
        socket
            .send(&encode::slimevr(
                1,
                3 * n,
                &encode::floats(&turn.to_array()),
            ))
            .unwrap();
        socket
            .send(&encode::slimevr(
                4,
                3 * n + 2,
                &encode::floats(&[0.5, 0.0, 0.0]),
            ))
            .unwrap();
        std::thread::sleep(Duration::from_millis(10));
    }
    let device = wait_for("the phone", || link.device(0));
    assert_eq!(device.status().format, "slimevr");
    let found = wait_for_samples(&device, 140);
    // Two radians a second, once the period of what comes is known.
    let known = &found[100..];
    let mean = known.iter().map(|sample| sample.rate.x).sum::<f32>() / known.len() as f32;
    assert!((mean - 2.0).abs() < 0.3, "{mean} rad/s");
    for sample in known {
        assert!(
            (sample.force.length() - GRAVITY_MPS2.hypot(0.5)).abs() < 0.01,
            "{sample:?}"
        );
    }
    // The listener announces itself every second.
    let length = socket.recv(&mut reply).unwrap();
    assert_eq!(&reply[..length], [0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn a_tracker_with_two_sensors_is_two_devices() {
    let (link, address) = udp_link();
    let socket = socket(address);
    let part = |kind: u32, content: &[u8]| {
        let inner = [&kind.to_be_bytes(), content].concat();
        [(inner.len() as u16).to_be_bytes().as_slice(), &inner].concat()
    };
    for n in 0..60 {
        let turn = encode::floats(&[0.0, 0.0, 0.0, 1.0]);
        let mut content = Vec::new();
        for sensor in [0, 1] {
            content.extend(part(17, &[&[sensor, 1], turn.as_slice(), &[0]].concat()));
            content.extend(part(4, &[encode::floats(&[0.0; 3]), vec![sensor]].concat()));
        }
        socket.send(&encode::slimevr(100, n, &content)).unwrap();
        std::thread::sleep(Duration::from_millis(5));
    }
    for place in [0, 1] {
        let device = wait_for("both sensors", || link.device(place));
        assert!(!wait_for_samples(&device, 40).is_empty());
    }
    assert_eq!(link.devices().len(), 2);
}

#[test]
fn eight_phones_at_once_lose_nothing() {
    let (link, address) = udp_link();
    let sockets: Vec<UdpSocket> = (0..8).map(|_| socket(address)).collect();
    let sent = samples(300);
    for sample in &sent {
        for socket in &sockets {
            socket.send(&encode::line(sample)).unwrap();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    for place in 0..8 {
        let device = wait_for("a phone", || link.device(place));
        let found = wait_for_samples(&device, sent.len());
        assert_eq!(found.len(), sent.len());
        let status = device.status();
        assert_eq!((status.lost, status.rejected), (0, 0));
        assert!((status.rate_hz - 100.0).abs() < 1.0);
    }
}

#[test]
fn garbage_strangers_and_a_taken_port_are_told() {
    let (link, address) = udp_link();
    let socket = socket(address);
    for packet in [
        b"".as_slice(),
        b"\xFF\xFE",
        b"{\"a\":",
        b"/x",
        &[7; 4000],
        &[7; 5000],
    ] {
        socket.send(packet).unwrap();
    }
    wait_for("the garbage is counted", || {
        (link.garbage() >= 5).then_some(())
    });
    assert!(link.devices().is_empty());
    let second = udp::listen(UdpConfig {
        port: address.port(),
        ..UdpConfig::default()
    });
    let problem = wait_for("the port is taken", || match second.state() {
        LinkState::Failed(problem) => Some(problem),
        _ => None,
    });
    assert!(
        problem.contains("taken") && problem.contains("another port"),
        "{problem}"
    );
    // Too many senders: the first sixteen stay.
    let sockets: Vec<UdpSocket> = (0..20).map(|_| self::socket(address)).collect();
    for n in 0..60 {
        for socket in &sockets {
            socket
                .send(&encode::line(&sample(f64::from(n) * 0.01)))
                .unwrap();
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    wait_for("devices", || (link.devices().len() == 16).then_some(()));
    let device = link.device(0).unwrap();
    assert!(wait_for_samples(&device, 55).len() <= 60);
}

fn post(address: SocketAddr, body: &[u8]) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    let head = format!(
        "POST /data HTTP/1.1\r\nHost: game\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
        body.len()
    );
    // A server that refuses a body does not read it all.
    drop(
        stream
            .write_all(head.as_bytes())
            .and_then(|()| stream.write_all(body)),
    );
    let mut reply = Vec::new();
    drop(stream.read_to_end(&mut reply));
    String::from_utf8_lossy(&reply).into_owned()
}

#[test]
fn sensor_loggers_batches_become_samples() {
    let link = http::listen(0);
    let address = wait_for_address(&link);
    let sent = samples(200);
    for part in sent.chunks(20) {
        let reply = post(address, &encode::sensor_logger(part));
        assert!(reply.starts_with("HTTP/1.1 200"), "{reply}");
    }
    let device = wait_for("the phone", || link.device(0));
    assert!(device.status().name.contains("pixel"));
    let found = wait_for_samples(&device, sent.len());
    for (found, sent) in found.iter().zip(&sent) {
        check_same(found, sent, 1e-3);
    }
    assert!(post(address, b"{").starts_with("HTTP/1.1 400"));
    let flood = post(address, &vec![b' '; 600 * 1024]);
    assert!(
        flood.starts_with("HTTP/1.1 413") || flood.is_empty(),
        "{flood}"
    );
    assert_eq!(device.status().lost, 0);
}

#[test]
fn a_sensorserver_is_followed_and_found_again() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let serve = move || {
        for round in 0..2 {
            let (stream, _) = listener.accept().unwrap();
            let mut asked = String::new();
            let mut socket = tungstenite::accept_hdr(
                stream,
                |request: &tungstenite::handshake::server::Request, reply| {
                    asked = request.uri().to_string();
                    Ok(reply)
                },
            )
            .unwrap();
            assert!(asked.starts_with("/sensors/connect?types="), "{asked}");
            for sample in samples(100) {
                for (kind, vector) in [("accelerometer", sample.force), ("gyroscope", sample.rate)]
                {
                    let text = encode::android(
                        kind,
                        60.0 * f64::from(round) + sample.time_secs,
                        vector.to_array(),
                    );
                    let text = String::from_utf8(text).unwrap();
                    socket
                        .send(tungstenite::Message::Text(text.into()))
                        .unwrap();
                }
                std::thread::sleep(Duration::from_millis(2));
            }
        }
    };
    let phone = std::thread::Builder::new()
        .name("phone".to_owned())
        .spawn(serve)
        .unwrap();
    let link = websocket::follow(&format!("ws://{address}"));
    let device = wait_for("the phone", || link.device(0));
    let found = wait_for_samples(&device, 98);
    assert!(found.iter().all(|sample| sample.force.length() > 5.0));
    // The phone hangs up and is followed again.
    assert!(!wait_for_samples(&device, 90).is_empty());
    phone.join().unwrap();
    assert_eq!(link.devices().len(), 1);

    let stranger = websocket::follow("192.0.2.1:8080");
    let problem = wait_for("the stranger is refused", || match stranger.state() {
        LinkState::Failed(problem) => Some(problem),
        _ => None,
    });
    assert!(problem.contains("not on the local network"), "{problem}");
}
