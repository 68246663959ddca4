//! `PhoneImuSource`: a phone's browser as a sensor.

use crate::imu_source::{Live, LiveSource, Opened, SharedPorts, live_source_api};
use footfall_imu::live::phone::{self, PhoneConfig, PhoneServer, qr_code};
use godot::classes::image::Format;
use godot::classes::{IResource, Image, ProjectSettings, Resource};
use godot::prelude::*;
use std::path::PathBuf;

static SERVERS: SharedPorts<u16, PhoneServer> = SharedPorts::new();

/// Players who share a port.
const MOST_PLAYERS: usize = 8;

/// Light modules around a code, which readers need.
const MARGIN: usize = 4;

/// Folder of the certificate.
const FOLDER: &str = "user://footfall_phone";

/// Receives samples from a phone's browser: the game serves a page and shows its address as a code; the phone that scans it becomes the sensor. There is nothing to install.
///
/// The page uses HTTPS with a certificate that this machine signs itself and keeps under `user://footfall_phone`; the browser warns of it once. Each player has a
/// code of their own, new at every start, and one phone at a time. Only the local network is served.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct PhoneImuSource {
    /// The TCP port of the page.
    #[export(range = (1.0, 65535.0, 1.0))]
    #[init(val = i64::from(phone::DEFAULT_PORT))]
    #[var(set = set_port)]
    port: i64,

    /// Number of the player, from 0. Players share the port.
    #[export(range = (0.0, 7.0, 1.0))]
    player: i64,

    /// If `true`, the phone vibrates when a foot of the character lands.
    #[export]
    #[init(val = true)]
    vibrate_on_footsteps: bool,

    live: Live,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for PhoneImuSource {}

#[godot_api]
impl PhoneImuSource {
    /// Returns the address of the page for this player; empty before `start()`, and while the port is unavailable.
    #[func]
    fn get_url(&self) -> GString {
        GString::from(&self.url().unwrap_or_default())
    }

    /// Returns the address as a QR code, one pixel per module with a light margin; `null` before `start()`. Show it large and without filter.
    #[func]
    fn get_qr_code(&self) -> Option<Gd<Image>> {
        let (width, modules) = qr_code(&self.url()?)?;
        let whole = width + 2 * MARGIN;
        let mut pixels = vec![255; whole * whole];
        for (n, dark) in modules.into_iter().enumerate() {
            if dark {
                pixels[(n / width + MARGIN) * whole + n % width + MARGIN] = 0;
            }
        }
        let size = i32::try_from(whole).ok()?;
        Image::create_from_data(
            size,
            size,
            false,
            Format::L8,
            &PackedByteArray::from(pixels),
        )
    }

    #[func]
    fn set_port(&mut self, port: i64) {
        self.port = port;
        self.live.close();
        self.base_mut().emit_changed();
    }
}

live_source_api!(PhoneImuSource);

impl PhoneImuSource {
    fn url(&self) -> Option<String> {
        let look = |opened: &Opened| match opened {
            Opened::Phone(server) if server.link().address().is_some() => server.url(self.place()),
            _ => None,
        };
        self.live.with(look).flatten()
    }

    /// Makes the phone vibrate, if the setting is on.
    pub(crate) fn vibrate(&self) {
        if self.vibrate_on_footsteps {
            self.live.with(|opened| {
                if let Opened::Phone(server) = opened {
                    server.vibrate(self.place());
                }
            });
        }
    }
}

impl LiveSource for PhoneImuSource {
    fn live(&self) -> &Live {
        &self.live
    }

    fn place(&self) -> usize {
        usize::try_from(self.player)
            .unwrap_or_default()
            .min(MOST_PLAYERS - 1)
    }

    fn opened(&self) -> Result<Opened, String> {
        let port = u16::try_from(self.port).ok().filter(|port| *port > 0);
        let port = port.ok_or_else(|| {
            format!(
                "{} is not a port. Set Port to a number from 1 to 65535",
                self.port
            )
        })?;
        let folder = ProjectSettings::singleton().globalize_path(FOLDER);
        let server = SERVERS.get(port, || {
            PhoneServer::start(PhoneConfig {
                port,
                players: MOST_PLAYERS,
                folder: PathBuf::from(folder.to_string()),
            })
        });
        let server =
            server.map_err(|error| format!("cannot create the code for the phone: {error}"))?;
        Ok(Opened::Phone(server))
    }
}
