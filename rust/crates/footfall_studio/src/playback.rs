//! The playhead.

use eframe::egui::{Button, ComboBox, Key, Slider, Ui};

/// Speeds to choose from.
const SPEEDS: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];

/// Time of a motion, and whether it goes on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Playback {
    /// Time in the motion, seconds.
    pub(crate) secs: f64,
    pub(crate) playing: bool,
    speed: f64,
    looping: bool,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            secs: 0.0,
            playing: false,
            speed: 1.0,
            looping: true,
        }
    }
}

impl Playback {
    /// One that plays.
    pub(crate) fn playing() -> Self {
        Self {
            playing: true,
            ..Self::default()
        }
    }

    /// Goes on by the frame's time; asks for the next frame while it plays.
    pub(crate) fn advance(&mut self, ui: &Ui, start_secs: f64, end_secs: f64) {
        if self.playing {
            let dt = f64::from(ui.input(|input| input.stable_dt).min(0.1));
            self.secs += dt * self.speed;
            if self.secs > end_secs {
                self.secs = if self.looping { start_secs } else { end_secs };
                self.playing = self.looping;
            }
            ui.ctx().request_repaint();
        }
        self.secs = self.secs.clamp(0.0, end_secs.max(0.0));
    }

    /// Keys: space plays and pauses, arrows go a frame, home to the beginning.
    pub(crate) fn keys(&mut self, ui: &Ui, start_secs: f64, frame_secs: f64) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        ui.input(|input| {
            if input.key_pressed(Key::Space) {
                self.playing = !self.playing;
            }
            for (key, frames) in [(Key::ArrowLeft, -1.0), (Key::ArrowRight, 1.0)] {
                if input.key_pressed(key) {
                    self.playing = false;
                    self.secs += frames * frame_secs;
                }
            }
            if input.key_pressed(Key::Home) {
                self.secs = start_secs;
            }
        });
    }

    /// The row of buttons under a motion.
    pub(crate) fn controls(&mut self, ui: &mut Ui, start_secs: f64, end_secs: f64, rate_hz: f64) {
        ui.horizontal(|ui| {
            let label = if self.playing { "⏸" } else { "▶" };
            let name = if self.playing { "Pause" } else { "Play" };
            let button = ui.add_sized([30.0, 20.0], Button::new(label));
            if button.on_hover_text(format!("{name} (space)")).clicked() {
                self.playing = !self.playing;
            }
            if ui
                .button("⏮")
                .on_hover_text("To the beginning (home)")
                .clicked()
            {
                self.secs = start_secs;
            }
            ComboBox::from_id_salt("speed")
                .selected_text(format!("{}×", self.speed))
                .width(56.0)
                .show_ui(ui, |ui| {
                    for speed in SPEEDS {
                        ui.selectable_value(&mut self.speed, speed, format!("{speed}×"));
                    }
                });
            ui.checkbox(&mut self.looping, "Loop");
            let width = (ui.available_width() - 150.0).max(60.0);
            ui.spacing_mut().slider_width = width;
            let slider = Slider::new(&mut self.secs, 0.0..=end_secs.max(1e-3))
                .show_value(false)
                .trailing_fill(true);
            if ui.add(slider).on_hover_text("Scrub").dragged() {
                self.playing = false;
            }
            ui.monospace(format!(
                "{:7.2} s  {:6}",
                self.secs,
                (self.secs * rate_hz).round()
            ));
        });
    }
}
