//! A style sheet with sliders, shown on a captured walk at once.

use crate::job::{self, Job, Reporter, finished};
use crate::motion::Motion;
use crate::palette;
use crate::playback::Playback;
use crate::scene::SceneView;
use crate::shell::{Purpose, Shell};
use crate::views::clips::scene_at;
use crate::views::train::{adapt_to, chosen_of};
use eframe::egui::{
    CollapsingHeader, ComboBox, Context, DragValue, Panel, ScrollArea, Slider, TextEdit, Ui, vec2,
};
use footfall_design::{KeySpec, StyleSheet, design, shipped};
use footfall_model::{GaitModel, GaitStyle};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::Retargeted;
use footfall_train::read_recordings;
use std::path::PathBuf;
use std::sync::Arc;

/// Steps that a style is made from.
const STEPS: usize = 24;

/// Headers of the sections.
const SECTIONS: [(&str, &str); 10] = [
    ("walk", "Walk: steps in space and time"),
    ("feet", "Feet: landing, push-off, swing"),
    ("pelvis", "Pelvis: height, sway, turns"),
    ("trunk", "Trunk"),
    ("head", "Head"),
    ("shoulders", "Shoulders"),
    ("arms", "Arms"),
    ("left", "Left side alone"),
    ("right", "Right side alone"),
    ("irregular", "Irregular: chance in every step"),
];

/// A sheet, the number of the motion that it is shown on, and the work.
type PreviewJob = (StyleSheet, u64, Job<Result<Motion, String>>);

pub(super) struct SheetPage {
    sheet: StyleSheet,
    keys: Vec<KeySpec>,
    /// Sheet that the preview shows, and the number of its motion.
    designed: Option<(StyleSheet, u64)>,
    preview: Option<Motion>,
    preview_job: Option<PreviewJob>,
    problem: Option<String>,
    playback: Playback,
    scene: SceneView,
    seed: u64,
    shows_original: bool,
    style_job: Option<Job<Result<GaitStyle, String>>>,
    style: Option<GaitStyle>,
    for_mixing: Option<GaitStyle>,
}

impl Default for SheetPage {
    fn default() -> Self {
        Self {
            sheet: StyleSheet {
                name: "mine".to_owned(),
                ..StyleSheet::default()
            },
            keys: StyleSheet::keys(),
            designed: None,
            preview: None,
            preview_job: None,
            problem: None,
            playback: Playback::playing(),
            scene: SceneView::default(),
            seed: 1,
            shows_original: true,
            style_job: None,
            style: None,
            for_mixing: None,
        }
    }
}

impl SheetPage {
    pub(super) const fn is_busy(&self) -> bool {
        self.preview_job.is_some() || self.style_job.is_some()
    }

    pub(super) fn take_for_mixing(&mut self) -> Option<GaitStyle> {
        self.for_mixing.take()
    }

    pub(super) fn poll(&mut self, shell: &mut Shell) {
        if let Some(path) = shell.picked(Purpose::OpenSheet) {
            self.open(shell, &path);
        }
        if let Some(path) = shell.picked(Purpose::SaveSheet) {
            shell.write(&path, self.sheet.to_toml().as_bytes());
        }
        if let Some(path) = shell.picked(Purpose::SaveWalk)
            && let Some(preview) = &self.preview
        {
            shell.write_motion(&path, preview.clip(), &self.sheet.name);
        }
        if let Some(path) = shell.picked(Purpose::SaveDesigned)
            && let Some(style) = &self.style
        {
            match style.to_bytes() {
                Ok(bytes) => {
                    shell.write(&path, &bytes);
                }
                Err(error) => shell.complain(error.to_string()),
            }
        }
        if let Some((sheet, opened, job)) = self.preview_job.take() {
            let mut job = Some(job);
            match finished(&mut job).map(Result::flatten) {
                Some(Ok(preview)) => {
                    if self.preview.is_none() {
                        self.playback.secs = preview.start_secs();
                    }
                    self.preview = Some(preview);
                    self.problem = None;
                    self.designed = Some((sheet, opened));
                }
                Some(Err(error)) => {
                    self.problem = Some(error);
                    self.designed = Some((sheet, opened));
                }
                None => self.preview_job = job.map(|job| (sheet, opened, job)),
            }
        }
        match finished(&mut self.style_job).map(Result::flatten) {
            Some(Ok(style)) => {
                shell.say(format!(
                    "'{}' from {} designed steps, {:.2} m/s",
                    style.name, style.provenance.steps, style.speed_mps
                ));
                self.style = Some(style);
            }
            Some(Err(error)) => shell.complain(error),
            None => {}
        }
    }

    fn open(&mut self, shell: &mut Shell, path: &std::path::Path) {
        let name = path.display();
        let read = std::fs::read_to_string(path)
            .map_err(|error| format!("{name}: {error}"))
            .and_then(|text| StyleSheet::parse(&text).map_err(|error| format!("{name}, {error}")));
        match read {
            Ok(sheet) => self.sheet = sheet,
            Err(error) => shell.complain(error),
        }
    }

    pub(super) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        self.refresh(ui.ctx(), shell);
        Panel::left("sheet")
            .default_size(330.0)
            .resizable(true)
            .show(ui, |ui| {
                self.head(ui, shell);
                ui.separator();
                ScrollArea::vertical()
                    .auto_shrink(false)
                    .show(ui, |ui| self.sliders(ui));
            });
        let Some(preview) = &self.preview else {
            ui.centered_and_justified(|ui| {
                ui.weak(self.problem.as_deref().unwrap_or(
                    "Choose a recording of a walk in the list: the sheet is shown on it.",
                ));
            });
            return;
        };
        let (start, end) = (preview.start_secs(), preview.duration_secs());
        self.playback.advance(ui, start, end);
        let rate = preview.clip().frame_rate_hz;
        self.playback.keys(ui, start, 1.0 / rate);
        if let Some(problem) = &self.problem {
            ui.colored_label(palette::BAD, problem);
        }
        Panel::bottom("design playback").show(ui, |ui| {
            ui.add_space(4.0);
            self.playback.controls(ui, start, end, rate);
            ui.checkbox(&mut self.shows_original, "Show the recording as a ghost");
        });
        let ghost = shell.current.as_ref().filter(|_| self.shows_original);
        let scene = scene_at(preview, ghost, self.playback.secs);
        let size = vec2(ui.available_width(), ui.available_height());
        self.scene.show(ui, size, &scene);
    }

    /// Designs anew when the sheet or the recording has changed; one at a time.
    fn refresh(&mut self, context: &Context, shell: &Shell) {
        let Some(motion) = &shell.current else { return };
        let is_current = self
            .designed
            .as_ref()
            .is_some_and(|(sheet, opened)| *sheet == self.sheet && *opened == shell.opened);
        if is_current || self.preview_job.is_some() {
            return;
        }
        let (sheet, seed) = (self.sheet.clone(), self.seed);
        let recording = motion.recording.clone();
        let job = job::start(context, "designing", move |_| {
            let name = sheet.name.clone();
            designed(&recording, &sheet, seed).map(|recording| Motion::of(None, name, recording))
        });
        self.preview_job = Some((self.sheet.clone(), shell.opened, job));
    }

    fn head(&mut self, ui: &mut Ui, shell: &mut Shell) {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            ComboBox::from_id_salt("shipped")
                .selected_text("Begin with…")
                .show_ui(ui, |ui| {
                    for (name, text) in shipped::SHEETS {
                        if ui.selectable_label(false, name).clicked()
                            && let Ok(sheet) = StyleSheet::parse(text)
                        {
                            self.sheet = sheet;
                        }
                    }
                });
            if ui.button("Open…").clicked() {
                shell.ask(Purpose::OpenSheet, "");
            }
            if ui.button("Save sheet…").clicked() {
                let name = format!("{}.toml", self.sheet.name.trim());
                shell.ask(Purpose::SaveSheet, &name);
            }
        });
        ui.horizontal(|ui| {
            ui.label("Name");
            ui.add(TextEdit::singleline(&mut self.sheet.name).desired_width(110.0));
            ui.label("Seed").on_hover_text("Seed of irregular steps");
            if ui.add(DragValue::new(&mut self.seed)).changed() {
                self.designed = None;
            }
        });
        ui.horizontal_wrapped(|ui| {
            if self.preview.is_some() && ui.button("Export walk…").clicked() {
                let name = format!("{}.bvh", self.sheet.name.trim());
                shell.ask(Purpose::SaveWalk, &name);
            }
            let is_free = self.style_job.is_none();
            let make = ui.add_enabled(is_free, eframe::egui::Button::new("Make the style"));
            let hint = format!("Applies the sheet to the selected recordings until there are {STEPS} steps, and adapts the base model to them");
            if make.on_hover_text(hint).clicked() {
                self.make(ui.ctx(), shell);
            }
        });
        if let Some(job) = &self.style_job {
            job::show(job, ui);
        }
        if let Some(style) = &self.style {
            ui.horizontal(|ui| {
                ui.label(format!("'{}'", style.name));
                if ui.button("Save style…").clicked() {
                    shell.ask(Purpose::SaveDesigned, &format!("{}.footstyle", style.name));
                }
                if ui.button("On the mixing pad").clicked() {
                    self.for_mixing = Some(style.clone());
                }
            });
        }
    }

    fn sliders(&mut self, ui: &mut Ui) {
        for (section, title) in SECTIONS {
            let keys = self.keys.iter().filter(|key| key.section == section);
            let keys: Vec<&KeySpec> = keys.collect();
            let sheet = &mut self.sheet;
            let changed = keys.iter().any(|key| {
                sheet
                    .value_mut(section, key.key)
                    .is_some_and(|value| !key.is_neutral(*value))
            });
            let mark = if changed { " •" } else { "" };
            CollapsingHeader::new(format!("{title}{mark}"))
                .id_salt(section)
                .default_open(section == "walk")
                .show(ui, |ui| {
                    for key in keys {
                        if let Some(value) = self.sheet.value_mut(section, key.key) {
                            slider(ui, key, value);
                        }
                    }
                });
        }
        if !self.sheet.joints.is_empty() || !self.sheet.curves.is_empty() {
            ui.weak(format!(
                "{} edits of single joints and {} curves of the sheet are kept; change them in its text.",
                self.sheet.joints.len(),
                self.sheet.curves.len()
            ));
        }
    }

    fn make(&mut self, context: &Context, shell: &mut Shell) {
        let Some(base) = shell.base() else {
            shell.complain(
                "choose a base model in Train first, such as addons/footfall/models/locomotion.footfall"
                    .to_owned(),
            );
            return;
        };
        if self.sheet.name.trim().is_empty() {
            shell.complain("give the style a name".to_owned());
            return;
        }
        let chosen = chosen_of(&shell.library);
        let (sheet, seed) = (self.sheet.clone(), self.seed);
        self.style_job = Some(job::start(context, "making the style", move |reporter| {
            style_of(&base, &chosen, &sheet, seed, reporter)
        }));
    }
}

fn slider(ui: &mut Ui, key: &KeySpec, value: &mut f32) {
    let label = key.key.replace('_', " ");
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = 120.0;
        let slider = Slider::new(value, key.range.clone())
            .suffix(format!(" {}", key.unit))
            .text(label)
            .max_decimals(1);
        ui.add(slider).on_hover_text(key.text);
        if !key.is_neutral(*value) && ui.small_button("↺").on_hover_text("No change").clicked() {
            *value = key.neutral;
        }
    });
}

fn designed(recording: &Recording, sheet: &StyleSheet, seed: u64) -> Result<Recording, String> {
    let clip = design(
        &recording.retargeted.clip,
        &recording.contacts,
        &recording.walks,
        sheet,
        seed,
    )
    .map_err(|error| error.to_string())?;
    Ok(Recording::detected(Retargeted {
        clip,
        first_frame: 0,
        report: recording.retargeted.report.clone(),
        recorded_heads: Vec::new(),
    }))
}

/// Designs recordings until there are steps enough, and adapts the base to them.
fn style_of(
    base: &Arc<GaitModel>,
    chosen: &[(PathBuf, String)],
    sheet: &StyleSheet,
    seed: u64,
    reporter: &mut Reporter,
) -> Result<GaitStyle, String> {
    let read = read_recordings(chosen, reporter).map_err(|error| error.to_string())?;
    let (mut styled, mut steps, mut problem) = (Vec::new(), 0, None);
    for (number, recording) in read.iter().enumerate() {
        if steps >= STEPS {
            break;
        }
        match designed(recording, sheet, seed.wrapping_add(number as u64)) {
            Ok(designed) => {
                steps += designed.step_count();
                styled.push(designed.of_subject(recording.subject()));
            }
            Err(error) => problem = Some(error),
        }
    }
    if styled.is_empty() {
        return Err(problem.unwrap_or_else(|| "no recording of a walk is selected".to_owned()));
    }
    adapt_to(base, &styled, sheet.name.trim(), STEPS, reporter).map(|adapted| adapted.style)
}
