//! `footfall imu monitor` from the outside, over real ports.

use crate::common::footfall;
use std::fs;
use std::net::UdpSocket;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const PERIOD: Duration = Duration::from_millis(10);

/// Sends lines of a sensor that lies with its z up, at 100 Hz, until it is dropped. What a busy machine has kept it from sending in time, it sends as soon as it can.
struct Sensor {
    stop: Arc<AtomicBool>,
}

impl Sensor {
    #[expect(clippy::disallowed_methods, reason = "a sensor has a clock")]
    fn start(mut send: impl FnMut(&str) + Send + 'static) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let own = Arc::clone(&stop);
        let run = move || {
            let begin = Instant::now();
            for n in 0.. {
                let due = begin + PERIOD * n;
                std::thread::sleep(due.saturating_duration_since(Instant::now()));
                if own.load(Ordering::Relaxed) {
                    break;
                }
                let wave = (f64::from(n) * 0.07).sin();
                send(&format!(
                    "{},{:.4},{:.4},9.8,{:.4},0.1,{:.4}\n",
                    n * 10,
                    0.3 * wave,
                    -0.2 * wave,
                    0.5 * wave,
                    0.4 * wave
                ));
            }
        };
        std::thread::Builder::new()
            .name("sensor".to_owned())
            .spawn(run)
            .expect("a thread");
        Self { stop }
    }
}

impl Drop for Sensor {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// A port that nothing listens at now.
fn free_port() -> u16 {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    socket.local_addr().expect("its address").port()
}

fn udp_sensor(port: u16) -> Sensor {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    Sensor::start(move |line| {
        // Nobody may listen yet.
        drop(socket.send_to(line.as_bytes(), ("127.0.0.1", port)));
    })
}

#[test]
fn what_comes_over_udp_is_watched_and_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    let port = free_port();
    let _sensor = udp_sensor(port);
    let port = port.to_string();
    let arguments = [
        "imu",
        "monitor",
        "--udp",
        &port,
        "--seconds",
        "3",
        "--record",
        "imu.csv",
        "--json",
    ];
    let report = footfall(folder.path(), &arguments).json();
    assert_eq!(report["state"], "receiving");
    let device = &report["devices"][0];
    assert_eq!(device["format"], "text");
    assert_eq!(device["up"], "+z");
    assert_eq!(device["lost"], 0);
    assert!(
        (device["rate_hz"].as_f64().expect("a rate") - 100.0).abs() < 1.0,
        "{device}"
    );
    // The recording is one that every other command takes.
    let text = fs::read_to_string(folder.path().join("imu.csv")).expect("a recording");
    assert!(text.lines().count() > 200, "{}", text.lines().count());
    let inspected = footfall(folder.path(), &["inspect", "imu.csv", "--json"]).json();
    assert!(inspected.to_string().contains("rate"), "{inspected}");
    let leftover = fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(leftover, 1, "only the recording is left");
}

#[cfg(unix)]
#[test]
fn a_serial_port_is_found_out() {
    use serialport::{SerialPort as _, TTYPort};
    use std::io::Write as _;
    let folder = tempfile::tempdir().expect("a folder");
    let (mut device, port) = TTYPort::pair().expect("a pseudo-terminal");
    let name = port.name().expect("its name");
    let _sensor = Sensor::start(move |line| drop(device.write_all(line.as_bytes())));
    let run = footfall(
        folder.path(),
        &["imu", "monitor", "--serial", &name, "--seconds", "3"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout.contains("(text)") && run.stdout.contains("up +z"),
        "{}",
        run.stdout
    );
    assert!(run.stdout.contains("1 devices"), "{}", run.stdout);
}

#[test]
fn wrong_arguments_and_silence_say_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    footfall(folder.path(), &["imu", "monitor"]).fails_with(&["--serial", "--ports"]);
    let arguments = ["imu", "monitor", "--udp", "47999", "--columns", "t,ax,ay"];
    footfall(folder.path(), &arguments).fails_with(&["t,ax,ay", "all six axes"]);
    let wrong = footfall(
        folder.path(),
        &["imu", "monitor", "--serial", "x", "--format", "morse"],
    );
    assert!(
        wrong.code == 2 && wrong.stderr.contains("witmotion"),
        "{}",
        wrong.stderr
    );
    let run = footfall(
        folder.path(),
        &[
            "imu",
            "monitor",
            "--serial",
            "/nowhere/tty",
            "--seconds",
            "0.5",
        ],
    );
    assert!(run.stdout.contains("there is no port"), "{}", run.stdout);
    let ports = footfall(folder.path(), &["imu", "monitor", "--ports", "--json"]).json();
    assert!(ports["ports"].is_array());
}

#[test]
fn a_phone_is_shown_a_code_to_scan() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = [
        "imu",
        "monitor",
        "--phone",
        "--phone-port",
        "0",
        "--seconds",
        "1",
    ];
    let child: Child = Command::new(env!("CARGO_BIN_EXE_footfall"))
        .args(arguments)
        .env("XDG_DATA_HOME", folder.path())
        .env("HOME", folder.path())
        .env("LOCALAPPDATA", folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let output = child.wait_with_output().expect("it ends");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(
        message.contains("https://") && message.contains("/p/") && message.contains('█'),
        "{message}"
    );
}
