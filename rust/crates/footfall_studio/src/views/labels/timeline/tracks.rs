//! The tracks as they are drawn.

use crate::motion::Motion;
use crate::palette;
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use footfall_core::Side;
use footfall_motion::switches;

/// Time to place, for one frame of the window.
pub(super) struct Scale {
    pub(super) area: Rect,
    pub(super) window: [f64; 2],
    pub(super) rate_hz: f64,
}

impl Scale {
    pub(super) fn x(&self, secs: f64) -> f32 {
        let share = (secs - self.window[0]) / (self.window[1] - self.window[0]);
        self.area.left() + share as f32 * self.area.width()
    }

    pub(super) fn secs(&self, x: f32) -> f64 {
        let share = f64::from((x - self.area.left()) / self.area.width());
        self.window[0] + share * (self.window[1] - self.window[0])
    }

    pub(super) fn frame(&self, x: f32) -> usize {
        (self.secs(x) * self.rate_hz).round().max(0.0) as usize
    }

    /// From the beginning of a frame to the end of another.
    pub(super) fn span(&self, first: usize, last: usize) -> [f32; 2] {
        [
            self.x(first as f64 / self.rate_hz),
            self.x((last + 1) as f64 / self.rate_hz),
        ]
    }

    pub(super) fn is_seen(&self, [left, right]: [f32; 2]) -> bool {
        right >= self.area.left() && left <= self.area.right()
    }
}

pub(super) fn draw_ruler(painter: &Painter, ui: &Ui, scale: &Scale) {
    let span = scale.window[1] - scale.window[0];
    let steps = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0];
    let step = steps
        .into_iter()
        .find(|step| span / step <= 12.0)
        .unwrap_or(600.0);
    let mut secs = (scale.window[0] / step).ceil() * step;
    while secs <= scale.window[1] {
        let x = scale.x(secs);
        painter.line_segment(
            [
                pos2(x, scale.area.top() - 4.0),
                pos2(x, scale.area.bottom()),
            ],
            Stroke::new(1.0, ui.visuals().faint_bg_color),
        );
        painter.text(
            pos2(x, scale.area.top() - 6.0),
            Align2::CENTER_BOTTOM,
            format!("{} s", (secs * 100.0).round() / 100.0),
            FontId::proportional(10.0),
            ui.visuals().weak_text_color(),
        );
        secs += step;
    }
}

/// Draws what the detectors find: contacts from heels and toes above, those from joint angles alone below.
pub(super) fn draw_detected(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
    let clip = motion.clip();
    let angles = switches::stances(&motion.switches, clip.poses.len());
    for side in Side::BOTH {
        let foot = motion.recording.detected.foot(side);
        let color = palette::side(side);
        let height = row.height() / 4.0;
        let lane = |lane: f32| {
            let top = row.top() + lane * height;
            top + 1.0..=top + height - 1.0
        };
        let lanes = [(&foot.stances, 0.0, 0.7), (&angles[side.index()], 2.0, 0.4)];
        for (spans, first, strength) in lanes {
            for span in spans {
                let ends = scale.span(span.first, span.last);
                if scale.is_seen(ends) {
                    let range = lane(first + side.index() as f32);
                    let rect = Rect::from_x_y_ranges(ends[0]..=ends[1], range);
                    painter.rect_filled(rect, 1.0, color.gamma_multiply(strength));
                }
            }
        }
    }
}

pub(super) fn draw_steps(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
    for step in motion.recording.walks.iter().flat_map(|walk| &walk.steps) {
        let ends = scale.span(step.first, step.end.saturating_sub(1));
        if !scale.is_seen(ends) {
            continue;
        }
        let rect = Rect::from_x_y_ranges(ends[0]..=ends[1], row.y_range().shrink(3.0));
        let color = palette::side(step.side);
        painter.rect_filled(
            rect.shrink2(vec2(0.5, 0.0)),
            2.0,
            color.gamma_multiply(0.35),
        );
        if rect.width() > 52.0 {
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                step.position.name().replace('_', " "),
                FontId::proportional(10.0),
                Color32::WHITE,
            );
        }
    }
}

pub(super) fn draw_phases(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
    for (number, phase) in motion.phases.iter().enumerate() {
        let ends = scale.span(phase.first, phase.end.saturating_sub(1));
        if !scale.is_seen(ends) {
            continue;
        }
        let rect = Rect::from_x_y_ranges(ends[0]..=ends[1], row.y_range().shrink(3.0));
        let color = palette::SERIES[2 + phase.kind.behaviour.index() % 6];
        let strength = if number % 2 == 0 { 0.42 } else { 0.3 };
        painter.rect_filled(rect, 0.0, color.gamma_multiply(strength));
        let name = phase.kind.to_string();
        if rect.width() > 5.5 * name.len() as f32 {
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                name,
                FontId::proportional(10.0),
                Color32::WHITE,
            );
        }
    }
}

pub(super) fn draw_switches(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
    for switch in &motion.switches {
        let x = scale.x(switch.frame as f64 / scale.rate_hz);
        if scale.is_seen([x, x]) {
            let color = palette::side(switch.side);
            painter.line_segment(
                [pos2(x, row.top() + 2.0), pos2(x, row.bottom() - 2.0)],
                Stroke::new(2.0, color),
            );
            painter.circle_filled(pos2(x, row.center().y), 4.0, color);
        }
    }
}

pub(super) fn draw_residual(painter: &Painter, scale: &Scale, area: Rect, motion: &Motion) {
    const TOP: f64 = 4.0;
    let Some(residual) = &motion.residual else {
        return;
    };
    for side in Side::BOTH {
        let values = &residual.legs[side.index()];
        let at = |index: usize| residual.first_secs + index as f64 / residual.rate_hz;
        let per_point = (values.len() as f32
            * ((scale.window[1] - scale.window[0]) / motion.duration_secs().max(1e-6)) as f32
            / scale.area.width().max(1.0))
        .ceil()
        .max(1.0) as usize;
        let points: Vec<Pos2> = values
            .chunks(per_point)
            .enumerate()
            .map(|(chunk, values)| (at(chunk * per_point), values))
            .filter(|(secs, _)| (scale.window[0]..=scale.window[1]).contains(secs))
            .map(|(secs, values)| {
                let highest = values.iter().copied().fold(0.0, f64::max).min(TOP);
                let y = area.bottom() - (highest / TOP) as f32 * area.height();
                pos2(scale.x(secs), y)
            })
            .collect();
        painter.add(Shape::line(points, Stroke::new(1.2, palette::side(side))));
    }
}
