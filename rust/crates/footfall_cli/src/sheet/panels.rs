//! Draws the panels of one clip where the layout put them.

use super::Subject;
use super::curves::{PlotArea, draw_plot, draw_time_grid, draw_time_labels, plots, side_color};
use super::draw::palette::{FLOOR, GREY, GRID, INK, SHADE};
use super::draw::{Align, Canvas, lighter};
use super::figure::{View, draw_figure};
use super::layout::{Block, MARGIN, Strip};
use super::measure::Measured;
use footfall_core::{Joint, Side};
use footfall_motion::figure::sole_points;
use glam::{Vec2, Vec3};

/// Draws one clip with its corner at `corner`.
pub(crate) fn draw_block(
    canvas: &mut Canvas,
    subject: &Subject,
    measured: &Measured,
    block: &Block,
    corner: Vec2,
) {
    draw_title(canvas, subject, block, corner);
    draw_travel(canvas, subject, measured, block, corner);
    draw_path(canvas, subject, measured, block, corner);
    draw_strip(canvas, subject, measured, block, corner, Strips::Side);
    draw_strip(canvas, subject, measured, block, corner, Strips::Front);
    draw_curves(canvas, subject, measured, block, corner);
}

fn draw_title(canvas: &mut Canvas, subject: &Subject, block: &Block, corner: Vec2) {
    let anchor = corner + Vec2::new(MARGIN, block.title);
    canvas.line(
        &[
            corner + Vec2::new(MARGIN, 2.0),
            corner + Vec2::new(MARGIN + block.inner_width, 2.0),
        ],
        2.0,
        INK,
    );
    canvas.text(anchor, &subject.title, 24.0, INK, Align::Left);
    let after = canvas.text_width(&subject.title, 24.0) + 24.0;
    canvas.text(
        anchor + Vec2::X * after,
        &subject.note,
        17.0,
        GREY,
        Align::Left,
    );
    let mut x = MARGIN + block.inner_width;
    for side in [Side::Right, Side::Left] {
        x -= canvas.text_width(side.name(), 17.0);
        canvas.text(
            corner + Vec2::new(x, block.title),
            side.name(),
            17.0,
            INK,
            Align::Left,
        );
        x -= 20.0;
        canvas.rectangle(
            corner + Vec2::new(x, block.title - 11.0),
            Vec2::splat(13.0),
            side_color(side),
        );
        x -= 22.0;
    }
}

/// Figures at true scale and place over a floor with a tick every metre.
fn draw_travel(
    canvas: &mut Canvas,
    subject: &Subject,
    measured: &Measured,
    block: &Block,
    corner: Vec2,
) {
    let Some(Strip { scale, baseline }) = block.travel else {
        return;
    };
    let (low, high) = measured.ground_bounds();
    let left_edge = corner.x + MARGIN;
    // Metres along the travel that fall on the left edge, with the figures in the middle of the page.
    let spare = block.inner_width / scale - (high.x - low.x);
    let first_metre = low.x - 0.5 * spare;
    let floor = corner.y + baseline;
    panel_label(
        canvas,
        corner,
        floor - scale * measured.top - 8.0,
        "side, to scale; a tick a metre",
    );
    canvas.line(
        &[
            Vec2::new(left_edge, floor),
            Vec2::new(left_edge + block.inner_width, floor),
        ],
        1.5,
        FLOOR,
    );
    for metre in 0..=((high.x - low.x + 0.5).floor() as i32) {
        let x = left_edge + (low.x + metre as f32 - first_metre) * scale;
        canvas.line(
            &[Vec2::new(x, floor), Vec2::new(x, floor + 7.0)],
            1.5,
            FLOOR,
        );
        canvas.text(
            Vec2::new(x + 4.0, floor + 16.0),
            &format!("{metre}"),
            13.0,
            GREY,
            Align::Left,
        );
    }
    let view = View::side(
        measured.travel,
        scale,
        measured.travel * first_metre,
        Vec2::new(left_edge, floor),
    );
    for frame in &block.travel_frames {
        draw_figure(
            canvas,
            &subject.clip.skeleton,
            &measured.frames[*frame],
            &view,
        );
    }
}

/// The way of the hips and every footfall, left of the travel upwards.
fn draw_path(
    canvas: &mut Canvas,
    subject: &Subject,
    measured: &Measured,
    block: &Block,
    corner: Vec2,
) {
    let Strip { scale, baseline } = block.path;
    let (low, high) = measured.ground_bounds();
    let spare = block.inner_width / scale - (high.x - low.x);
    let first_metre = low.x - 0.5 * spare;
    let place = |point: Vec3| {
        let ground = measured.on_ground(point);
        corner
            + Vec2::new(
                MARGIN + (ground.x - first_metre) * scale,
                baseline + (high.y + 0.25 - ground.y) * scale,
            )
    };
    let top = corner.y + baseline;
    canvas.rectangle(
        Vec2::new(corner.x + MARGIN, top),
        Vec2::new(block.inner_width, (high.y - low.y + 0.5) * scale),
        SHADE,
    );
    panel_label(
        canvas,
        corner,
        top - 7.0,
        "from above; a foot where each stance has its middle, a dot every half second",
    );
    for side in Side::BOTH {
        for stance in &measured.stances[side.index()] {
            let middle = &measured.frames[usize::midpoint(stance.first, stance.last)];
            let [heel, ball, tip] = sole_points(&subject.clip.skeleton, middle, side).map(place);
            let color = side_color(side);
            let size = subject.clip.skeleton.mean_leg_length() * scale;
            canvas.limb([heel, ball], [0.04 * size, 0.055 * size], color, 1.0);
            canvas.limb([ball, tip], [0.055 * size, 0.045 * size], color, 1.0);
        }
    }
    let way: Vec<Vec2> = measured
        .frames
        .iter()
        .map(|frame| place(frame.position(Joint::Hips)))
        .collect();
    canvas.line(&way, 1.6, INK);
    let half_second = ((0.5 * measured.frame_rate_hz).round() as usize).max(1);
    for point in way.iter().step_by(half_second) {
        canvas.disc(*point, 3.0, INK, 1.0);
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Strips {
    Side,
    Front,
}

/// Poses side by side, evenly, each over its time.
fn draw_strip(
    canvas: &mut Canvas,
    subject: &Subject,
    measured: &Measured,
    block: &Block,
    corner: Vec2,
    which: Strips,
) {
    let (strip, label) = match which {
        Strips::Side => (block.side, "side; time in s"),
        Strips::Front => (block.front, "front"),
    };
    let floor = corner.y + strip.baseline;
    panel_label(
        canvas,
        corner,
        floor - strip.scale * (measured.top + 0.06) - 6.0,
        label,
    );
    canvas.line(
        &[
            Vec2::new(corner.x + MARGIN, floor),
            Vec2::new(corner.x + MARGIN + block.inner_width, floor),
        ],
        1.5,
        FLOOR,
    );
    let cell = block.inner_width / block.strip_frames.len() as f32;
    for (index, &frame) in block.strip_frames.iter().enumerate() {
        let pose = &measured.frames[frame];
        let anchor = Vec2::new(corner.x + MARGIN + (index as f32 + 0.5) * cell, floor);
        let heading = measured.headings[frame];
        let facing = Vec3::new(heading.sin(), 0.0, heading.cos());
        let origin = pose.position(Joint::Hips).with_y(0.0);
        let view = match which {
            Strips::Side => View::side(facing, strip.scale, origin, anchor),
            Strips::Front => View::front(facing, strip.scale, origin, anchor),
        };
        draw_figure(canvas, &subject.clip.skeleton, pose, &view);
        if which == Strips::Side {
            let secs = measured.start_secs() + frame as f64 / measured.frame_rate_hz;
            let below = anchor + Vec2::Y * 17.0;
            canvas.text(below, &format!("{secs:.2}"), 14.0, GREY, Align::Centre);
        }
    }
}

/// Contact bars above both columns of plots, all on one time axis.
fn draw_curves(
    canvas: &mut Canvas,
    subject: &Subject,
    measured: &Measured,
    block: &Block,
    corner: Vec2,
) {
    let area_at = |at: Vec2, height: f32| PlotArea {
        corner: corner + at,
        size: Vec2::new(block.plot_size.x, height),
        start_secs: measured.start_secs(),
        duration_secs: measured.duration_secs(),
    };
    let half_frame = 0.5 / measured.frame_rate_hz;
    let secs = |frame: usize| measured.start_secs() + frame as f64 / measured.frame_rate_hz;
    for at in block.bars {
        let area = area_at(at, 2.0 * block.bar_height + 4.0);
        canvas.rectangle(area.corner, area.size, SHADE);
        draw_time_grid(canvas, &area);
        for side in Side::BOTH {
            let row = area.corner.y + side.index() as f32 * (block.bar_height + 4.0);
            let initial = if side == Side::Left { "L" } else { "R" };
            let label = Vec2::new(area.corner.x - 6.0, row + block.bar_height - 3.0);
            canvas.text(label, initial, 14.0, GREY, Align::Right);
            for stance in &measured.stances[side.index()] {
                let from = area.x((secs(stance.first) - half_frame).max(area.start_secs));
                let to = area
                    .x((secs(stance.last) + half_frame).min(area.start_secs + area.duration_secs));
                canvas.rectangle(
                    Vec2::new(from, row),
                    Vec2::new(to - from, block.bar_height),
                    side_color(side),
                );
            }
        }
    }
    panel_label(
        canvas,
        corner,
        corner.y + block.bars[0].y - 7.0,
        "contacts, and joint curves over time in s",
    );
    for (index, plot) in plots(subject, measured).iter().enumerate() {
        let area = area_at(block.plots[index], block.plot_size.y);
        draw_plot(canvas, plot, &area, measured);
        for side in Side::BOTH {
            for stance in &measured.stances[side.index()] {
                let x = area.x(secs(stance.first));
                canvas.dashed(
                    &[
                        Vec2::new(x, area.corner.y),
                        Vec2::new(x, area.corner.y + area.size.y),
                    ],
                    1.0,
                    lighter(side_color(side), 0.35),
                    3.0,
                );
            }
        }
        if index + 2 >= block.plots.len() {
            draw_time_labels(canvas, &area);
        }
        let shown = [block.strip_frames.first(), block.strip_frames.last()];
        if let [Some(&first), Some(&last)] = shown
            && last - first + 1 < measured.frames.len()
        {
            let y = area.corner.y + area.size.y;
            canvas.line(
                &[
                    Vec2::new(area.x(secs(first)), y),
                    Vec2::new(area.x(secs(last)), y),
                ],
                3.0,
                GREY,
            );
        }
    }
    let rule = corner.y + block.height - 1.0;
    canvas.line(
        &[
            Vec2::new(corner.x + MARGIN, rule),
            Vec2::new(corner.x + MARGIN + block.inner_width, rule),
        ],
        1.0,
        GRID,
    );
}

fn panel_label(canvas: &mut Canvas, corner: Vec2, baseline: f32, text: &str) {
    canvas.text(
        Vec2::new(corner.x + MARGIN, baseline),
        text,
        14.0,
        GREY,
        Align::Left,
    );
}
