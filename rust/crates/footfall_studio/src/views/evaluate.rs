//! The papers' tables as tables and charts.

use crate::evaluation::{EvaluateKind, EvaluateRequest, evaluate};
use crate::job::{self, Job, finished};
use crate::shell::{Purpose, Shell};
use crate::table::Table;
use eframe::egui::{ComboBox, ScrollArea, TextEdit, Ui};
use std::path::PathBuf;

#[derive(Default)]
pub(crate) struct EvaluateView {
    request: EvaluateRequest,
    conditions: String,
    job: Option<Job<Result<Vec<Table>, String>>>,
    tables: Vec<Table>,
    chosen: usize,
    columns: Vec<usize>,
}

impl EvaluateView {
    pub(crate) const fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Judges recordings that an index lists.
    pub(crate) fn set_index(&mut self, index: PathBuf) {
        self.request.index = index;
    }

    pub(crate) fn poll(&mut self, shell: &mut Shell) {
        if let Some(path) = shell.picked(Purpose::EvaluateIndex) {
            self.request.index = path;
        }
        if let Some(path) = shell.picked(Purpose::EvaluateSynthesised) {
            self.request.synthesised = Some(path);
        }
        if let Some(path) = shell.picked(Purpose::SaveTable)
            && let Some(table) = self.tables.get(self.chosen)
        {
            match table.to_csv() {
                Ok(bytes) => {
                    shell.write(&path, &bytes);
                }
                Err(error) => shell.complain(error),
            }
        }
        if let Some(path) = shell.picked(Purpose::SaveChart)
            && let Some(table) = self.tables.get(self.chosen)
        {
            match table.to_svg(&self.columns) {
                Ok(svg) => {
                    shell.write(&path, svg.as_bytes());
                }
                Err(error) => shell.complain(error),
            }
        }
        match finished(&mut self.job).map(Result::flatten) {
            Some(Ok(tables)) => self.take(tables),
            Some(Err(error)) => shell.complain(error),
            None => {}
        }
    }

    /// Shows the tables of a report.
    fn take(&mut self, tables: Vec<Table>) {
        self.tables = tables;
        // What is judged stands before the summary of it.
        let best = self
            .tables
            .iter()
            .position(|table| table.rows.len() > 1 && table.columns.len() > 1);
        self.choose(best.unwrap_or(0));
    }

    fn choose(&mut self, table: usize) {
        self.chosen = table;
        let columns = self.tables.get(table).map(Table::numeric_columns);
        self.columns = columns.unwrap_or_default().into_iter().take(3).collect();
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        ui.horizontal_wrapped(|ui| {
            ComboBox::from_label("")
                .selected_text(self.request.kind.title())
                .width(240.0)
                .show_ui(ui, |ui| {
                    for kind in EvaluateKind::ALL {
                        ui.selectable_value(&mut self.request.kind, kind, kind.title());
                    }
                });
            if ui
                .button("Index…")
                .on_hover_text("Index of the recordings: columns path, category, style, subject")
                .clicked()
            {
                shell.ask(Purpose::EvaluateIndex, "");
            }
            ui.weak(file_name(&self.request.index));
            if self.request.kind == EvaluateKind::Style {
                if ui
                    .button("Synthesised…")
                    .on_hover_text("Index of synthesised walks, with the same style names")
                    .clicked()
                {
                    shell.ask(Purpose::EvaluateSynthesised, "");
                }
                if let Some(path) = &self.request.synthesised {
                    ui.weak(file_name(path));
                }
            }
        });
        ui.horizontal(|ui| {
            ui.add(
                TextEdit::singleline(&mut self.conditions)
                    .hint_text("Conditions, such as category=styled_walk path=cmu/*")
                    .desired_width(360.0),
            );
            if let Some(job) = &self.job {
                job::show(job, ui);
            } else if ui.button("Run the evaluation").clicked() {
                self.start(ui, shell);
            }
        });
        ui.weak(self.request.kind.explanation());
        ui.separator();
        if self.tables.is_empty() {
            ui.weak("Choose an index and evaluate; tables and charts appear here.");
            return;
        }
        let mut chosen = self.chosen;
        ui.horizontal_wrapped(|ui| {
            for (place, table) in self.tables.iter().enumerate() {
                ui.selectable_value(&mut chosen, place, &table.title);
            }
        });
        if chosen != self.chosen {
            self.choose(chosen);
        }
        let Some(table) = self.tables.get(self.chosen) else {
            return;
        };
        ui.horizontal(|ui| {
            if ui.button("Export CSV…").clicked() {
                shell.ask(Purpose::SaveTable, "table.csv");
            }
            if ui.button("Export SVG…").clicked() {
                shell.ask(Purpose::SaveChart, "chart.svg");
            }
        });
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            if !table.is_confusion {
                ui.horizontal_wrapped(|ui| {
                    for column in table.numeric_columns() {
                        let mut is_shown = self.columns.contains(&column);
                        if ui.checkbox(&mut is_shown, &table.columns[column]).changed() {
                            if is_shown {
                                self.columns.push(column);
                            } else {
                                self.columns.retain(|own| *own != column);
                            }
                        }
                    }
                });
                table.chart(ui, &self.columns);
            }
            table.show(ui);
        });
    }

    fn start(&mut self, ui: &Ui, shell: &mut Shell) {
        if self.request.index.as_os_str().is_empty() {
            shell.complain("choose the index of the recordings first".to_owned());
            return;
        }
        self.request.conditions = self
            .conditions
            .split_whitespace()
            .map(ToOwned::to_owned)
            .collect();
        let request = self.request.clone();
        self.job = Some(job::start(ui.ctx(), "evaluating", move |reporter| {
            evaluate(&request, reporter)
        }));
    }
}

fn file_name(path: &std::path::Path) -> String {
    path.file_name().map_or_else(
        || "none chosen".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}
