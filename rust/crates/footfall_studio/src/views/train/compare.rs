//! Average and style as curves over a stride, with the spread of their states as bands.

use crate::curves::curve_choice;
use crate::motion::Curve;
use crate::palette;
use eframe::egui::{Color32, Ui};
use egui_plot::{FilledArea, Legend, Line, Plot, PlotPoints, VLine};
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{GaitModel, StepModel};

/// Choice of the curve that is compared.
pub(super) struct Compare {
    curve: Curve,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            curve: Curve::new(Joint::LeftLowerLeg, 0),
        }
    }
}

/// A curve with a band, in percent of the stride and degrees.
struct Banded {
    percent: Vec<f64>,
    mean: Vec<f64>,
    deviation: Vec<f64>,
    /// Beginning of the right step.
    second: f64,
}

impl Compare {
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        base: Option<&GaitModel>,
        made: Option<&[StepModel; 2]>,
    ) {
        ui.horizontal(|ui| {
            curve_choice(ui, "compared", &mut self.curve);
            ui.weak("mean of every state at its middle; bands of one standard deviation");
        });
        let mut banded = Vec::new();
        if let Some(base) = base {
            banded.push(("base", palette::SERIES[7], self.banded(&base.steps)));
        }
        if let Some(steps) = made {
            banded.push(("made here", palette::LEFT, self.banded(steps)));
        }
        if banded.is_empty() {
            ui.weak("Choose a base model, or train one.");
            return;
        }
        Plot::new("compared")
            .legend(Legend::default())
            .allow_scroll(false)
            .x_axis_label("% of the stride, from the left foot's initial contact")
            .y_axis_label("degrees")
            .show(ui, |plot| {
                for (name, color, curve) in banded {
                    let lower: Vec<f64> = edges(&curve, -1.0);
                    let upper: Vec<f64> = edges(&curve, 1.0);
                    let fill: Color32 = color.gamma_multiply(0.25);
                    plot.add(
                        FilledArea::new(name, &curve.percent, &lower, &upper).fill_color(fill),
                    );
                    let points: Vec<[f64; 2]> = curve
                        .percent
                        .iter()
                        .zip(&curve.mean)
                        .map(|(x, y)| [*x, *y])
                        .collect();
                    plot.line(
                        Line::new(name, PlotPoints::from(points))
                            .color(color)
                            .width(2.0),
                    );
                    plot.vline(VLine::new("", curve.second).color(color.gamma_multiply(0.5)));
                }
            });
    }

    fn banded(&self, steps: &[StepModel; 2]) -> Banded {
        let feature = feature_offset(self.curve.joint()) + self.curve.axis;
        let states = || steps.iter().flat_map(|step| &step.states);
        let total: f64 = states().map(|state| state.duration_mean).sum();
        let mut begin = 0.0;
        let mut banded = Banded {
            percent: Vec::new(),
            mean: Vec::new(),
            deviation: Vec::new(),
            second: 0.0,
        };
        for state in states() {
            let middle = begin + 0.5 * state.duration_mean;
            begin += state.duration_mean;
            banded.percent.push(100.0 * middle / total.max(1e-9));
            banded.mean.push(state.mean[feature].to_degrees());
            banded
                .deviation
                .push(state.variance[feature].sqrt().to_degrees());
        }
        let first: f64 = steps[0]
            .states
            .iter()
            .map(|state| state.duration_mean)
            .sum();
        banded.second = 100.0 * first / total.max(1e-9);
        banded
    }
}

fn edges(curve: &Banded, sign: f64) -> Vec<f64> {
    let pairs = curve.mean.iter().zip(&curve.deviation);
    pairs
        .map(|(mean, deviation)| mean + sign * deviation)
        .collect()
}
