//! `NetworkImuSource`: a sensor that an app or a tracker sends over the network.

use crate::imu_source::{Live, LiveSource, Opened, SharedPorts, live_source_api};
use footfall_imu::live::Link;
use footfall_imu::live::network::udp::{self, UdpConfig};
use footfall_imu::live::network::{http, websocket};
use footfall_imu::live::serial::TextFormat;
use godot::classes::{IResource, Resource};
use godot::prelude::*;

static LINKS: SharedPorts<(NetworkImuTransport, String), Link> = SharedPorts::new();

/// Receives samples from an inertial sensor on the local network: an app on a phone, or a tracker.
///
/// A UDP port recognises the formats of owoTrack, SlimeVR trackers, ZIG SIM, GyrOSC, SensaGram and HyperIMU. Sensor Logger posts over HTTP. For
/// SensorServer, the game connects to the phone's address. Senders outside the local network are ignored.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct NetworkImuSource {
    /// Protocol of the samples.
    #[export]
    #[var(set = set_transport)]
    transport: NetworkImuTransport,

    /// The port of this machine on which `Udp` (trackers look for 6969) or `Http` listens.
    #[export(range = (1.0, 65535.0, 1.0))]
    #[init(val = i64::from(udp::DEFAULT_PORT))]
    #[var(set = set_port)]
    port: i64,

    /// For `WebSocket`: the address that SensorServer shows, such as `192.168.1.5:8080`.
    #[export]
    #[var(set = set_address)]
    address: GString,

    /// Number of the sensor at the port, from 0 in the order of their first samples, so that several players share a port.
    #[export(range = (0.0, 15.0, 1.0))]
    sensor: i64,

    live: Live,
    base: Base<Resource>,
}

/// Protocol of the samples.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum NetworkImuTransport {
    #[default]
    Udp = 0,
    Http = 1,
    WebSocket = 2,
}

#[godot_api]
impl IResource for NetworkImuSource {}

#[godot_api]
impl NetworkImuSource {
    /// `transport`: datagrams on `port`.
    #[constant]
    const UDP: i32 = NetworkImuTransport::Udp as i32;
    /// `transport`: posts on `port`, to `/data`.
    #[constant]
    const HTTP: i32 = NetworkImuTransport::Http as i32;
    /// `transport`: a connection to the phone at `address`.
    #[constant]
    const WEB_SOCKET: i32 = NetworkImuTransport::WebSocket as i32;

    #[func]
    fn set_transport(&mut self, transport: NetworkImuTransport) {
        self.transport = transport;
        self.restart();
    }

    #[func]
    fn set_port(&mut self, port: i64) {
        self.port = port;
        self.restart();
    }

    #[func]
    fn set_address(&mut self, address: GString) {
        self.address = address;
        self.restart();
    }
}

live_source_api!(NetworkImuSource);

impl NetworkImuSource {
    fn restart(&mut self) {
        self.live.close();
        self.base_mut().emit_changed();
    }
}

impl LiveSource for NetworkImuSource {
    fn live(&self) -> &Live {
        &self.live
    }

    fn place(&self) -> usize {
        usize::try_from(self.sensor).unwrap_or_default()
    }

    fn opened(&self) -> Result<Opened, String> {
        let address = self.address.to_string();
        let port = || {
            let port = u16::try_from(self.port).ok().filter(|port| *port > 0);
            port.ok_or_else(|| {
                format!(
                    "{} is not a port. Set Port to a number from 1 to 65535",
                    self.port
                )
            })
        };
        let (key, link): (String, Box<dyn FnOnce() -> Link>) = match self.transport {
            NetworkImuTransport::Udp => {
                let port = port()?;
                let text = TextFormat::default();
                (
                    port.to_string(),
                    Box::new(move || udp::listen(UdpConfig { port, text })),
                )
            }
            NetworkImuTransport::Http => {
                let port = port()?;
                (port.to_string(), Box::new(move || http::listen(port)))
            }
            NetworkImuTransport::WebSocket if address.is_empty() => {
                return Err("set Address to the address that SensorServer shows".to_owned());
            }
            NetworkImuTransport::WebSocket => (
                address.clone(),
                Box::new(move || websocket::follow(&address)),
            ),
        };
        let link = LINKS.get((self.transport, key), || Ok::<_, String>(link()))?;
        Ok(Opened::Link(link))
    }
}
