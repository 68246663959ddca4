//! The list.

use super::{Entry, Library, ListAction};
use crate::palette;
use eframe::egui::{ComboBox, RichText, ScrollArea, TextEdit, Ui};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Role of a recording in the views.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    None,
    Current,
    Ghost,
}

impl Library {
    /// The list with its search field. `current` and `ghost` are marked.
    pub(crate) fn show(
        &mut self,
        ui: &mut Ui,
        current: Option<&Path>,
        ghost: Option<&Path>,
    ) -> Option<ListAction> {
        ui.add(
            TextEdit::singleline(&mut self.search)
                .hint_text("Search name, category, subject")
                .desired_width(f32::INFINITY),
        );
        self.show_categories(ui);
        let wanted = self.search.to_lowercase();
        let wanted: Vec<String> = wanted.split_whitespace().map(ToOwned::to_owned).collect();
        let shown: Vec<PathBuf> = self
            .entries
            .iter()
            .filter(|(_, entry)| self.matches(entry, &wanted))
            .map(|(path, _)| path.clone())
            .collect();
        self.show_counts(ui, &shown);
        ui.separator();
        let mut action = None;
        let height = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
        ScrollArea::vertical().auto_shrink(false).show_rows(
            ui,
            height - ui.spacing().item_spacing.y,
            shown.len(),
            |ui, rows| {
                for path in &shown[rows] {
                    let mark = if current == Some(path.as_path()) {
                        Mark::Current
                    } else if ghost == Some(path.as_path()) {
                        Mark::Ghost
                    } else {
                        Mark::None
                    };
                    if let Some(asked) = self.row(ui, path, mark) {
                        action = Some(asked);
                    }
                }
            },
        );
        action
    }

    fn show_categories(&mut self, ui: &mut Ui) {
        let categories: BTreeSet<&str> = self
            .entries
            .values()
            .map(|entry| entry.category.as_str())
            .collect();
        if categories.len() < 2 {
            self.category = None;
            return;
        }
        let categories: Vec<String> = categories.into_iter().map(ToOwned::to_owned).collect();
        let shown = self
            .category
            .clone()
            .unwrap_or_else(|| "All categories".to_owned());
        ComboBox::from_id_salt("category")
            .selected_text(shown)
            .width(ui.available_width() - 8.0)
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut self.category, None, "All categories");
                for category in categories {
                    let name = category.clone();
                    ui.selectable_value(&mut self.category, Some(category), name);
                }
            });
    }

    fn show_counts(&mut self, ui: &mut Ui, shown: &[PathBuf]) {
        ui.horizontal(|ui| {
            let broken = self
                .entries
                .values()
                .filter(|entry| matches!(entry.facts, Some(Err(_))))
                .count();
            ui.label(format!("{} of {}", shown.len(), self.entries.len()));
            if broken > 0 {
                ui.colored_label(palette::BAD, format!("{broken} broken"));
            }
            if self.is_busy() {
                ui.spinner();
            }
            let all = shown.iter().all(|path| self.ticked.contains(path));
            let label = if all && !shown.is_empty() {
                "Untick"
            } else {
                "Tick all"
            };
            if ui
                .small_button(label)
                .on_hover_text("Train and Design use the ticked recordings")
                .clicked()
            {
                for path in shown {
                    if all {
                        self.ticked.remove(path);
                    } else {
                        self.ticked.insert(path.clone());
                    }
                }
            }
        });
    }

    fn matches(&self, entry: &Entry, wanted: &[String]) -> bool {
        let category = self.category.as_ref();
        if category.is_some_and(|category| *category != entry.category) {
            return false;
        }
        // Made in every frame of the window for every recording: not where nothing is looked for.
        if wanted.is_empty() {
            return true;
        }
        let text = format!("{} {} {}", entry.name, entry.category, entry.subject);
        let text = text.to_lowercase();
        wanted.iter().all(|word| text.contains(word))
    }

    fn row(&mut self, ui: &mut Ui, path: &Path, mark: Mark) -> Option<ListAction> {
        let entry = self.entries.get(path)?;
        let mut action = None;
        let mut is_ticked = self.ticked.contains(path);
        ui.horizontal(|ui| {
            ui.checkbox(&mut is_ticked, "");
            let mut text = RichText::new(&entry.name);
            if matches!(entry.facts, Some(Err(_))) {
                text = text.color(palette::BAD);
            } else if mark == Mark::Ghost {
                text = text.italics();
            }
            let label = ui.selectable_label(mark == Mark::Current, text);
            let label = label.on_hover_text(describe(path, entry));
            if label.clicked() {
                action = Some(ListAction::Open(path.to_owned()));
            }
            label.context_menu(|ui| {
                if ui.button("Show as ghost").clicked() {
                    action = Some(ListAction::Compare(path.to_owned()));
                    ui.close();
                }
            });
            if let Some(Ok(facts)) = &entry.facts {
                let mark = if facts.is_corrected { "✎ " } else { "" };
                ui.weak(format!(
                    "{mark}{:.1} s",
                    facts.frames as f64 / facts.rate_hz
                ));
            }
        });
        if is_ticked {
            self.ticked.insert(path.to_owned());
        } else {
            self.ticked.remove(path);
        }
        action
    }
}

fn describe(path: &Path, entry: &Entry) -> String {
    let facts = match &entry.facts {
        None => "not read yet".to_owned(),
        Some(Err(error)) => return error.clone(),
        Some(Ok(facts)) => format!(
            "{} frames at {} fps, {} steps, skeleton {}{}",
            facts.frames,
            facts.rate_hz,
            facts.steps,
            facts.skeleton,
            if facts.is_corrected {
                ", contacts corrected"
            } else {
                ""
            }
        ),
    };
    format!("{}\n{facts}\nRight click: show as ghost", path.display())
}
