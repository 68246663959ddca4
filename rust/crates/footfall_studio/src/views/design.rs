//! Styles without a recording: a sheet with sliders, and mixtures on a pad.

mod mix;
mod sheet;

use crate::shell::Shell;
use eframe::egui::Ui;
use footfall_model::GaitStyle;
use mix::MixPage;
use sheet::SheetPage;
use std::path::Path;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Sheet,
    Mix,
}

#[derive(Default)]
pub(crate) struct DesignView {
    page: Page,
    sheet: SheetPage,
    mix: MixPage,
}

impl DesignView {
    pub(crate) const fn is_busy(&self) -> bool {
        self.sheet.is_busy()
    }

    /// Puts a style on the mixing pad.
    pub(crate) fn add_style(&mut self, shell: &mut Shell, path: &Path) {
        self.page = Page::Mix;
        self.mix.add_file(shell, path);
    }

    pub(crate) fn poll(&mut self, shell: &mut Shell) {
        self.sheet.poll(shell);
        self.mix.poll(shell);
        if let Some(style) = self.sheet.take_for_mixing() {
            self.mix_style(shell, style);
        }
    }

    /// Puts a style on the mixing pad that was made here.
    pub(crate) fn mix_style(&mut self, shell: &mut Shell, style: GaitStyle) {
        self.page = Page::Mix;
        self.mix.add(shell, style);
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell) {
        ui.horizontal(|ui| {
            ui.selectable_value(&mut self.page, Page::Sheet, "Style sheet");
            ui.selectable_value(&mut self.page, Page::Mix, "Mixing pad");
        });
        ui.separator();
        match self.page {
            Page::Sheet => self.sheet.show(ui, shell),
            Page::Mix => self.mix.show(ui, shell),
        }
    }
}
