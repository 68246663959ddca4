//! A serial port made of a pseudo-terminal.

use crate::encode;
use crate::signal::{check_same, sample, samples, wait_for, wait_for_samples};
use footfall_imu::ImuSample;
use footfall_imu::live::LinkState;
use footfall_imu::live::device::now_secs;
use footfall_imu::live::serial::SerialFormat;
use footfall_imu::live::serial::port::{SerialConfig, listen};
use serialport::{SerialPort as _, TTYPort};
use std::io::{Read as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The device's end, and the name of the other.
fn terminal() -> (TTYPort, String) {
    let (device, port) = TTYPort::pair().expect("a pseudo-terminal");
    let name = port.name().expect("its name");
    (device, name)
}

/// Sends at 200 Hz until it is stopped.
struct Sender {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<u32>,
}

impl Sender {
    fn start(mut device: TTYPort, encode: impl Fn(&ImuSample) -> Vec<u8> + Send + 'static) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let own = Arc::clone(&stop);
        let send = move || {
            let mut sent = 0;
            while !own.load(Ordering::Relaxed) {
                // The port may not be open yet, or not any more.
                if device
                    .write_all(&encode(&sample(f64::from(sent) * 0.005)))
                    .is_ok()
                {
                    sent += 1;
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            sent
        };
        let thread = std::thread::Builder::new()
            .name("device".to_owned())
            .spawn(send)
            .unwrap();
        Self { stop, thread }
    }

    fn stop(self) -> u32 {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join().unwrap()
    }
}

#[test]
fn what_speaks_at_a_port_is_found_out_and_heard() {
    let (device, name) = terminal();
    let sender = Sender::start(device, encode::witmotion);
    let link = listen(SerialConfig {
        port: name.clone(),
        ..SerialConfig::default()
    });
    let device = wait_for("the device is found", || link.device(0));
    let found = wait_for_samples(&device, 300);
    let status = device.status();
    assert_eq!(status.format, "witmotion");
    assert_eq!(status.name, name);
    assert_eq!(link.state(), LinkState::Receiving);
    assert!(
        (80.0..205.0).contains(&status.rate_hz),
        "{} Hz",
        status.rate_hz
    );
    assert!(
        found
            .windows(2)
            .all(|pair| pair[1].time_secs > pair[0].time_secs)
    );
    assert!(found.iter().all(|sample| sample.force.length() > 5.0));
    drop(link);
    sender.stop();
}

#[test]
fn nothing_is_lost_on_the_way() {
    let (mut device, name) = terminal();
    let link = listen(SerialConfig {
        port: name,
        baud_rate: Some(921_600),
        format: Some(SerialFormat::Mti),
        ..SerialConfig::default()
    });
    let heard = wait_for("the port is open", || link.device(0));
    // Fewer than may wait for the game.
    let sent = samples(4000);
    for part in sent.chunks(50) {
        let bytes: Vec<u8> = part
            .iter()
            .flat_map(|s| encode::mti(s, encode::MtiNumbers::Float))
            .collect();
        device.write_all(&bytes).unwrap();
    }
    let found = wait_for_samples(&heard, sent.len());
    for (found, sent) in found.iter().zip(&sent) {
        check_same(found, sent, 1e-5);
    }
    let status = heard.status();
    assert_eq!((status.lost, status.rejected, status.overflowed), (0, 0, 0));
}

#[test]
fn a_threespace_is_told_to_stream() {
    let (mut device, name) = terminal();
    device.set_timeout(Duration::from_secs(5)).unwrap();
    let link = listen(SerialConfig {
        port: name,
        baud_rate: Some(115_200),
        format: Some(SerialFormat::ThreeSpace),
        ..SerialConfig::default()
    });
    let heard = wait_for("the port is open", || link.device(0));
    let mut commands = [0; 7 + 11 + 15 + 3];
    device.read_exact(&mut commands).unwrap();
    assert_eq!(commands[commands.len() - 3..], [0xF9, 0x55, 0x55]);
    let bytes: Vec<u8> = samples(100).iter().flat_map(encode::threespace).collect();
    device.write_all(&bytes).unwrap();
    assert_eq!(wait_for_samples(&heard, 100).len(), 100);
}

#[test]
fn a_sensor_without_rates_says_so() {
    let (device, name) = terminal();
    let sender = Sender::start(device, encode::bno085);
    let link = listen(SerialConfig {
        port: name,
        ..SerialConfig::default()
    });
    let device = wait_for("the device is found", || link.device(0));
    let fault = wait_for("its fault is reported", || device.status().fault);
    assert!(fault.contains("BNO085"), "{fault}");
    drop(link);
    sender.stop();
}

#[test]
fn a_port_that_is_not_there_is_named_and_tried_again() {
    let folder = tempfile::tempdir().unwrap();
    let port = folder.path().join("tty");
    let link = listen(SerialConfig {
        port: port.display().to_string(),
        ..SerialConfig::default()
    });
    let problem = wait_for("the state", || match link.state() {
        LinkState::Failed(problem) => Some(problem),
        _ => None,
    });
    assert!(problem.contains("there is no port"), "{problem}");
    // It is plugged in.
    let (device, name) = terminal();
    std::os::unix::fs::symlink(name, &port).unwrap();
    let sender = Sender::start(device, encode::line);
    let heard = wait_for("the device is found", || link.device(0));
    assert!(!wait_for_samples(&heard, 50).is_empty());
    sender.stop();
    // It is pulled out, and another is plugged in: the same device goes on.
    wait_for("the loss is reported", || {
        matches!(link.state(), LinkState::Failed(_)).then_some(())
    });
    std::fs::remove_file(&port).unwrap();
    let (device, name) = terminal();
    std::os::unix::fs::symlink(name, &port).unwrap();
    let sender = Sender::start(device, encode::line);
    heard.take(|_| {});
    assert!(!wait_for_samples(&heard, 50).is_empty());
    assert_eq!(link.devices().len(), 1);
    drop(link);
    sender.stop();
}

/// Memory of this process, bytes; `None` where the system does not report it.
fn memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = text.split_whitespace().nth(1)?.parse().ok()?;
    Some(pages * 4096)
}

/// Five seconds, or as many as `FOOTFALL_SOAK_SECS` says: an hour shows what grows or drifts.
#[test]
fn a_long_session_neither_loses_drifts_nor_grows() {
    const RATE_HZ: f64 = 200.0;
    let secs = std::env::var("FOOTFALL_SOAK_SECS")
        .ok()
        .and_then(|secs| secs.parse().ok());
    let secs: f64 = secs.unwrap_or(5.0);
    let (mut terminal, name) = terminal();
    let link = listen(SerialConfig {
        port: name,
        baud_rate: Some(921_600),
        format: Some(SerialFormat::XImu3),
        ..SerialConfig::default()
    });
    let heard = wait_for("the port is open", || link.device(0));
    let begin = Instant::now();
    let count = (secs * RATE_HZ) as u32;
    let (mut taken, mut late, mut before) = (0_u32, 0.0_f64, None);
    for n in 0..count {
        let time_secs = f64::from(n) / RATE_HZ;
        // The device's clock is fast by 50 parts in a million.
        terminal
            .write_all(&encode::ximu3_binary(&sample(time_secs * (1.0 + 50e-6))))
            .unwrap();
        let due = Duration::from_secs_f64(time_secs);
        if let Some(wait) = due.checked_sub(begin.elapsed()) {
            std::thread::sleep(wait);
        }
        let now = now_secs();
        heard.take(|sample| {
            taken += 1;
            if taken > 400 {
                late = late.max((now - sample.time_secs).abs());
            }
        });
        if n == count / 2 {
            before = memory();
        }
    }
    wait_for("the last sample", || {
        heard.take(|_| taken += 1);
        (taken == count).then_some(())
    });
    let status = heard.status();
    assert_eq!(
        (
            status.lost,
            status.rejected,
            status.overflowed,
            link.garbage()
        ),
        (0, 0, 0, 0)
    );
    // Times stay those of our clock, give or take what the system makes a thread wait.
    assert!(late < 0.25, "a sample was {late} s off");
    if let (Some(before), Some(after)) = (before, memory()) {
        assert!(
            after < before + 4_000_000,
            "memory grew from {before} to {after} bytes"
        );
    }
}
