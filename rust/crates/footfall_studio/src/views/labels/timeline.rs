//! The tracks: stances of both feet, steps, switches and their residual.

use crate::labels::{End, Labels, StanceId};
use crate::motion::Motion;
use crate::palette;
use crate::playback::Playback;
use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Painter, Pos2, Rect, Sense, Shape, Stroke, StrokeKind, Ui,
    pos2, vec2,
};
use footfall_core::Side;
use footfall_motion::switches;

const LABEL_WIDTH: f32 = 86.0;
const ROW: f32 = 26.0;
const GAP: f32 = 6.0;

/// An end of a stance is taken hold of so near, points.
const GRIP: f32 = 8.0;

/// The shortest stretch that can be zoomed to, seconds.
const LEAST_SPAN_SECS: f64 = 0.2;

#[derive(Default)]
pub(super) struct Timeline {
    /// Seconds at the left and at the right edge; `None` for all.
    window: Option<[f64; 2]>,
    pub(super) selected: Option<StanceId>,
    held: Option<(StanceId, End)>,
}

/// Time to place, for one frame of the window.
struct Scale {
    area: Rect,
    window: [f64; 2],
    rate_hz: f64,
}

impl Scale {
    fn x(&self, secs: f64) -> f32 {
        let share = (secs - self.window[0]) / (self.window[1] - self.window[0]);
        self.area.left() + share as f32 * self.area.width()
    }

    fn secs(&self, x: f32) -> f64 {
        let share = f64::from((x - self.area.left()) / self.area.width());
        self.window[0] + share * (self.window[1] - self.window[0])
    }

    fn frame(&self, x: f32) -> usize {
        (self.secs(x) * self.rate_hz).round().max(0.0) as usize
    }

    /// From the beginning of a frame to the end of another.
    fn span(&self, first: usize, last: usize) -> [f32; 2] {
        [
            self.x(first as f64 / self.rate_hz),
            self.x((last + 1) as f64 / self.rate_hz),
        ]
    }

    fn is_seen(&self, [left, right]: [f32; 2]) -> bool {
        right >= self.area.left() && left <= self.area.right()
    }
}

impl Timeline {
    pub(super) const fn is_dragging(&self) -> bool {
        self.held.is_some()
    }

    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        motion: &Motion,
        labels: &mut Labels,
        playback: &mut Playback,
    ) {
        let size = vec2(ui.available_width(), ui.available_height().max(200.0));
        let (response, painter) = ui.allocate_painter(size, Sense::click_and_drag());
        let whole = response.rect;
        let area = Rect::from_min_max(
            pos2(whole.left() + LABEL_WIDTH, whole.top() + 18.0),
            whole.max,
        );
        let duration = motion.duration_secs().max(LEAST_SPAN_SECS);
        let scale = Scale {
            area,
            window: self.window.unwrap_or([0.0, duration]),
            rate_hz: motion.clip().frame_rate_hz,
        };
        self.navigate(ui, &response, &scale, duration);
        let rows: Vec<Rect> = (0..6)
            .map(|row| {
                let top = area.top() + row as f32 * (ROW + GAP);
                Rect::from_min_max(pos2(area.left(), top), pos2(area.right(), top + ROW))
            })
            .collect();
        draw_ruler(&painter, ui, &scale);
        let ink = ui.visuals().text_color();
        let names = [
            "left foot",
            "right foot",
            "",
            "steps",
            "switches",
            "residual",
        ];
        for (row, name) in rows.iter().zip(names) {
            painter.text(
                pos2(whole.left() + 2.0, row.center().y),
                Align2::LEFT_CENTER,
                name,
                FontId::proportional(12.0),
                ink,
            );
            painter.rect_filled(*row, 2.0, ui.visuals().extreme_bg_color);
        }
        for (name, share) in [("by height, speed", 0.25), ("by joint angles", 0.75)] {
            painter.text(
                pos2(whole.left() + 2.0, rows[2].top() + share * rows[2].height()),
                Align2::LEFT_CENTER,
                name,
                FontId::proportional(10.0),
                ui.visuals().weak_text_color(),
            );
        }
        let painter = painter.with_clip_rect(Rect::from_min_max(
            pos2(area.left(), whole.top()),
            whole.max,
        ));
        for side in Side::BOTH {
            self.draw_stances(&painter, &scale, rows[side.index()], labels, side);
        }
        draw_detected(&painter, &scale, rows[2], motion);
        draw_steps(&painter, &scale, rows[3], motion);
        draw_switches(&painter, &scale, rows[4], motion);
        let rest = Rect::from_min_max(rows[5].min, pos2(area.right(), whole.bottom() - 4.0));
        draw_residual(&painter, &scale, rest, motion);
        let x = scale.x(playback.secs);
        painter.line_segment(
            [pos2(x, whole.top()), pos2(x, whole.bottom())],
            Stroke::new(1.5, palette::PLAYHEAD),
        );
        self.edit(ui, &response, (&scale, &rows), labels, playback);
    }

    /// The wheel zooms about the pointer; with shift it moves.
    fn navigate(
        &mut self,
        ui: &Ui,
        response: &eframe::egui::Response,
        scale: &Scale,
        duration: f64,
    ) {
        let Some(pointer) = response.hover_pos() else {
            return;
        };
        let (scroll, pinch) =
            ui.input(|input| (input.smooth_scroll_delta(), f64::from(input.zoom_delta())));
        let [from, to] = scale.window;
        let span = to - from;
        let factor = pinch * (0.004 * f64::from(scroll.y)).exp();
        let at = scale.secs(pointer.x);
        let new_span = (span / factor).clamp(LEAST_SPAN_SECS, duration);
        let share = (at - from) / span;
        let moved = -f64::from(scroll.x / scale.area.width()) * span;
        let first = (at - share * new_span + moved).clamp(0.0, duration - new_span);
        if (factor - 1.0).abs() > 1e-6 || moved.abs() > 1e-6 {
            self.window = (new_span < duration).then_some([first, first + new_span]);
        }
    }

    fn draw_stances(
        &self,
        painter: &Painter,
        scale: &Scale,
        row: Rect,
        labels: &Labels,
        side: Side,
    ) {
        for (place, span) in labels.stances(side).iter().enumerate() {
            let ends = scale.span(span.first, span.last);
            if !scale.is_seen(ends) {
                continue;
            }
            let rect = Rect::from_x_y_ranges(ends[0]..=ends[1], row.y_range().shrink(2.0));
            painter.rect_filled(rect, 3.0, palette::side(side).gamma_multiply(0.8));
            if self.selected == Some(StanceId { side, place }) {
                let stroke = Stroke::new(2.0, palette::PLAYHEAD);
                painter.rect_stroke(rect, 3.0, stroke, StrokeKind::Outside);
            }
        }
    }

    fn edit(
        &mut self,
        ui: &Ui,
        response: &eframe::egui::Response,
        (scale, rows): (&Scale, &[Rect]),
        labels: &mut Labels,
        playback: &mut Playback,
    ) {
        let Some(pointer) = response.interact_pointer_pos().or(response.hover_pos()) else {
            self.held = None;
            labels.end_drag();
            return;
        };
        let grip = grip_at(scale, rows, labels, pointer);
        if grip.is_some() || self.held.is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
        let pressed = response.is_pointer_button_down_on()
            && ui.input(|input| input.pointer.primary_pressed());
        if pressed {
            self.held = grip;
            let under = Side::BOTH
                .into_iter()
                .find(|side| rows[side.index()].contains(pointer));
            self.selected = grip
                .map(|(id, _)| id)
                .or_else(|| under.and_then(|side| labels.stance_at(side, scale.frame(pointer.x))));
        }
        if !response.is_pointer_button_down_on() {
            self.held = None;
            labels.end_drag();
        } else if let Some((id, end)) = self.held {
            let frame = match end {
                End::First => scale.frame(pointer.x),
                // The end of a stance is drawn where its last frame ends.
                End::Last => scale.frame(pointer.x).saturating_sub(1),
            };
            labels.drag(id, end, frame);
            playback.secs = frame as f64 / scale.rate_hz;
            playback.playing = false;
        } else if ui.input(|input| input.pointer.primary_down()) && pointer.x >= scale.area.left() {
            playback.secs = scale.secs(pointer.x).max(0.0);
            playback.playing = false;
        }
    }
}

/// The end of a stance under the pointer.
fn grip_at(
    scale: &Scale,
    rows: &[Rect],
    labels: &Labels,
    pointer: Pos2,
) -> Option<(StanceId, End)> {
    let side = Side::BOTH
        .into_iter()
        .find(|side| rows[side.index()].contains(pointer))?;
    let mut nearest: Option<(f32, StanceId, End)> = None;
    for (place, span) in labels.stances(side).iter().enumerate() {
        let [left, right] = scale.span(span.first, span.last);
        for (x, end) in [(left, End::First), (right, End::Last)] {
            let distance = (pointer.x - x).abs();
            if distance <= GRIP && nearest.as_ref().is_none_or(|(least, ..)| distance < *least) {
                nearest = Some((distance, StanceId { side, place }, end));
            }
        }
    }
    nearest.map(|(_, id, end)| (id, end))
}

fn draw_ruler(painter: &Painter, ui: &Ui, scale: &Scale) {
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

/// What the detectors find: heels and toes above, what joint angles alone tell below.
fn draw_detected(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
    let clip = motion.clip();
    let angles = switches::stances(&motion.switches, clip.poses.len());
    for side in Side::BOTH {
        let foot = motion.detected.foot(side);
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

fn draw_steps(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
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

fn draw_switches(painter: &Painter, scale: &Scale, row: Rect, motion: &Motion) {
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

fn draw_residual(painter: &Painter, scale: &Scale, area: Rect, motion: &Motion) {
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
