//! The last seconds of what is measured.

use crate::palette;
use eframe::egui::Ui;
use egui_plot::{Legend, Line, Plot, PlotPoints};
use footfall_imu::{ImuSample, OrientationFilter};
use glam::{Quat, Vec3};
use std::collections::VecDeque;

/// Seconds that are shown.
const SHOWN_SECS: f64 = 8.0;

/// Samples that are kept at most, whatever the rate.
const MOST_SAMPLES: usize = 16_000;

/// Points of a line at most.
const MOST_POINTS: usize = 1200;

/// A vector of a sample.
type Measured = fn(&ImuSample) -> Vec3;

#[derive(Default)]
pub(super) struct Signals {
    samples: VecDeque<ImuSample>,
    filter: Option<OrientationFilter>,
}

impl Signals {
    pub(super) fn push(&mut self, sample: ImuSample) {
        if !sample.is_finite() {
            return;
        }
        let dt = self
            .samples
            .back()
            .map_or(0.0, |last| sample.time_secs - last.time_secs);
        match &mut self.filter {
            Some(filter) if dt > 0.0 && dt < 0.5 => {
                filter.step(dt as f32, sample.force, sample.rate);
            }
            Some(_) if dt <= 0.0 => return,
            filter => *filter = Some(OrientationFilter::new(sample.force)),
        }
        self.samples.push_back(sample);
        while self.samples.len() > MOST_SAMPLES
            || self
                .samples
                .front()
                .is_some_and(|first| sample.time_secs - first.time_secs > SHOWN_SECS)
        {
            self.samples.pop_front();
        }
    }

    /// World from sensor, its heading at will.
    pub(super) fn orientation(&self) -> Quat {
        self.filter
            .as_ref()
            .map_or(Quat::IDENTITY, OrientationFilter::world_from_sensor)
    }

    pub(super) fn show(&self, ui: &mut Ui) {
        // The panel keeps its height: plots a little lower than it would let it shrink from frame to frame.
        ui.take_available_height();
        let height = 0.5 * (ui.available_height() - ui.spacing().item_spacing.y);
        let force: Measured = |sample| sample.force;
        let rate: Measured = |sample| sample.rate;
        let kinds = [
            ("specific force, m/s²", force),
            ("angular rate, rad/s", rate),
        ];
        let end = self.samples.back().map_or(0.0, |last| last.time_secs);
        let every = self.samples.len().div_ceil(MOST_POINTS).max(1);
        for (label, value) in kinds {
            Plot::new(label)
                .height(height.max(60.0))
                .legend(Legend::default())
                .y_axis_label(label)
                .allow_scroll(false)
                .allow_drag(false)
                .allow_zoom(false)
                .include_x(-SHOWN_SECS)
                .include_x(0.0)
                .show(ui, |plot| {
                    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                        let points: Vec<[f64; 2]> = self
                            .samples
                            .iter()
                            .step_by(every)
                            .map(|s| [s.time_secs - end, f64::from(value(s)[axis])])
                            .collect();
                        let line = Line::new(name, PlotPoints::from(points));
                        plot.line(line.color(palette::AXES[axis]).width(1.4));
                    }
                });
        }
    }
}
