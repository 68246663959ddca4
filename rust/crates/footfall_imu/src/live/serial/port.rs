//! A serial port: opened, listened to, opened again after it was unplugged.

use super::detect::Detection;
use super::{SerialFormat, StreamParser, TextFormat, threespace};
use crate::live::device::{DeviceWriter, now_secs};
use crate::live::link::{Link, LinkState, LinkWriter};
use serialport::{ErrorKind, SerialPort, SerialPortType};
use std::io::{self, Read as _, Write as _};
use std::time::Duration;

/// Rates that devices use, most common first.
pub const BAUD_RATES: [u32; 6] = [115_200, 921_600, 460_800, 230_400, 57_600, 9600];

/// Timeout of a read.
const READ_TIMEOUT: Duration = Duration::from_millis(20);

/// Time for which each rate is listened to when the device is unknown.
const LISTEN_SECS: f64 = 0.8;

/// Time after which a port that cannot be opened is tried again.
const RETRY: Duration = Duration::from_secs(1);

/// Time without a message after which the format is detected again, seconds.
const LOST_SECS: f64 = 3.0;

/// A serial port, and what is known of the device there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SerialConfig {
    /// Path or name of the port; empty for the first one on USB.
    pub port: String,
    /// Bits a second; `None` to find out.
    pub baud_rate: Option<u32>,
    /// Protocol of the device; `None` to find out.
    pub format: Option<SerialFormat>,
    /// Meaning of lines of numbers.
    pub text: TextFormat,
}

/// A port that there is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortInfo {
    /// Name by which it is opened.
    pub name: String,
    /// Description of the device there; empty when the system knows none.
    pub description: String,
    /// True for a port on USB.
    pub is_usb: bool,
}

/// The ports of this machine, those on USB first.
pub fn ports() -> Vec<PortInfo> {
    let found = serialport::available_ports().unwrap_or_default();
    let mut ports: Vec<PortInfo> = found
        .into_iter()
        .map(|port| {
            let (is_usb, description) = match port.port_type {
                SerialPortType::UsbPort(usb) => {
                    let parts = [usb.manufacturer, usb.product];
                    (
                        true,
                        parts.into_iter().flatten().collect::<Vec<_>>().join(" "),
                    )
                }
                _ => (false, String::new()),
            };
            PortInfo {
                name: port.port_name,
                description,
                is_usb,
            }
        })
        .collect();
    ports.sort_by(|a, b| (!a.is_usb, &a.name).cmp(&(!b.is_usb, &b.name)));
    ports
}

/// Listens at a port until the link is dropped.
pub fn listen(config: SerialConfig) -> Link {
    let mut device = None;
    Link::keep("serial", RETRY, move |link| match open(&config) {
        Ok((name, port)) => {
            let mut opened = OpenPort {
                link,
                config: &config,
                name,
                port,
            };
            opened.run(&mut device)
        }
        Err(problem) => problem,
    })
}

/// Opens the port. An error is the text for a person.
fn open(config: &SerialConfig) -> Result<(String, Box<dyn SerialPort>), String> {
    let name = if config.port.is_empty() {
        let usb = ports().into_iter().find(|port| port.is_usb);
        usb.ok_or("no serial port on USB; plug in a sensor")?.name
    } else {
        config.port.clone()
    };
    let baud_rate = config.baud_rate.unwrap_or(BAUD_RATES[0]);
    let port = serialport::new(name.as_str(), baud_rate)
        .timeout(READ_TIMEOUT)
        .open();
    port.map(|port| (name.clone(), port)).map_err(|error| match error.kind() {
        ErrorKind::NoDevice | ErrorKind::Io(io::ErrorKind::NotFound) => {
            format!("there is no port {name}; plug in the sensor, or choose another port")
        }
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => {
            format!("this user may not open {name}; on Linux, add the user to the group 'dialout' and log in again")
        }
        _ => format!("{name}: {error}; another program may use it"),
    })
}

/// An open port.
struct OpenPort<'a> {
    link: &'a LinkWriter,
    config: &'a SerialConfig,
    name: String,
    port: Box<dyn SerialPort>,
}

impl OpenPort<'_> {
    /// Listens until the port is gone, the protocol changes, or it is time to stop. Returns why.
    fn run(&mut self, device: &mut Option<DeviceWriter>) -> String {
        let format = match self.find_out() {
            Ok(format) => format,
            Err(problem) => return problem,
        };
        if format == SerialFormat::ThreeSpace {
            // A device that streams already ignores it.
            for command in threespace::SETUP {
                drop(self.port.write_all(command));
            }
        }
        let known = device
            .as_ref()
            .is_some_and(|device| device.device().status().format == format.name());
        if known {
            self.link.set_state(LinkState::Receiving);
        } else {
            *device = self.link.add(&self.name, format.name());
        }
        let Some(device) = device else {
            return format!("{}: too many kinds of devices at this port", self.name);
        };
        if let Some(caveat) = format.caveat() {
            device.set_fault(caveat);
        }
        let mut parser = StreamParser::new(format, &self.config.text);
        let mut heard_secs = now_secs();
        let mut buffer = [0; 1024];
        while !self.link.stopped() {
            let count = match self.read(&mut buffer) {
                Ok(count) => count,
                Err(problem) => return problem,
            };
            let now = now_secs();
            let before = (parser.messages(), parser.garbage_bytes());
            parser.push(&buffer[..count], |reading| device.push(reading, now));
            self.link.count_garbage(parser.garbage_bytes() - before.1);
            if parser.messages() > before.0 {
                heard_secs = now;
                device.heard(now);
            } else if now - heard_secs > LOST_SECS {
                return format!("{}: no readable data any more", self.name);
            }
        }
        String::new()
    }

    /// Finds the protocol and the rate.
    fn find_out(&mut self) -> Result<SerialFormat, String> {
        if let (Some(format), Some(_)) = (self.config.format, self.config.baud_rate) {
            return Ok(format);
        }
        let rates = self
            .config
            .baud_rate
            .map_or(BAUD_RATES.to_vec(), |rate| vec![rate]);
        let mut bytes = 0;
        for rate in rates {
            let state = format!("{}: listening at {rate} baud", self.name);
            self.link.set_state(LinkState::Opening(state));
            self.port
                .set_baud_rate(rate)
                .map_err(|error| format!("{}: {error}", self.name))?;
            if self.config.format == Some(SerialFormat::ThreeSpace) {
                for command in threespace::SETUP {
                    drop(self.port.write_all(command));
                }
            }
            let mut detection = Detection::new(&self.config.text);
            let begin = now_secs();
            let mut buffer = [0; 1024];
            while now_secs() - begin < LISTEN_SECS && !self.link.stopped() {
                let count = self.read(&mut buffer)?;
                detection.push(&buffer[..count]);
            }
            bytes += detection.bytes();
            if let Some(found) = detection.found()
                && self.config.format.is_none_or(|format| format == found)
            {
                return Ok(found);
            }
        }
        Err(if bytes == 0 {
            format!(
                "{}: no data; check that the sensor is on and streams",
                self.name
            )
        } else {
            format!(
                "{}: {bytes} bytes in no known format at any baud rate; set the format and the baud rate",
                self.name
            )
        })
    }

    /// Reads what has come; nothing after the timeout.
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, String> {
        match self.port.read(buffer) {
            Ok(0) => Err(format!("{}: the sensor was unplugged", self.name)),
            Ok(count) => Ok(count),
            Err(error)
                if matches!(
                    error.kind(),
                    io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
                ) =>
            {
                Ok(0)
            }
            Err(error) => Err(format!("{}: the sensor was unplugged ({error})", self.name)),
        }
    }
}
