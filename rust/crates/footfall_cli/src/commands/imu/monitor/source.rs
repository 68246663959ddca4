//! Sources of samples, as given on the command line.

use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_imu::live::network::udp::UdpConfig;
use footfall_imu::live::network::{http, udp, websocket};
use footfall_imu::live::phone::{self, PhoneConfig, PhoneServer, qr_code};
use footfall_imu::live::serial::port::{self, SerialConfig};
use footfall_imu::live::serial::{ForceUnit, RateUnit, SerialFormat, TextFormat, TimeUnit};
use footfall_imu::live::{Link, LinkState};
use std::time::Duration;

#[derive(Debug, clap::Args)]
#[group(id = "source")]
pub(super) struct SourceArgs {
    /// Serial port, or `auto` for the first one on USB
    #[arg(long, value_name = "PORT", group = "one")]
    serial: Option<String>,
    /// UDP port for owoTrack and SlimeVR trackers (6969), ZIG SIM, GyrOSC, SensaGram, HyperIMU
    #[arg(long, value_name = "PORT", group = "one")]
    udp: Option<u16>,
    /// TCP port for Sensor Logger's HTTP push
    #[arg(long, value_name = "PORT", group = "one")]
    http: Option<u16>,
    /// Address of the SensorServer app
    #[arg(long, value_name = "HOST:PORT", group = "one")]
    websocket: Option<String>,
    /// Use a phone's browser: shows a code to scan
    #[arg(long, group = "one")]
    phone: bool,
    /// TCP port of the page for phones
    #[arg(long, value_name = "PORT", default_value_t = phone::DEFAULT_PORT, requires = "phone")]
    phone_port: u16,
    /// Baud rate of the serial port [default: detected]
    #[arg(long, value_name = "RATE", requires = "serial")]
    baud: Option<u32>,
    /// Protocol of the serial device [default: detected]
    #[arg(long, value_parser = parse_format, requires = "serial")]
    format: Option<SerialFormat>,
    /// Columns of lines of numbers, such as t,ax,ay,az,gx,gy,gz [default: from a header, or this order]
    #[arg(long)]
    columns: Option<String>,
    /// Unit of time in lines: s, ms or us [default: from a header, or guessed]
    #[arg(long, value_parser = |name: &str| parse_unit(name, &TimeUnit::NAMES))]
    time_unit: Option<TimeUnit>,
    /// Unit of specific force in lines: mps2, g, mg or counts [default: from a header, or guessed]
    #[arg(long, value_parser = |name: &str| parse_unit(name, &ForceUnit::NAMES))]
    force_unit: Option<ForceUnit>,
    /// Unit of angular rate in lines: radps, dps or counts [default: from a header, or to match the force's unit]
    #[arg(long, value_parser = |name: &str| parse_unit(name, &RateUnit::NAMES))]
    rate_unit: Option<RateUnit>,
}

fn parse_format(name: &str) -> Result<SerialFormat, String> {
    SerialFormat::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = SerialFormat::ALL
            .into_iter()
            .map(SerialFormat::name)
            .collect();
        format!("unknown format; the formats are {}", names.join(", "))
    })
}

fn parse_unit<U: Copy>(name: &str, units: &[(&str, U)]) -> Result<U, String> {
    let found = units.iter().find(|(own, _)| *own == name);
    found.map(|(_, unit)| *unit).ok_or_else(|| {
        let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
        format!("unknown unit; the units are {}", names.join(", "))
    })
}

/// An open source.
pub(super) enum Source {
    Link(Link),
    Phone(PhoneServer),
}

impl Source {
    pub(super) fn open(args: &SourceArgs) -> Result<Self> {
        let text = TextFormat {
            columns: args.columns.clone(),
            time: args.time_unit,
            force: args.force_unit,
            rate: args.rate_unit,
        };
        if let Err(problem) = text.check() {
            bail!(problem);
        }
        if let Some(port) = &args.serial {
            return Ok(Self::Link(port::listen(SerialConfig {
                port: if port == "auto" {
                    String::new()
                } else {
                    port.clone()
                },
                baud_rate: args.baud,
                format: args.format,
                text,
            })));
        }
        if let Some(port) = args.udp {
            return Ok(Self::Link(udp::listen(UdpConfig { port, text })));
        }
        if let Some(port) = args.http {
            return Ok(Self::Link(http::listen(port)));
        }
        if let Some(server) = &args.websocket {
            return Ok(Self::Link(websocket::follow(server)));
        }
        if args.phone {
            return Self::open_phone(args.phone_port);
        }
        bail!(
            "no source; pass --serial, --udp, --http, --websocket or --phone, or list serial ports with --ports"
        )
    }

    fn open_phone(port: u16) -> Result<Self> {
        let folder =
            dirs::data_local_dir().context("this user has no folder for a program's data")?;
        let server = PhoneServer::start(PhoneConfig {
            port,
            players: 1,
            folder: folder.join("footfall").join("phone"),
        })
        .context("cannot create the code for the phone")?;
        // The address holds the port, which is known once the server listens.
        while matches!(server.link().state(), LinkState::Opening(_)) {
            std::thread::sleep(Duration::from_millis(10));
        }
        if let LinkState::Failed(problem) = server.link().state() {
            bail!(problem);
        }
        let url = server.url(0).unwrap_or_default();
        if let Some(code) = qr_code(&url) {
            output::note(&drawn(&code));
        }
        output::note(&format!(
            "scan the code with a phone on this network, or open {url}\nthe browser warns of the certificate, which this machine signed itself: proceed"
        ));
        Ok(Self::Phone(server))
    }

    pub(super) const fn link(&self) -> &Link {
        match self {
            Self::Link(link) => link,
            Self::Phone(server) => server.link(),
        }
    }
}

/// A QR code in half blocks, dark on light with the margin that readers need.
fn drawn((width, modules): &(usize, Vec<bool>)) -> String {
    const MARGIN: usize = 2;
    let inside = MARGIN..MARGIN + width;
    let light = |x: usize, y: usize| {
        let known = inside.contains(&x) && inside.contains(&y);
        !(known && modules[(y - MARGIN) * width + x - MARGIN])
    };
    let rows = (0..width + 2 * MARGIN).step_by(2).map(|y| {
        let cells = (0..width + 2 * MARGIN).map(|x| match (light(x, y), light(x, y + 1)) {
            (true, true) => '█',
            (true, false) => '▀',
            (false, true) => '▄',
            (false, false) => ' ',
        });
        cells.collect::<String>()
    });
    rows.collect::<Vec<_>>().join("\n")
}
