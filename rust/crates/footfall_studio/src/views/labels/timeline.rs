//! The tracks: stances of both feet, steps, switches and their residual.

mod tracks;

use crate::labels::{End, Labels, StanceId};
use crate::motion::Motion;
use crate::palette;
use crate::playback::Playback;
use eframe::egui::{
    Align2, CursorIcon, FontId, Painter, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2,
};
use footfall_core::Side;
use tracks::{
    Scale, draw_detected, draw_phases, draw_residual, draw_ruler, draw_steps, draw_switches,
};

const LABEL_WIDTH: f32 = 86.0;
const ROW: f32 = 26.0;
const GAP: f32 = 6.0;

/// Distance at which the pointer grabs an end of a stance, points.
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
        let rows: Vec<Rect> = (0..7)
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
            "phases",
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
        draw_phases(&painter, &scale, rows[4], motion);
        draw_switches(&painter, &scale, rows[5], motion);
        let rest = Rect::from_min_max(rows[6].min, pos2(area.right(), whole.bottom() - 4.0));
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
