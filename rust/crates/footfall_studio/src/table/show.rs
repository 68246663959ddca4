//! A table in the window.

use super::{Cell, Table};
use crate::palette;
use eframe::egui::{Align, Color32, Grid, Layout, RichText, ScrollArea, Ui};
use egui_plot::{Bar, BarChart, Legend, Plot};

/// Bars of more rows than this are too thin to read.
const MOST_BARS: usize = 60;

impl Table {
    /// The grid.
    pub(crate) fn show(&self, ui: &mut Ui) {
        ScrollArea::horizontal()
            .id_salt((&self.title, "table"))
            .show(ui, |ui| {
                Grid::new(&self.title).striped(true).show(ui, |ui| {
                    ui.label("");
                    for column in &self.columns {
                        ui.label(RichText::new(column).strong());
                    }
                    ui.end_row();
                    for (name, cells) in &self.rows {
                        ui.label(RichText::new(name).strong());
                        let total: f64 = cells.iter().filter_map(Cell::number).sum();
                        for cell in cells {
                            let share = cell.number().unwrap_or(0.0) / total.max(1e-9);
                            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                                let text = RichText::new(cell.text());
                                if self.is_confusion {
                                    ui.label(text.background_color(shade(share)));
                                } else {
                                    ui.label(text);
                                }
                            });
                        }
                        ui.end_row();
                    }
                });
            });
    }

    /// Bars of the chosen columns, side by side for each row.
    pub(crate) fn chart(&self, ui: &mut Ui, columns: &[usize]) {
        if self.rows.len() > MOST_BARS {
            ui.weak("Too many rows for a chart; export the table instead.");
            return;
        }
        let names: Vec<String> = self.rows.iter().map(|(name, _)| name.clone()).collect();
        let width = 0.8 / columns.len().max(1) as f64;
        let charts: Vec<BarChart> = columns
            .iter()
            .enumerate()
            .map(|(place, column)| {
                let offset = (place as f64 - 0.5 * (columns.len() as f64 - 1.0)) * width;
                let bars = self
                    .numbers(*column)
                    .map(|(row, value)| Bar::new(row as f64 + offset, value).width(0.95 * width));
                let color = palette::SERIES[place % palette::SERIES.len()];
                BarChart::new(self.columns[*column].clone(), bars.collect()).color(color)
            })
            .collect();
        Plot::new((&self.title, "chart"))
            .height(220.0)
            .legend(Legend::default())
            .allow_scroll(false)
            .allow_zoom(false)
            .allow_drag(false)
            .x_axis_formatter(move |mark, _| {
                let is_row = (mark.value - mark.value.round()).abs() < 1e-6 && mark.value >= 0.0;
                let row = names.get(mark.value.round() as usize).filter(|_| is_row);
                row.cloned().unwrap_or_default()
            })
            .show(ui, |plot| {
                for chart in charts {
                    plot.bar_chart(chart);
                }
            });
    }
}

/// The darker, the more of the row.
fn shade(share: f64) -> Color32 {
    palette::RIGHT.gamma_multiply((share.clamp(0.0, 1.0) * 0.9) as f32)
}
