//! Views beside the list, one module each.

pub(crate) mod clips;
pub(crate) mod design;
pub(crate) mod evaluate;
pub(crate) mod labels;
pub(crate) mod sensor;
pub(crate) mod train;

use crate::shell::Shell;
use eframe::egui::Context;

/// All views.
#[derive(Default)]
pub(crate) struct Views {
    pub(crate) clips: clips::ClipsView,
    pub(crate) labels: labels::LabelsView,
    pub(crate) train: train::TrainView,
    pub(crate) design: design::DesignView,
    pub(crate) sensor: sensor::SensorView,
    pub(crate) evaluate: evaluate::EvaluateView,
}

impl Views {
    /// Takes what came of work in the background, whichever view is shown.
    pub(crate) fn poll(&mut self, context: &Context, shell: &mut Shell) {
        self.clips.poll(shell);
        self.labels.poll(context, shell);
        self.train.poll(shell);
        self.design.poll(shell);
        self.sensor.poll(context, shell);
        self.evaluate.poll(shell);
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.labels.is_busy()
            || self.train.is_busy()
            || self.design.is_busy()
            || self.sensor.is_busy()
            || self.evaluate.is_busy()
    }
}
