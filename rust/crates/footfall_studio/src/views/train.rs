//! Average walks and styles from recordings, and what they look like inside.

mod compare;
mod work;

use crate::job::{self, Job, finished};
use crate::library::Library;
use crate::palette;
use crate::shell::{Purpose, Shell};
use compare::Compare;
use eframe::egui::{DragValue, Panel, RichText, ScrollArea, TextEdit, Ui};
use egui_plot::{Line, Plot, PlotPoints, Points};
use footfall_model::{GaitModel, GaitStyle};
use footfall_train::{Adapted, ContextReport, Trained, read_recordings};
use std::sync::Arc;
pub(crate) use work::{adapt_to, chosen_of};

/// Result of the last training.
enum Made {
    Average(Box<Trained>),
    Style(Box<Adapted>),
}

/// Pages on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Fit,
    Curves,
    Trees,
    Classes,
}

pub(crate) struct TrainView {
    name: String,
    steps: u32,
    iterations: u16,
    rate_hz: f64,
    job: Option<Job<Result<Made, String>>>,
    made: Option<Made>,
    /// Log-likelihoods of the work that goes on or that ended last.
    fits: Vec<f64>,
    page: Page,
    compare: Compare,
    tree: usize,
    for_mixing: Option<GaitStyle>,
}

impl Default for TrainView {
    fn default() -> Self {
        Self {
            name: "mine".to_owned(),
            steps: 12,
            iterations: 30,
            rate_hz: 60.0,
            job: None,
            made: None,
            fits: Vec::new(),
            page: Page::Fit,
            compare: Compare::default(),
            tree: 0,
            for_mixing: None,
        }
    }
}

impl TrainView {
    pub(crate) const fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// The style that is to go on the mixing pad.
    pub(crate) fn take_for_mixing(&mut self) -> Option<GaitStyle> {
        self.for_mixing.take()
    }

    fn style(&self) -> Option<&GaitStyle> {
        match &self.made {
            Some(Made::Style(adapted)) => Some(&adapted.style),
            _ => None,
        }
    }

    pub(crate) fn poll(&mut self, shell: &mut Shell) {
        if let Some(path) = shell.picked(Purpose::BaseModel) {
            shell.set_base(&path);
        }
        if let Some(path) = shell.picked(Purpose::SaveModel)
            && let Some(Made::Average(trained)) = &self.made
        {
            match trained.model.to_bytes() {
                Ok(bytes) => {
                    if shell.write(&path, &bytes) {
                        shell.base = Some((path, Arc::new(trained.model.clone())));
                    }
                }
                Err(error) => shell.complain(error.to_string()),
            }
        }
        if let Some(path) = shell.picked(Purpose::SaveStyle)
            && let Some(style) = self.style()
        {
            match style.to_bytes() {
                Ok(bytes) => {
                    shell.write(&path, &bytes);
                }
                Err(error) => shell.complain(error.to_string()),
            }
        }
        if let Some(job) = &self.job {
            self.fits = job.progress().fits;
        }
        match finished(&mut self.job).map(Result::flatten) {
            Some(Ok(made)) => {
                shell.say(describe(&made));
                if let Made::Average(trained) = &made {
                    // A training goes through several fits; the last whole one is the model's.
                    self.fits.clone_from(&trained.log_likelihoods);
                }
                self.made = Some(made);
            }
            Some(Err(error)) => shell.complain(error),
            None => {}
        }
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        let base = shell.base();
        Panel::left("training")
            .default_size(270.0)
            .resizable(true)
            .show(ui, |ui| {
                ScrollArea::vertical().show(ui, |ui| self.settings(ui, shell, base.as_ref()));
            });
        ui.horizontal(|ui| {
            let pages = [
                (Page::Fit, "Fit"),
                (Page::Curves, "Curves"),
                (Page::Trees, "Decision trees"),
                (Page::Classes, "Regression classes"),
            ];
            for (page, name) in pages {
                ui.selectable_value(&mut self.page, page, name);
            }
        });
        ui.separator();
        match self.page {
            Page::Fit => self.show_fit(ui),
            Page::Curves => {
                let made = match &self.made {
                    Some(Made::Average(trained)) => Some(&trained.model.steps),
                    Some(Made::Style(adapted)) => Some(&adapted.style.steps),
                    None => None,
                };
                self.compare.show(ui, base.as_deref(), made);
            }
            Page::Trees => match &self.made {
                Some(Made::Average(trained)) => show_trees(ui, &trained.contexts, &mut self.tree),
                _ => {
                    ui.weak("Train an average walk to see which steps of a walk share a model.");
                }
            },
            Page::Classes => match &self.made {
                Some(Made::Style(adapted)) => show_classes(ui, adapted),
                _ => {
                    ui.weak("Make a style to see which states were moved together.");
                }
            },
        }
    }

    fn settings(&mut self, ui: &mut Ui, shell: &mut Shell, base: Option<&Arc<GaitModel>>) {
        ui.add_space(4.0);
        let chosen = shell.library.chosen().len();
        let ticked = shell.library.ticked();
        ui.label(if ticked == 0 {
            format!("Recordings: all of the list that can be used, {chosen} (tick some to choose)")
        } else {
            format!("Recordings: those that are ticked, {chosen}")
        });
        ui.separator();
        ui.strong("A style from a dozen steps");
        ui.horizontal(|ui| {
            if ui.button("Base model…").clicked() {
                shell.ask(Purpose::BaseModel, "");
            }
            let name = shell.base.as_ref().and_then(|(path, _)| path.file_name());
            ui.weak(name.map_or_else(|| "none".into(), |name| name.to_string_lossy().into_owned()));
        });
        ui.horizontal(|ui| {
            ui.label("Name");
            ui.add(TextEdit::singleline(&mut self.name).desired_width(120.0));
        });
        ui.horizontal(|ui| {
            ui.label("Steps");
            ui.add(DragValue::new(&mut self.steps).range(2..=10_000));
        });
        let is_free = self.job.is_none();
        ui.add_enabled_ui(is_free, |ui| {
            if ui.button("Make the style").clicked() {
                self.adapt(ui, shell, base);
            }
        });
        if let Some(style) = self.style().cloned() {
            ui.horizontal(|ui| {
                if ui.button("Save the style…").clicked() {
                    shell.ask(Purpose::SaveStyle, &format!("{}.footstyle", style.name));
                }
                if ui.button("On the mixing pad").clicked() {
                    self.for_mixing = Some(style);
                }
            });
        }
        ui.separator();
        ui.strong("An average walk");
        ui.horizontal(|ui| {
            ui.label("Frames per second");
            ui.add(DragValue::new(&mut self.rate_hz).range(20.0..=240.0));
        });
        ui.horizontal(|ui| {
            ui.label("Most iterations");
            ui.add(DragValue::new(&mut self.iterations).range(1..=500));
        });
        ui.add_enabled_ui(is_free, |ui| {
            if ui.button("Train a model").clicked() {
                self.train(ui, &shell.library);
            }
        });
        if matches!(self.made, Some(Made::Average(_))) && ui.button("Save the model…").clicked() {
            shell.ask(Purpose::SaveModel, "walk.footfall");
        }
        ui.separator();
        if let Some(job) = &self.job {
            job::show(job, ui);
        }
        if let Some(made) = &self.made {
            ui.label(describe(made));
        }
    }

    fn adapt(&mut self, ui: &Ui, shell: &mut Shell, base: Option<&Arc<GaitModel>>) {
        let name = self.name.trim().to_owned();
        if name.is_empty() {
            shell.complain("a style needs a name; enter one".to_owned());
            return;
        }
        let Some(base) = base.cloned() else {
            shell.complain(
                "choose the base model, such as addons/footfall/models/locomotion.footfall"
                    .to_owned(),
            );
            return;
        };
        let chosen = chosen_of(&shell.library);
        let steps = self.steps as usize;
        self.fits.clear();
        self.page = Page::Fit;
        self.job = Some(job::start(ui.ctx(), "making the style", move |reporter| {
            let recorded = read_recordings(&chosen, reporter).map_err(|error| error.to_string())?;
            let made = adapt_to(&base, &recorded, &name, steps, reporter)?;
            Ok(Made::Style(Box::new(made)))
        }));
    }

    fn train(&mut self, ui: &Ui, library: &Library) {
        let chosen = chosen_of(library);
        let (rate_hz, iterations) = (self.rate_hz, usize::from(self.iterations));
        self.fits.clear();
        self.page = Page::Fit;
        self.job = Some(job::start(ui.ctx(), "training", move |reporter| {
            let recorded = read_recordings(&chosen, reporter).map_err(|error| error.to_string())?;
            let made = work::train(&recorded, rate_hz, iterations, reporter)?;
            Ok(Made::Average(Box::new(made)))
        }));
    }

    fn show_fit(&self, ui: &mut Ui) {
        if self.fits.is_empty() {
            ui.weak(
                "How well the model explains the recordings, after every iteration, appears here.",
            );
            return;
        }
        let points = || -> Vec<[f64; 2]> {
            let fits = self.fits.iter().enumerate();
            fits.map(|(iteration, fit)| [iteration as f64 + 1.0, *fit])
                .collect()
        };
        Plot::new("fit")
            .x_axis_label("iteration")
            .y_axis_label("log-likelihood")
            .allow_scroll(false)
            .show(ui, |plot| {
                plot.line(
                    Line::new("log-likelihood", PlotPoints::from(points())).color(palette::RIGHT),
                );
                plot.points(
                    Points::new("log-likelihood", PlotPoints::from(points()))
                        .radius(3.0)
                        .color(palette::LEFT),
                );
            });
    }
}

fn describe(made: &Made) -> String {
    match made {
        Made::Average(trained) => {
            let [slowest, fastest] = trained.model.speed_range();
            let from = &trained.model.provenance;
            format!(
                "An average walk from {} steps of {} walkers, {slowest:.2} to {fastest:.2} m/s",
                from.steps, from.subjects
            )
        }
        Made::Style(adapted) => format!(
            "'{}' from {} steps, {:.2} m/s, {:.0} steps a minute, {} classes",
            adapted.style.name,
            adapted.style.provenance.steps,
            adapted.style.speed_mps,
            60.0 * adapted.style.cadence_hz,
            adapted.classes.len()
        ),
    }
}

fn show_trees(ui: &mut Ui, contexts: &ContextReport, chosen: &mut usize) {
    ui.label(format!(
        "{} different step models are left of the ten contexts (five places in a walk, two feet).",
        contexts.models
    ));
    ui.horizontal_wrapped(|ui| {
        for (place, tree) in contexts.trees.iter().enumerate() {
            ui.selectable_value(chosen, place, &tree.name);
        }
    });
    let Some(tree) = contexts.trees.get(*chosen) else {
        return;
    };
    ScrollArea::both().show(ui, |ui| {
        for line in &tree.lines {
            ui.horizontal(|ui| {
                ui.add_space(22.0 * line.depth as f32);
                match line.answer {
                    Some(true) => ui.colored_label(palette::GOOD, "yes →"),
                    Some(false) => ui.colored_label(palette::BAD, "no →"),
                    None => ui.label(""),
                };
                ui.label(&line.text);
            });
        }
    });
}

fn show_classes(ui: &mut Ui, adapted: &Adapted) {
    let states = adapted.style.steps[0].states.len();
    ui.label("States of the two steps, coloured by the transforms that moved them. States of one colour were moved together.");
    ui.add_space(6.0);
    for (side, name) in ["left step", "right step"].into_iter().enumerate() {
        ui.horizontal(|ui| {
            ui.add_sized([80.0, 30.0], eframe::egui::Label::new(name));
            for state in 0..states {
                let number = side * states + state;
                let class = adapted
                    .classes
                    .iter()
                    .position(|class| class.contains(&number));
                let color = palette::SERIES[class.unwrap_or(7) % palette::SERIES.len()];
                let label = RichText::new(format!(" state {} ", state + 1))
                    .background_color(color)
                    .color(eframe::egui::Color32::BLACK);
                ui.label(label);
            }
        });
    }
    ui.add_space(6.0);
    for (class, members) in adapted.classes.iter().enumerate() {
        ui.label(format!("class {}: {} states", class + 1, members.len()));
    }
    let [base, moved, refined] = adapted.log_likelihoods;
    ui.add_space(6.0);
    ui.label(format!(
        "Log-likelihood of the steps: {base:.0} under the base model, {moved:.0} under the transforms, {refined:.0} under the style."
    ));
}
