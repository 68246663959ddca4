//! The window.

use crate::recovery;
use crate::shell::{Purpose, Shell};
use crate::views::Views;
use crate::{StudioOptions, palette};
use eframe::egui::{
    self, Align, CentralPanel, Color32, Context, Key, Layout, Modal, Panel, RichText, Theme, Ui,
    ViewportCommand,
};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Views beside the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// Motion in space and as curves.
    #[default]
    Clips,
    /// Contacts, steps and switches on a timeline.
    Labels,
    /// Average walks and styles from recordings.
    Train,
    /// Styles without a recording, and mixtures.
    Design,
    /// A sensor that is worn now.
    Sensor,
    /// Tables and charts.
    Evaluate,
}

impl Tab {
    /// Every tab.
    pub const ALL: [Self; 6] = [
        Self::Clips,
        Self::Labels,
        Self::Train,
        Self::Design,
        Self::Sensor,
        Self::Evaluate,
    ];

    /// Title of the view.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clips => "Clips",
            Self::Labels => "Labels",
            Self::Train => "Train",
            Self::Design => "Design",
            Self::Sensor => "Sensor",
            Self::Evaluate => "Evaluate",
        }
    }
}

/// Frames over which the frame timer looks.
const TIMED_FRAMES: usize = 120;

/// The application.
pub struct Studio {
    tab: Tab,
    shell: Shell,
    views: Views,
    /// True when the question is open that closing with unsaved labels asks.
    asks_to_close: bool,
    may_close: bool,
    /// The longest time that a frame took on the processor, seconds.
    longest_frame_secs: f32,
    /// Durations of the last frames, seconds.
    frame_secs: VecDeque<f32>,
}

impl Studio {
    /// A studio in a context.
    pub fn new(context: &Context, options: StudioOptions) -> Self {
        context.set_theme(Theme::Dark);
        context.all_styles_mut(|style| {
            style.spacing.item_spacing = egui::vec2(6.0, 5.0);
            style.interaction.selectable_labels = false;
            // The window is cleared to the panels' colour: painting it again costs a software renderer as much as all the rest.
            style.visuals.panel_fill = Color32::TRANSPARENT;
        });
        let data_folder = options.data_folder.unwrap_or_else(|| {
            let base = dirs::data_local_dir().unwrap_or_else(std::env::temp_dir);
            base.join("footfall").join("studio")
        });
        let mut studio = Self {
            tab: Tab::default(),
            shell: Shell::new(data_folder),
            views: Views::default(),
            asks_to_close: false,
            may_close: false,
            longest_frame_secs: 0.0,
            frame_secs: VecDeque::new(),
        };
        for path in options.paths {
            studio.open(context, &path);
        }
        studio
            .views
            .labels
            .offer_recovery(recovery::read_all(&studio.shell.data_folder));
        studio
    }

    /// Opens a file or a folder: recordings go to the list, recordings of a sensor to the sensor's view.
    pub fn open(&mut self, context: &Context, path: &Path) {
        self.shell.remember_folder(path);
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let is_index = path.file_name().is_some_and(|name| name == "index.csv");
        match extension.as_deref() {
            Some("csv") if !is_index => {
                self.tab = Tab::Sensor;
                self.views.sensor.replay(&mut self.shell, path);
            }
            Some("footstyle") => {
                self.tab = Tab::Design;
                self.views.design.add_style(&mut self.shell, path);
            }
            Some("footfall") => {
                self.tab = Tab::Train;
                self.shell.set_base(path);
            }
            Some("bvh") => {
                self.shell.library.add(path);
                self.shell.act(
                    context,
                    crate::library::ListAction::Open(path.to_owned()),
                );
            }
            _ if path.is_dir() || is_index => {
                let index = if is_index { path.to_owned() } else { path.join("index.csv") };
                if index.is_file() {
                    self.views.evaluate.set_index(index);
                }
                self.shell.library.open(context, path);
            }
            _ => self.shell.complain(format!(
                "{}: cannot be shown; open .bvh, .footfall, .footstyle, a sensor's .csv or a folder",
                path.display()
            )),
        }
    }

    /// Shows a tab.
    pub fn show_tab(&mut self, tab: Tab) {
        self.tab = tab;
    }

    /// Returns true when work goes on in the background.
    pub fn is_busy(&self) -> bool {
        self.shell.library.is_busy() || self.shell.is_reading() || self.views.is_busy()
    }

    /// Last message, if it was not dismissed.
    pub fn message(&self) -> Option<&str> {
        self.shell
            .message
            .as_ref()
            .map(|message| message.text.as_str())
    }

    /// Answers the file dialog that is open as if this file had been chosen in it. Whether one was open.
    pub fn answer_dialog(&mut self, path: PathBuf) -> bool {
        self.shell.answer(path)
    }

    /// Goes to a time of the motion that is shown, seconds.
    pub fn seek(&mut self, secs: f64) {
        self.views.clips.playback.secs = secs;
    }

    /// Returns the time of the motion that is shown, seconds.
    pub const fn playhead_secs(&self) -> f64 {
        self.views.clips.playback.secs
    }

    /// Probability of each behaviour of the sensor's body, in the order of [`Behaviour::ALL`](footfall_core::Behaviour::ALL).
    pub fn behaviours(&self) -> [f32; footfall_core::Behaviour::ALL.len()] {
        self.views.sensor.behaviours()
    }

    /// One frame.
    pub fn frame(&mut self, ui: &mut Ui) {
        self.take_dropped(ui);
        self.shell.poll();
        self.views.poll(ui.ctx(), &mut self.shell);
        if let Some(style) = self.views.train.take_for_mixing() {
            self.tab = Tab::Design;
            self.views.design.mix_style(&mut self.shell, style);
        }
        for purpose in [Purpose::OpenFile, Purpose::OpenFolder] {
            if let Some(path) = self.shell.picked(purpose) {
                self.open(ui.ctx(), &path);
            }
        }
        self.keys(ui);
        Panel::top("tabs").show(ui, |ui| self.tabs(ui));
        if self.shell.message.is_some() {
            Panel::bottom("message").show(ui, |ui| self.shell.show_message(ui));
        }
        Panel::left("list")
            .default_size(250.0)
            .size_range(170.0..=480.0)
            .show(ui, |ui| self.list(ui));
        CentralPanel::default().show(ui, |ui| match self.tab {
            Tab::Clips => self.views.clips.show(ui, &mut self.shell),
            Tab::Labels => {
                let playback = &mut self.views.clips.playback;
                self.views.labels.show(ui, &mut self.shell, playback);
            }
            Tab::Train => self.views.train.show(ui, &mut self.shell),
            Tab::Design => self.views.design.show(ui, &mut self.shell),
            Tab::Sensor => self.views.sensor.show(ui, &mut self.shell),
            Tab::Evaluate => self.views.evaluate.show(ui, &mut self.shell),
        });
        self.shell.show_dialog(ui.ctx());
        self.closing(ui.ctx());
    }

    fn tabs(&mut self, ui: &mut Ui) {
        ui.add_space(3.0);
        ui.horizontal(|ui| {
            ui.label(RichText::new("Footfall").strong().color(palette::LEFT));
            ui.label(RichText::new("Studio").strong().color(palette::RIGHT));
            ui.separator();
            for (number, tab) in Tab::ALL.into_iter().enumerate() {
                let hint = format!("Ctrl+{}", number + 1);
                let label = ui.selectable_label(self.tab == tab, tab.name());
                if label.on_hover_text(hint).clicked() {
                    self.tab = tab;
                }
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let dark = ui.visuals().dark_mode;
                let (label, theme) = if dark {
                    ("☀", Theme::Light)
                } else {
                    ("🌙", Theme::Dark)
                };
                if ui.button(label).on_hover_text("Light or dark").clicked() {
                    ui.ctx().set_theme(theme);
                }
                if self.views.labels.is_dirty() {
                    ui.colored_label(palette::PLAYHEAD, "• unsaved labels");
                }
                self.frame_timer(ui);
            });
        });
        ui.add_space(2.0);
    }

    /// Shows the duration of frames, so that a studio that stutters says so.
    fn frame_timer(&self, ui: &mut Ui) {
        if self.frame_secs.is_empty() {
            return;
        }
        let longest = self.frame_secs.iter().copied().fold(0.0, f32::max);
        let mean = self.frame_secs.iter().sum::<f32>() / self.frame_secs.len() as f32;
        ui.weak(format!("{:.1} ms", 1e3 * mean)).on_hover_text(format!(
            "Processor time of a frame, mean of the last {} frames; longest {:.1} ms, longest ever {:.1} ms",
            self.frame_secs.len(),
            1e3 * longest,
            1e3 * self.longest_frame_secs
        ));
    }

    fn list(&mut self, ui: &mut Ui) {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if ui.button("Open file…").clicked() {
                self.shell.ask(Purpose::OpenFile, "");
            }
            if ui.button("Open folder…").clicked() {
                self.shell.ask(Purpose::OpenFolder, "");
            }
        });
        if self.shell.library.is_empty() {
            ui.add_space(8.0);
            ui.weak("Drop BVH files or a folder here. Sensor recordings (.csv), models and styles open in their own views.");
            return;
        }
        let path_of = |motion: &Option<crate::motion::Motion>| -> Option<PathBuf> {
            motion.as_ref().and_then(|motion| motion.path.clone())
        };
        let (current, ghost) = (path_of(&self.shell.current), path_of(&self.shell.ghost));
        let action = self
            .shell
            .library
            .show(ui, current.as_deref(), ghost.as_deref());
        if let Some(action) = action {
            if matches!(action, crate::library::ListAction::Open(_)) && self.views.labels.is_dirty()
            {
                // Nothing is lost: what is unsaved is kept for recovery and offered again.
                self.views.labels.keep(&mut self.shell);
            }
            self.shell.act(ui.ctx(), action);
        }
    }

    fn keys(&mut self, ui: &Ui) {
        const NUMBERS: [Key; 6] = [
            Key::Num1,
            Key::Num2,
            Key::Num3,
            Key::Num4,
            Key::Num5,
            Key::Num6,
        ];
        for (key, tab) in NUMBERS.into_iter().zip(Tab::ALL) {
            if ui.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, key)) {
                self.tab = tab;
            }
        }
    }

    fn take_dropped(&mut self, ui: &Ui) {
        let dropped: Vec<PathBuf> = ui.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.filter_map(|file| file.path.clone()).collect()
        });
        for path in dropped {
            self.open(ui.ctx(), &path);
        }
    }

    /// Closing with unsaved labels asks.
    fn closing(&mut self, context: &Context) {
        if context.input(|input| input.viewport().close_requested())
            && self.views.labels.is_dirty()
            && !self.may_close
        {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.asks_to_close = true;
        }
        if !self.asks_to_close {
            return;
        }
        Modal::new("closing".into()).show(context, |ui| {
            ui.heading("Labels are not saved");
            ui.label("Corrected contacts of the motion that is shown are not on disk yet.");
            ui.horizontal(|ui| {
                if ui.button("Save and close").clicked() {
                    self.asks_to_close = false;
                    self.may_close = self.views.labels.save(&mut self.shell);
                }
                if ui.button("Discard and close").clicked() {
                    self.views.labels.discard(&mut self.shell);
                    self.asks_to_close = false;
                    self.may_close = true;
                }
                if ui.button("Stay").clicked() {
                    self.asks_to_close = false;
                }
            });
        });
        if self.may_close {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}

impl eframe::App for Studio {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        palette::backdrop(visuals.dark_mode).to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        if let Some(secs) = frame.info().cpu_usage {
            self.longest_frame_secs = self.longest_frame_secs.max(secs);
            self.frame_secs.push_back(secs);

            if self.frame_secs.len() > TIMED_FRAMES {
                self.frame_secs.pop_front();
            }
        }
        self.frame(ui);
    }
}
