//! Sources of samples.

use crate::palette;
use eframe::egui::{Color32, ComboBox, DragValue, RichText, Sense, TextEdit, Ui, vec2};
use footfall_imu::live::network::udp::UdpConfig;
use footfall_imu::live::network::{http, udp, websocket};
use footfall_imu::live::phone::{self, PhoneConfig, PhoneServer, qr_code};
use footfall_imu::live::serial::TextFormat;
use footfall_imu::live::serial::port::{self, PortInfo, SerialConfig};
use footfall_imu::live::{Device, Link, LinkState};
use footfall_imu::{ImuRecording, ImuSample, csv};
use std::path::Path;

/// Time without samples after which a device counts as silent, seconds.
const SILENT_SECS: f64 = 0.5;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Kind {
    #[default]
    Phone,
    Udp,
    Http,
    WebSocket,
    Serial,
}

impl Kind {
    const ALL: [Self; 5] = [
        Self::Phone,
        Self::Udp,
        Self::Http,
        Self::WebSocket,
        Self::Serial,
    ];

    const fn name(self) -> &'static str {
        match self {
            Self::Phone => "A phone's browser",
            Self::Udp => "UDP (owoTrack, ZIG SIM, …)",
            Self::Http => "HTTP push (Sensor Logger)",
            Self::WebSocket => "SensorServer",
            Self::Serial => "Serial port",
        }
    }
}

/// The settings of a connection that is to be made.
pub(super) struct SourceChoice {
    kind: Kind,
    port: u16,
    server: String,
    serial: String,
    ports: Option<Vec<PortInfo>>,
}

impl Default for SourceChoice {
    fn default() -> Self {
        Self {
            kind: Kind::default(),
            port: 6969,
            server: String::new(),
            serial: String::new(),
            ports: None,
        }
    }
}

impl SourceChoice {
    /// The settings; a connection when it was asked for.
    pub(super) fn show(&mut self, ui: &mut Ui, data: &Path) -> Option<Result<Connection, String>> {
        ui.strong("Source");
        ComboBox::from_id_salt("source")
            .selected_text(self.kind.name())
            .width(210.0)
            .show_ui(ui, |ui| {
                for kind in Kind::ALL {
                    ui.selectable_value(&mut self.kind, kind, kind.name());
                }
            });
        match self.kind {
            Kind::Udp | Kind::Http => {
                ui.horizontal(|ui| {
                    ui.label("Port");
                    ui.add(DragValue::new(&mut self.port).range(1..=u16::MAX));
                });
            }
            Kind::WebSocket => {
                ui.add(TextEdit::singleline(&mut self.server).hint_text("192.168.1.20:8080"));
            }
            Kind::Serial => self.show_ports(ui),
            Kind::Phone => {}
        }
        ui.button("Connect").clicked().then(|| self.connect(data))
    }

    fn show_ports(&mut self, ui: &mut Ui) {
        let ports = self.ports.get_or_insert_with(port::ports);
        ui.horizontal(|ui| {
            let shown = if self.serial.is_empty() {
                "the first on USB"
            } else {
                &self.serial
            };
            ComboBox::from_id_salt("serial")
                .selected_text(shown)
                .show_ui(ui, |ui| {
                    ui.selectable_value(&mut self.serial, String::new(), "the first on USB");
                    for port in ports.iter() {
                        let text = format!("{} {}", port.name, port.description);
                        ui.selectable_value(&mut self.serial, port.name.clone(), text);
                    }
                });
            if ui.small_button("↺").on_hover_text("Look again").clicked() {
                *ports = port::ports();
            }
        });
    }

    fn connect(&self, data: &Path) -> Result<Connection, String> {
        let text = TextFormat::default();
        let link = match self.kind {
            Kind::Phone => {
                let server = PhoneServer::start(PhoneConfig {
                    port: phone::DEFAULT_PORT,
                    players: 1,
                    folder: data.join("phone"),
                })
                .map_err(|error| error.to_string())?;
                return Ok(Connection::new(Source::Phone { server, code: None }));
            }
            Kind::Udp => udp::listen(UdpConfig {
                port: self.port,
                text,
            }),
            Kind::Http => http::listen(self.port),
            Kind::WebSocket if self.server.trim().is_empty() => {
                return Err(
                    "enter the address that the app shows, such as 192.168.1.20:8080".to_owned(),
                );
            }
            Kind::WebSocket => websocket::follow(self.server.trim()),
            Kind::Serial => port::listen(SerialConfig {
                port: self.serial.clone(),
                text,
                ..SerialConfig::default()
            }),
        };
        Ok(Connection::new(Source::Link(link)))
    }
}

/// A QR code: modules on a side, and whether each is dark.
type Code = (usize, Vec<bool>);

enum Source {
    Link(Link),
    Phone {
        server: PhoneServer,
        /// The address, and its code.
        code: Option<(String, Code)>,
    },
    Replay {
        name: String,
        recording: ImuRecording,
        next: usize,
        secs: f64,
    },
}

/// An open source.
pub(super) struct Connection {
    source: Source,
    device: usize,
}

impl Connection {
    const fn new(source: Source) -> Self {
        Self { source, device: 0 }
    }

    /// A recording, as if it were measured now.
    pub(super) fn replay(path: &Path) -> Result<Self, String> {
        let recording = csv::read(path).map_err(|error| error.to_string())?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(Self::new(Source::Replay {
            name: name.into_owned(),
            secs: recording.start_secs(),
            recording,
            next: 0,
        }))
    }

    /// Returns true when a recording is on its way.
    pub(super) const fn is_replaying(&self) -> bool {
        match &self.source {
            Source::Replay {
                recording, next, ..
            } => *next < recording.samples.len(),
            _ => false,
        }
    }

    fn link(&self) -> Option<&Link> {
        match &self.source {
            Source::Link(link) => Some(link),
            Source::Phone { server, .. } => Some(server.link()),
            Source::Replay { .. } => None,
        }
    }

    fn chosen(&self) -> Option<Device> {
        self.link()?.device(self.device)
    }

    /// The samples since the last time.
    pub(super) fn take(&mut self, dt_secs: f64, out: &mut Vec<ImuSample>) {
        if let Source::Replay {
            recording,
            next,
            secs,
            ..
        } = &mut self.source
        {
            *secs += dt_secs;
            while let Some(sample) = recording.samples.get(*next)
                && sample.time_secs <= *secs
            {
                out.push(*sample);
                *next += 1;
            }
            return;
        }
        let devices = self.link().map(Link::devices).unwrap_or_default();
        for (place, device) in devices.into_iter().enumerate() {
            // What others measure is passed over, not kept.
            device.take(|sample| {
                if place == self.device {
                    out.push(sample);
                }
            });
        }
    }

    /// Shows the state of the connection.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        match &mut self.source {
            Source::Replay {
                name,
                recording,
                next,
                secs,
            } => {
                ui.label(format!("Replaying {name}"));
                let (start, length) = (recording.start_secs(), recording.duration_secs());
                ui.weak(format!(
                    "{:.1} of {length:.1} s at {:.0} Hz",
                    (*secs - start).clamp(0.0, length),
                    recording.rate_hz()
                ));
                if ui.button("Again").clicked() {
                    *next = 0;
                    *secs = start;
                }
                return;
            }
            Source::Phone { server, code } => show_code(ui, server, code),
            Source::Link(_) => {}
        }
        let Some(link) = self.link() else { return };
        let state = link.state();
        let color = match state {
            LinkState::Failed(_) => palette::BAD,
            _ => ui.visuals().text_color(),
        };
        ui.colored_label(color, format!("{} {}", state.name(), state.message()));
        let names: Vec<String> = link
            .devices()
            .iter()
            .map(|device| device.status().name)
            .collect();
        for (place, name) in names.into_iter().enumerate() {
            ui.selectable_value(&mut self.device, place, name);
        }
        if let Some(device) = self.chosen() {
            show_device(ui, &device);
        }
    }
}

fn show_device(ui: &mut Ui, device: &Device) {
    let status = device.status();
    if status.silent_secs() > SILENT_SECS {
        ui.colored_label(
            palette::BAD,
            format!("silent for {:.1} s", status.silent_secs()),
        );
    }
    ui.weak(format!(
        "{}, {:.1} Hz, jitter {:.1} ms, {} samples, {} lost",
        status.format,
        status.rate_hz,
        1e3 * status.jitter_secs,
        status.samples,
        status.lost
    ));
    if let Some(fault) = status.fault {
        ui.colored_label(palette::PLAYHEAD, fault);
    }
}

fn show_code(ui: &mut Ui, server: &PhoneServer, code: &mut Option<(String, Code)>) {
    let Some(url) = server.url(0) else {
        return;
    };
    if code.as_ref().is_none_or(|(own, _)| *own != url) {
        *code = qr_code(&url).map(|made| (url.clone(), made));
    }
    if let Some((_, (width, modules))) = code {
        const MODULE: f32 = 4.0;
        const MARGIN: f32 = 4.0 * MODULE;
        let side = *width as f32 * MODULE + 2.0 * MARGIN;
        let (response, painter) = ui.allocate_painter(vec2(side, side), Sense::hover());
        painter.rect_filled(response.rect, 0.0, Color32::WHITE);
        for (place, _) in modules.iter().enumerate().filter(|(_, is_dark)| **is_dark) {
            let corner = vec2((place % *width) as f32, (place / *width) as f32) * MODULE;
            let corner = response.rect.min + vec2(MARGIN, MARGIN) + corner;
            let module = eframe::egui::Rect::from_min_size(corner, vec2(MODULE, MODULE));
            painter.rect_filled(module, 0.0, Color32::BLACK);
        }
    }
    ui.label(RichText::new(url).monospace());
    ui.weak("Scan with a phone on this network. The browser warns of the certificate, which this machine signed itself: go on.");
}
