//! Joint angles over time, linked to the playhead.

use crate::motion::{Curve, Motion};
use crate::palette;
use crate::playback::Playback;
use eframe::egui::{Stroke, Ui, Vec2b};
use egui_plot::{FilledArea, Line, LineStyle, Plot, PlotPoints, VLine};
use footfall_core::{Clip, Joint};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// More frames than this in view are drawn as the band between their lowest and highest values, for a line would be a solid block
/// of many thousand strokes.
const MOST_POINTS: usize = 1500;

/// Columns of a band.
const COLUMNS: usize = 360;

/// Values of curves, worked out once for a motion.
#[derive(Default)]
pub(crate) struct CurveCache {
    opened: u64,
    values: BTreeMap<Curve, Vec<f32>>,
}

impl CurveCache {
    /// Values of a curve; `None` where `is_late`, that is when another was worked out for this frame of the window: a long clip's
    /// take some milliseconds each, and come one by one.
    fn values(
        &mut self,
        opened: u64,
        clip: &Clip,
        curve: Curve,
        is_late: &mut bool,
    ) -> Option<&[f32]> {
        if self.opened != opened {
            self.opened = opened;
            self.values.clear();
        }
        let values = match self.values.entry(curve) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(_) if *is_late => return None,
            Entry::Vacant(place) => {
                *is_late = clip.poses.len() > MOST_POINTS;
                let frames = (0..clip.poses.len()).into_par_iter();
                place.insert(frames.map(|frame| curve.degrees(clip, frame)).collect())
            }
        };
        Some(values)
    }
}

/// Choice of the curves that are shown.
pub(crate) struct CurvePanel {
    chosen: Vec<Curve>,
    own: CurveCache,
    ghost: CurveCache,
    next: Curve,
    /// The seconds in view, as of the last frame of the window.
    in_view: Option<[f64; 2]>,
}

impl Default for CurvePanel {
    fn default() -> Self {
        Self {
            chosen: Curve::USUAL.to_vec(),
            own: CurveCache::default(),
            ghost: CurveCache::default(),
            next: Curve::new(Joint::LeftFoot, 0),
            in_view: None,
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
        if self.own.opened != opened {
            self.in_view = None;
        }
        let (mut shapes, mut is_late) = (Vec::new(), false);
        for (place, curve) in self.chosen.iter().enumerate() {
            let color = palette::SERIES[place % palette::SERIES.len()];
            let clip = motion.clip();
            if let Some(values) = self.own.values(opened, clip, *curve, &mut is_late) {
                let look = (color, LineStyle::Solid);
                let drawn = drawn(values, clip.frame_rate_hz, 0.0, self.in_view);
                shapes.push((look, drawn));
            }
            if let Some(ghost) = ghost {
                let clip = ghost.clip();
                // A ghost has no number of its own: its length and name distinguish it from another.
                let key = clip.poses.len() as u64 ^ ((ghost.name.len() as u64) << 32);
                let offset = motion.start_secs() - ghost.start_secs();
                if let Some(values) = self.ghost.values(key, clip, *curve, &mut is_late) {
                    let look = (color.gamma_multiply(0.5), LineStyle::dashed_dense());
                    let drawn = drawn(values, clip.frame_rate_hz, offset, self.in_view);
                    shapes.push((look, drawn));
                }
            }
        }
        if is_late {
            ui.ctx().request_repaint();
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
                for ((color, style), drawn) in shapes {
                    match drawn {
                        Drawn::Line(points) => plot.line(
                            Line::new("", PlotPoints::from(points))
                                .color(color)
                                .style(style)
                                .width(1.6),
                        ),
                        Drawn::Band { secs, low, high } => plot.add(
                            FilledArea::new("", &secs, &low, &high)
                                .fill_color(color.gamma_multiply(0.7)),
                        ),
                    }
                }
                plot.vline(
                    VLine::new("playhead", playback.secs)
                        .stroke(Stroke::new(1.5, palette::PLAYHEAD))
                        .allow_hover(false),
                );
                let bounds = plot.plot_bounds();
                (
                    plot.pointer_coordinate(),
                    [bounds.min()[0], bounds.max()[0]],
                )
            });
        let (pointer, in_view) = response.inner;
        self.in_view = Some(in_view);
        let is_held = response.response.is_pointer_button_down_on()
            && ui.input(|input| input.pointer.primary_down());
        if let Some(point) = pointer.filter(|_| is_held) {
            playback.secs = point.x.clamp(0.0, duration);
            playback.playing = false;
        }
    }
}

/// A curve on its way to the plot.
#[derive(Clone, Debug, PartialEq)]
enum Drawn {
    Line(Vec<[f64; 2]>),
    Band {
        secs: Vec<f64>,
        low: Vec<f64>,
        high: Vec<f64>,
    },
}

/// The frames in view; all before the first layout.
fn drawn(values: &[f32], rate_hz: f64, offset_secs: f64, in_view: Option<[f64; 2]>) -> Drawn {
    let [from, to] = in_view.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let frame = |secs: f64| ((secs - offset_secs) * rate_hz).clamp(0.0, values.len() as f64);
    let first = frame(from).floor() as usize;
    let end = ((frame(to).ceil() as usize) + 1).min(values.len());
    let frames = first..end.max(first);
    let secs = |frame: usize| frame as f64 / rate_hz + offset_secs;
    if frames.len() <= MOST_POINTS {
        let points = frames.map(|frame| [secs(frame), f64::from(values[frame])]);
        return Drawn::Line(points.collect());
    }
    let run = frames.len().div_ceil(COLUMNS);
    let (mut middles, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
    for begin in frames.clone().step_by(run) {
        let column = &values[begin..(begin + run).min(end)];
        middles.push(secs(begin) + 0.5 * column.len() as f64 / rate_hz);
        low.push(f64::from(column.iter().copied().fold(f32::MAX, f32::min)));
        high.push(f64::from(column.iter().copied().fold(f32::MIN, f32::max)));
    }
    Drawn::Band {
        secs: middles,
        low,
        high,
    }
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
    fn a_long_curve_is_a_band_that_keeps_its_extremes() {
        let mut values = vec![0.0_f32; 72_000];
        values[31_111] = 50.0;
        values[31_112] = -40.0;
        let Drawn::Band { secs, low, high } = drawn(&values, 120.0, 0.0, None) else {
            panic!("a line of 72000 points");
        };
        assert!(secs.len() <= COLUMNS, "{}", secs.len());
        let highest = high.iter().copied().fold(f64::MIN, f64::max);
        let lowest = low.iter().copied().fold(f64::MAX, f64::min);
        assert!((highest - 50.0).abs() < 1e-9 && (lowest + 40.0).abs() < 1e-9);
        assert!(secs.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn what_is_in_view_is_drawn_frame_by_frame() {
        let values: Vec<f32> = (0..72_000).map(|frame| frame as f32).collect();
        let Drawn::Line(points) = drawn(&values, 100.0, 1.0, Some([11.0, 13.0])) else {
            panic!("two seconds are no band");
        };
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-9;
        assert!(near(points[0], [11.0, 1000.0]));
        assert!(
            near(points[points.len() - 1], [13.0, 1200.0]),
            "{:?}",
            points.last()
        );
        assert_eq!(
            drawn(&values, 100.0, 0.0, Some([800.0, 900.0])),
            Drawn::Line(Vec::new())
        );
    }
}
