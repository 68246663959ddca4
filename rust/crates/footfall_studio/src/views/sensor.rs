//! A sensor that is worn now, or was: what it measures, how it is mounted, and the body that it moves.

mod body;
mod connection;
mod signals;

use crate::palette;
use crate::scene::{Body, BodyPaint, Scene, SceneView, SensorBox};
use crate::shell::{Purpose, Shell};
use body::LiveBody;
use connection::{Connection, SourceChoice};
use eframe::egui::{Align2, Context, FontId, Panel, Rect, ScrollArea, Sense, Ui, vec2};
use footfall_core::Behaviour;
use footfall_imu::ImuSample;
use footfall_imu::live::recorder::Recorder;
use glam::Vec3;
use signals::Signals;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// While a sensor is heard the window is painted this often.
const REPAINT: Duration = Duration::from_millis(16);

/// Number of the most probable phases that are shown.
const SHOWN_PHASES: usize = 5;

#[derive(Default)]
pub(crate) struct SensorView {
    choice: SourceChoice,
    connection: Option<Connection>,
    signals: Signals,
    body: LiveBody,
    scene: SceneView,
    mounting_scene: SceneView,
    recorder: Option<(PathBuf, Recorder)>,
    fresh: Vec<ImuSample>,
}

impl SensorView {
    pub(crate) fn is_busy(&self) -> bool {
        self.body.is_busy()
            || self
                .connection
                .as_ref()
                .is_some_and(Connection::is_replaying)
    }

    /// Probability of each behaviour.
    pub(crate) fn behaviours(&self) -> [f32; Behaviour::ALL.len()] {
        self.body.behaviours()
    }

    /// Replays a recording.
    pub(crate) fn replay(&mut self, shell: &mut Shell, path: &Path) {
        match Connection::replay(path) {
            Ok(connection) => {
                self.begin();
                self.connection = Some(connection);
                self.body.load_shipped(shell);
            }
            Err(error) => shell.complain(error),
        }
    }

    fn begin(&mut self) {
        self.signals = Signals::default();
        self.body.restart();
    }

    pub(crate) fn poll(&mut self, context: &Context, shell: &mut Shell) {
        if let Some(path) = shell.picked(Purpose::OpenSensor) {
            self.replay(shell, &path);
        }
        if let Some(path) = shell.picked(Purpose::SensorModel) {
            self.body.load(shell, &path);
        }
        if let Some(path) = shell.picked(Purpose::SaveSensor) {
            match Recorder::new(&path) {
                Ok(recorder) => self.recorder = Some((path, recorder)),
                Err(error) => shell.complain(format!("{}: {error}", path.display())),
            }
        }
        self.body.poll();
        let Some(connection) = &mut self.connection else {
            return;
        };
        let dt = context.input(|input| f64::from(input.stable_dt.min(0.1)));
        self.fresh.clear();
        connection.take(dt, &mut self.fresh);
        let mut failed = None;
        for sample in &self.fresh {
            self.signals.push(*sample);
            self.body.push(*sample);
            if let Some((path, recorder)) = &mut self.recorder
                && let Err(error) = recorder.push(*sample)
            {
                failed = Some(format!(
                    "{}: {error}; check the free disk space",
                    path.display()
                ));
            }
        }
        if let Some(error) = failed {
            self.recorder = None;
            shell.complain(error);
        }
        self.body.step(dt as f32);
        context.request_repaint_after(REPAINT);
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        Panel::left("sensor")
            .default_size(290.0)
            .resizable(true)
            .show(ui, |ui| {
                ScrollArea::vertical()
                    .auto_shrink(false)
                    .show(ui, |ui| self.settings(ui, shell));
            });
        Panel::bottom("signals")
            .resizable(true)
            .default_size(270.0)
            .show(ui, |ui| self.signals.show(ui));
        let size = vec2(ui.available_width(), ui.available_height());
        let Some((skeleton, pose)) = self.body.shown() else {
            ui.centered_and_justified(|ui| {
                ui.weak("Connect a sensor or replay a recording, and choose a sensor model: the body moves here.");
            });
            return;
        };
        let scene = Scene {
            bodies: vec![Body {
                skeleton,
                pose,
                look: if self.body.is_mounted() {
                    BodyPaint::Solid
                } else {
                    BodyPaint::Ghost
                },
            }],
            ..Scene::default()
        };
        self.scene.show(ui, size, &scene);
    }

    fn settings(&mut self, ui: &mut Ui, shell: &mut Shell) {
        ui.add_space(4.0);
        if let Some(connection) = &mut self.connection {
            connection.show(ui);
            let ends = ui.button("Disconnect").clicked();
            ui.separator();
            self.recording(ui, shell);
            if ends {
                self.stop_recording(shell);
                self.connection = None;
            }
        } else {
            match self.choice.show(ui, &shell.data_folder) {
                Some(Ok(connection)) => {
                    self.begin();
                    self.connection = Some(connection);
                    self.body.load_shipped(shell);
                }
                Some(Err(error)) => shell.complain(error),
                None => {}
            }
            if ui.button("Replay a recording…").clicked() {
                shell.ask(Purpose::OpenSensor, "");
            }
        }
        ui.separator();
        ui.strong("Mounting");
        let sensor = SensorBox {
            place: Vec3::new(0.0, 0.9, 0.0),
            rotation: self.signals.orientation(),
        };
        self.mounting_scene.follows = false;
        self.mounting_scene.orbit.distance = 2.2;
        let scene = Scene {
            sensors: vec![sensor],
            ..Scene::default()
        };
        let width = ui.available_width();
        self.mounting_scene.show(ui, vec2(width, 150.0), &scene);
        ui.weak("The box turns as the sensor does: x red, y green, z blue. Its heading drifts.");
        self.body.settings(ui, shell);
        ui.separator();
        ui.strong("What the body does");
        let behaviours = self.body.behaviours();
        for (behaviour, probability) in Behaviour::ALL.into_iter().zip(behaviours) {
            probability_bar(ui, behaviour.name(), probability);
        }
        ui.add_space(4.0);
        ui.strong("Phases");
        for (phase, probability) in self.body.phases(SHOWN_PHASES) {
            probability_bar(ui, &phase.to_string(), probability);
        }
    }

    fn recording(&mut self, ui: &mut Ui, shell: &mut Shell) {
        let Some((_, recorder)) = &self.recorder else {
            if ui.button("Record…").clicked() {
                shell.ask(Purpose::SaveSensor, "imu.csv");
            }
            return;
        };
        let samples = recorder.samples();
        let stops = ui.horizontal(|ui| {
            ui.colored_label(palette::BAD, "• recording");
            ui.label(format!("{samples} samples"));
            ui.button("Stop").clicked()
        });
        if stops.inner {
            self.stop_recording(shell);
        }
    }

    fn stop_recording(&mut self, shell: &mut Shell) {
        if let Some((path, recorder)) = self.recorder.take() {
            let samples = recorder.samples();
            match recorder.finish() {
                Ok(()) => shell.say(format!("{} written, {samples} samples", path.display())),
                Err(error) => shell.complain(format!("{}: {error}", path.display())),
            }
        }
    }
}

fn probability_bar(ui: &mut Ui, name: &str, probability: f32) {
    let size = vec2(ui.available_width(), 18.0);
    let (response, painter) = ui.allocate_painter(size, Sense::hover());
    let whole = response.rect;
    painter.rect_filled(whole, 2.0, ui.visuals().extreme_bg_color);
    let filled = vec2(whole.width() * probability.clamp(0.0, 1.0), whole.height());
    let filled = Rect::from_min_size(whole.min, filled);
    painter.rect_filled(filled, 2.0, palette::RIGHT.gamma_multiply(0.7));
    painter.text(
        whole.left_center() + vec2(6.0, 0.0),
        Align2::LEFT_CENTER,
        format!("{name} {:.0} %", 100.0 * probability),
        FontId::proportional(12.0),
        ui.visuals().text_color(),
    );
}
