//! Joint angles over time, linked to the playhead.

use crate::motion::{Curve, Motion};
use crate::palette;
use crate::playback::Playback;
use eframe::egui::{Color32, Stroke, Ui, Vec2b};
use egui_plot::{Line, LineStyle, Plot, PlotPoints, VLine};
use footfall_core::{Clip, Joint};
use std::collections::BTreeMap;

/// Points that a curve is drawn with at most: two for each pixel column of a wide window.
const MOST_POINTS: usize = 3000;

/// Values of curves, worked out once for a motion.
#[derive(Default)]
pub(crate) struct CurveCache {
    opened: u64,
    values: BTreeMap<Curve, Vec<f32>>,
}

impl CurveCache {
    fn values(&mut self, opened: u64, clip: &Clip, curve: Curve) -> &[f32] {
        if self.opened != opened {
            self.opened = opened;
            self.values.clear();
        }
        self.values.entry(curve).or_insert_with(|| {
            let frames = 0..clip.poses.len();
            frames.map(|frame| curve.degrees(clip, frame)).collect()
        })
    }
}

/// Which curves are shown.
pub(crate) struct CurvePanel {
    chosen: Vec<Curve>,
    own: CurveCache,
    ghost: CurveCache,
    next: Curve,
}

impl Default for CurvePanel {
    fn default() -> Self {
        Self {
            chosen: Curve::USUAL.to_vec(),
            own: CurveCache::default(),
            ghost: CurveCache::default(),
            next: Curve::new(Joint::LeftFoot, 0),
        }
    }
}

impl CurvePanel {
    /// The choice of curves.
    pub(crate) fn choose(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            let mut left_out = None;
            for (place, curve) in self.chosen.iter().enumerate() {
                let color = palette::SERIES[place % palette::SERIES.len()];
                let text = eframe::egui::RichText::new(format!("{} ✖", curve.name())).color(color);
                if ui.small_button(text).on_hover_text("Leave out").clicked() {
                    left_out = Some(place);
                }
            }
            if let Some(place) = left_out {
                self.chosen.remove(place);
            }
            curve_choice(ui, "next curve", &mut self.next);
            if ui.small_button("Add").clicked() && !self.chosen.contains(&self.next) {
                self.chosen.push(self.next);
            }
        });
    }

    /// The plot. Clicking or dragging moves the playhead; the wheel zooms, dragging with the right button selects.
    pub(crate) fn plot(
        &mut self,
        ui: &mut Ui,
        opened: u64,
        motion: &Motion,
        ghost: Option<&Motion>,
        playback: &mut Playback,
    ) {
        let mut lines = Vec::new();
        for (place, curve) in self.chosen.iter().enumerate() {
            let color = palette::SERIES[place % palette::SERIES.len()];
            let values = self.own.values(opened, motion.clip(), *curve);
            let rate = motion.clip().frame_rate_hz;
            lines.push(line(&curve.name(), thinned(values, rate, 0.0), color));
            if let Some(ghost) = ghost {
                let rate = ghost.clip().frame_rate_hz;
                // A ghost has no number of its own: its length and name tell it from another.
                let key = ghost.clip().poses.len() as u64 ^ ((ghost.name.len() as u64) << 32);
                let values = self.ghost.values(key, ghost.clip(), *curve);
                let offset = motion.start_secs() - ghost.start_secs();
                let pale = color.gamma_multiply(0.5);
                let line = line("", thinned(values, rate, offset), pale);
                lines.push(line.style(LineStyle::dashed_dense()));
            }
        }
        let duration = motion.duration_secs();
        let response = Plot::new("joint curves")
            .height(ui.available_height().max(120.0))
            .x_axis_label("seconds")
            .y_axis_label("degrees")
            .allow_drag(Vec2b::FALSE)
            .allow_zoom(Vec2b::new(true, false))
            .allow_scroll(Vec2b::new(true, false))
            .include_x(0.0)
            .include_x(duration)
            .show(ui, |plot| {
                for line in lines {
                    plot.line(line);
                }
                plot.vline(
                    VLine::new("playhead", playback.secs)
                        .stroke(Stroke::new(1.5, palette::PLAYHEAD))
                        .allow_hover(false),
                );
                plot.pointer_coordinate()
            });
        let is_held = response.response.is_pointer_button_down_on()
            && ui.input(|input| input.pointer.primary_down());
        if let Some(point) = response.inner.filter(|_| is_held) {
            playback.secs = point.x.clamp(0.0, duration);
            playback.playing = false;
        }
    }
}

fn line(name: &str, points: Vec<[f64; 2]>, color: Color32) -> Line<'static> {
    Line::new(name, PlotPoints::from(points))
        .color(color)
        .width(1.6)
}

/// A curve in few points: of every run of frames its lowest and its highest value, in their order.
pub(crate) fn thinned(values: &[f32], rate_hz: f64, offset_secs: f64) -> Vec<[f64; 2]> {
    let at = |frame: usize| {
        [
            frame as f64 / rate_hz + offset_secs,
            f64::from(values[frame]),
        ]
    };
    if values.len() <= MOST_POINTS {
        return (0..values.len()).map(at).collect();
    }
    let run = values.len().div_ceil(MOST_POINTS / 2);
    let mut points = Vec::with_capacity(MOST_POINTS);
    for first in (0..values.len()).step_by(run) {
        let frames = first..(first + run).min(values.len());
        let by = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let ends = [frames.clone().min_by(by), frames.max_by(by)];
        let [Some(low), Some(high)] = ends else {
            continue;
        };
        points.push(at(low.min(high)));
        if low != high {
            points.push(at(low.max(high)));
        }
    }
    points
}

/// A joint and an axis to choose.
pub(crate) fn curve_choice(ui: &mut Ui, id: &str, curve: &mut Curve) {
    use eframe::egui::ComboBox;
    ComboBox::from_id_salt((id, "joint"))
        .selected_text(curve.joint().name())
        .show_ui(ui, |ui| {
            for joint in Joint::ALL {
                ui.selectable_value(&mut curve.joint, joint.index(), joint.name());
            }
        });
    ComboBox::from_id_salt((id, "axis"))
        .selected_text(Curve::AXES[curve.axis])
        .width(60.0)
        .show_ui(ui, |ui| {
            for (axis, name) in Curve::AXES.into_iter().enumerate() {
                ui.selectable_value(&mut curve.axis, axis, name);
            }
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_extremes() {
        let mut values = vec![0.0_f32; 72_000];
        values[31_111] = 50.0;
        values[31_112] = -40.0;
        let points = thinned(&values, 120.0, 0.0);
        assert!(points.len() <= MOST_POINTS + 2, "{}", points.len());
        let highest = points.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
        let lowest = points.iter().map(|p| p[1]).fold(f64::MAX, f64::min);
        assert!((highest - 50.0).abs() < 1e-9 && (lowest + 40.0).abs() < 1e-9);
        assert!(points.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    }

    #[test]
    fn a_short_curve_is_drawn_as_it_is() {
        let points = thinned(&[1.0, 2.0, 3.0], 10.0, 1.0);
        assert_eq!(points, [[1.0, 1.0], [1.1, 2.0], [1.2, 3.0]]);
    }
}
