//! Joint curves over time, and the plots that show them.

use super::Subject;
use super::draw::palette::{GREY, GRID, INK, LEFT, RIGHT, Rgb, SHADE};
use super::draw::{Align, Canvas, lighter};
use super::measure::Measured;
use footfall_core::rotation::log_map;
use footfall_core::{Joint, ModelPose, Side};
use footfall_motion::figure::sole_points;
use glam::{Vec2, Vec3};

/// One line of a plot: a value for every frame.
pub(crate) struct Curve {
    pub(crate) color: Rgb,
    pub(crate) values: Vec<f32>,
}

/// A plot: what it shows, in which unit, and its curves.
pub(crate) struct Plot {
    pub(crate) title: &'static str,
    pub(crate) curves: Vec<Curve>,
    /// The plot always covers this range.
    pub(crate) least_range: [f32; 2],
}

/// Number of plots that [`plots`] returns.
pub(crate) const PLOT_COUNT: usize = 8;

/// Every plot of a clip, left column and right column in turn.
pub(crate) fn plots(subject: &Subject, measured: &Measured) -> [Plot; PLOT_COUNT] {
    let both = |title: &'static str,
                least_range: [f32; 2],
                value: &dyn Fn(usize, &ModelPose, Side) -> f32| Plot {
        title,
        least_range,
        curves: Side::BOTH
            .map(|side| Curve {
                color: side_color(side),
                values: measured
                    .frames
                    .iter()
                    .enumerate()
                    .map(|(frame, pose)| value(frame, pose, side))
                    .collect(),
            })
            .into(),
    };
    let one = |title: &'static str, least_range: [f32; 2], values: Vec<f32>| Plot {
        title,
        least_range,
        curves: vec![Curve { color: INK, values }],
    };
    let skeleton = &subject.clip.skeleton;
    let local = |frame: usize, joint: Joint| {
        subject.clip.poses[measured.first_frame + frame].rotation(joint)
    };
    let arm = |side: Side, n: usize| {
        let shoulder = match side {
            Side::Left => Joint::LeftShoulder,
            Side::Right => Joint::RightShoulder,
        };
        Joint::ALL[shoulder.index() + n]
    };
    let hip_heights: Vec<f32> = measured
        .frames
        .iter()
        .map(|pose| 100.0 * pose.position(Joint::Hips).y)
        .collect();
    let mean_height = hip_heights.iter().sum::<f32>() / hip_heights.len().max(1) as f32;
    [
        both("hip flexion, °", [-20.0, 30.0], &|_, pose, side| {
            let thigh = pose.rotation(Joint::Hips).inverse()
                * (pose.position(side.lower_leg()) - pose.position(side.upper_leg()));
            thigh.z.atan2(-thigh.y).to_degrees()
        }),
        one(
            "pelvis height, cm",
            [mean_height - 3.0, mean_height + 3.0],
            hip_heights,
        ),
        both("knee flexion, °", [0.0, 60.0], &|_, pose, side| {
            angle_at(pose, side.upper_leg(), side.lower_leg(), side.foot())
        }),
        both("elbow flexion, °", [0.0, 60.0], &|_, pose, side| {
            angle_at(pose, arm(side, 1), arm(side, 2), arm(side, 3))
        }),
        both(
            "ankle dorsiflexion, °",
            [-20.0, 20.0],
            &|frame, _, side| -log_map(local(frame, side.foot())).x.to_degrees(),
        ),
        both("shoulder flexion, °", [-20.0, 20.0], &|_, pose, side| {
            let upper_arm = pose.rotation(Joint::UpperChest).inverse()
                * (pose.position(arm(side, 2)) - pose.position(arm(side, 1)));
            upper_arm.z.atan2(-upper_arm.y).to_degrees()
        }),
        both("lowest sole point, cm", [-1.0, 10.0], &|_, pose, side| {
            let soles = sole_points(skeleton, pose, side);
            100.0 * soles.iter().map(|point| point.y).fold(f32::MAX, f32::min)
        }),
        one("pelvis speed, m/s", [0.0, 0.5], speeds(measured)),
    ]
}

/// The colour of a side.
pub(crate) fn side_color(side: Side) -> Rgb {
    match side {
        Side::Left => LEFT,
        Side::Right => RIGHT,
    }
}

/// 0 for a straight limb, degrees.
fn angle_at(pose: &ModelPose, above: Joint, joint: Joint, below: Joint) -> f32 {
    let upper = pose.position(joint) - pose.position(above);
    let lower = pose.position(below) - pose.position(joint);
    if upper.length() < 1e-6 || lower.length() < 1e-6 {
        return 0.0;
    }
    upper.angle_between(lower).to_degrees()
}

fn speeds(measured: &Measured) -> Vec<f32> {
    let places: Vec<Vec3> = measured
        .frames
        .iter()
        .map(|pose| pose.position(Joint::Hips).with_y(0.0))
        .collect();
    // A central difference over about a tenth of a second: capture noise would drown a shorter one.
    let reach = ((0.05 * measured.frame_rate_hz).round() as usize).max(1);
    (0..places.len())
        .map(|frame| {
            let (first, last) = (
                frame.saturating_sub(reach),
                (frame + reach).min(places.len() - 1),
            );
            let secs = (last - first) as f32 / measured.frame_rate_hz as f32;
            places[last].distance(places[first]) / secs.max(1e-6)
        })
        .collect()
}

/// The frame of a plot on the paper and the time that it spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlotArea {
    pub(crate) corner: Vec2,
    pub(crate) size: Vec2,
    pub(crate) start_secs: f64,
    pub(crate) duration_secs: f64,
}

impl PlotArea {
    /// Pixel column of a time in the clip.
    pub(crate) fn x(&self, time_secs: f64) -> f32 {
        let share = (time_secs - self.start_secs) / self.duration_secs.max(1e-9);
        self.corner.x + self.size.x * share as f32
    }
}

/// Draws one plot with its axes.
pub(crate) fn draw_plot(canvas: &mut Canvas, plot: &Plot, area: &PlotArea, measured: &Measured) {
    let values = plot.curves.iter().flat_map(|curve| &curve.values);
    let mut range = plot.least_range;
    for value in values.filter(|value| value.is_finite()) {
        range = [range[0].min(*value), range[1].max(*value)];
    }
    let margin = 0.06 * (range[1] - range[0]).max(1e-3);
    let range = [range[0] - margin, range[1] + margin];
    let bottom = area.corner.y + area.size.y;
    let y = |value: f32| bottom - area.size.y * (value - range[0]) / (range[1] - range[0]);
    canvas.rectangle(area.corner, area.size, SHADE);
    let wanted = (area.size.y / 30.0).max(2.0);
    for tick in ticks(range[0], range[1], wanted) {
        let row = y(tick);
        let color = if tick == 0.0 {
            lighter(GREY, 0.3)
        } else {
            GRID
        };
        canvas.line(
            &[
                Vec2::new(area.corner.x, row),
                Vec2::new(area.corner.x + area.size.x, row),
            ],
            1.0,
            color,
        );
        let label = tick_label(tick);
        canvas.text(
            Vec2::new(area.corner.x - 6.0, row + 4.0),
            &label,
            14.0,
            GREY,
            Align::Right,
        );
    }
    draw_time_grid(canvas, area);
    for curve in &plot.curves {
        let points: Vec<Vec2> = curve
            .values
            .iter()
            .enumerate()
            .map(|(frame, value)| {
                let secs = area.start_secs + frame as f64 / measured.frame_rate_hz;
                Vec2::new(area.x(secs), y(*value))
            })
            .collect();
        canvas.line(&points, 1.8, curve.color);
    }
    canvas.text(
        area.corner - Vec2::Y * 5.0,
        plot.title,
        15.0,
        INK,
        Align::Left,
    );
}

/// Vertical lines at round times.
pub(crate) fn draw_time_grid(canvas: &mut Canvas, area: &PlotArea) {
    let end = area.start_secs + area.duration_secs;
    for time in ticks(area.start_secs as f32, end as f32, area.size.x / 90.0) {
        let x = area.x(f64::from(time));
        canvas.line(
            &[
                Vec2::new(x, area.corner.y),
                Vec2::new(x, area.corner.y + area.size.y),
            ],
            1.0,
            GRID,
        );
    }
}

/// Round times below a plot, in seconds.
pub(crate) fn draw_time_labels(canvas: &mut Canvas, area: &PlotArea) {
    let end = area.start_secs + area.duration_secs;
    let baseline = area.corner.y + area.size.y + 15.0;
    for time in ticks(area.start_secs as f32, end as f32, area.size.x / 90.0) {
        let x = area.x(f64::from(time));
        canvas.text(
            Vec2::new(x, baseline),
            &tick_label(time),
            14.0,
            GREY,
            Align::Centre,
        );
    }
    canvas.text(
        Vec2::new(area.corner.x + area.size.x + 8.0, baseline),
        "s",
        14.0,
        GREY,
        Align::Left,
    );
}

/// Round numbers between two values, about `wanted` of them: steps of 1, 2 or 5 times a power of ten.
fn ticks(low: f32, high: f32, wanted: f32) -> Vec<f32> {
    let raw = f64::from(high - low) / f64::from(wanted.max(1.0));
    if !raw.is_finite() || raw <= 0.0 {
        return Vec::new();
    }
    let power = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| *step >= raw)
        .unwrap_or(10.0 * power);
    let first = (f64::from(low) / step).ceil() as i64;
    let last = (f64::from(high) / step).floor() as i64;
    (first..=last)
        .map(|index| (index as f64 * step) as f32)
        .collect()
}

fn tick_label(value: f32) -> String {
    let rounded = (f64::from(value) * 1000.0).round() / 1000.0;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(-21.0, 43.0, 4.0), [-20.0, 0.0, 20.0, 40.0]);
        assert_eq!(ticks(0.0, 2.85, 6.0), [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]);
        assert!(ticks(1.0, 1.0, 5.0).is_empty());
        assert_eq!(tick_label(0.1 + 0.2), "0.3");
        assert_eq!(tick_label(-0.000_01), "0");
    }
}
