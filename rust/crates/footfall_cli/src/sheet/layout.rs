//! Layout of the panels of one clip. Pixels, y down, relative to the block's corner.

use super::SheetOptions;
use super::curves::PLOT_COUNT;
use super::measure::Measured;
use glam::Vec2;

/// Paper left free at both sides.
pub(crate) const MARGIN: f32 = 28.0;
const TITLE_HEIGHT: f32 = 44.0;
const LABEL_HEIGHT: f32 = 24.0;
const PLOT_HEIGHT: f32 = 112.0;
const PLOT_GAP: f32 = 26.0;
const AXIS_WIDTH: f32 = 46.0;
const BAR_HEIGHT: f32 = 16.0;
const LARGEST_SCALE: f32 = 140.0;
const LARGEST_PATH_HEIGHT: f32 = 420.0;
/// Room beside the outermost hips for limbs, metres.
const REACH_M: f32 = 0.6;
/// Width of a figure in a pose strip, metres.
const FIGURE_WIDTH_M: f32 = 1.05;
/// Time that a pose strip covers when the clip is longer: about two strides of a walk, seconds.
const STRIP_SECS: f64 = 2.2;
/// Travel between two figures of the travelling view, metres.
const FIGURE_SPACING_M: f32 = 0.6;

/// A strip that shares one scale: pixels of a metre and where its floor lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strip {
    /// Pixels of a metre.
    pub(crate) scale: f32,
    /// Row of the floor, or of the path's leftmost reach when seen from above.
    pub(crate) baseline: f32,
}

/// Panels of one clip.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Pixels down.
    pub(crate) height: f32,
    /// Baseline of the title.
    pub(crate) title: f32,
    /// The travelling view; `None` for a clip that stays in its place.
    pub(crate) travel: Option<Strip>,
    /// The path from above.
    pub(crate) path: Strip,
    /// Poses from the side.
    pub(crate) side: Strip,
    /// Poses from the front.
    pub(crate) front: Strip,
    /// Frames of the figures in the travelling view.
    pub(crate) travel_frames: Vec<usize>,
    /// Frames of the figures in the pose strips.
    pub(crate) strip_frames: Vec<usize>,
    /// Width of the paper that panels may use.
    pub(crate) inner_width: f32,
    /// Corner of the contact bars of each column.
    pub(crate) bars: [Vec2; 2],
    /// Height of one contact bar.
    pub(crate) bar_height: f32,
    /// Corners of the plots.
    pub(crate) plots: [Vec2; PLOT_COUNT],
    /// Size of every plot.
    pub(crate) plot_size: Vec2,
}

impl Block {
    /// Lays a clip out for a page of this width.
    pub(crate) fn new(measured: &Measured, options: &SheetOptions) -> Self {
        let inner_width = options.width as f32 - 2.0 * MARGIN;
        let (low, high) = measured.ground_bounds();
        let extent = high - low;
        let title = TITLE_HEIGHT - 14.0;
        let mut y = TITLE_HEIGHT;

        let travel_scale = (inner_width / (extent.x + 2.0 * REACH_M)).min(LARGEST_SCALE);
        let travels = extent.x > FIGURE_SPACING_M;
        let travel = travels.then(|| {
            y += LABEL_HEIGHT + travel_scale * measured.top;
            let strip = Strip {
                scale: travel_scale,
                baseline: y,
            };
            y += LABEL_HEIGHT;
            strip
        });
        let figures = ((extent.x / FIGURE_SPACING_M).round() as usize).clamp(2, 60);
        let travel_frames = spread(0, measured.frames.len() - 1, figures);

        let path_width = extent.y + 0.5;
        let path_scale = travel_scale.min(LARGEST_PATH_HEIGHT / path_width);
        y += LABEL_HEIGHT;
        let path = Strip {
            scale: path_scale,
            baseline: y,
        };
        y += path_scale * path_width + 8.0;

        let cell = inner_width / options.poses.max(1) as f32;
        let scale = (cell / FIGURE_WIDTH_M).min(LARGEST_SCALE);
        let mut strip = || {
            y += LABEL_HEIGHT + scale * (measured.top + 0.06);
            let strip = Strip { scale, baseline: y };
            y += LABEL_HEIGHT;
            strip
        };
        let (side, front) = (strip(), strip());
        let strip_frames = strip_frames(measured, options);

        y += LABEL_HEIGHT;
        let column = 0.5 * inner_width;
        let plot_size = Vec2::new(column - AXIS_WIDTH - 30.0, PLOT_HEIGHT);
        let left = |index: usize| MARGIN + AXIS_WIDTH + (index % 2) as f32 * column;
        let bars = [Vec2::new(left(0), y), Vec2::new(left(1), y)];
        y += 2.0 * BAR_HEIGHT + 4.0 + PLOT_GAP;
        let plots = std::array::from_fn(|index| {
            Vec2::new(
                left(index),
                y + (index / 2) as f32 * (PLOT_HEIGHT + PLOT_GAP),
            )
        });
        y += PLOT_COUNT.div_ceil(2) as f32 * (PLOT_HEIGHT + PLOT_GAP);
        Self {
            height: (y + 40.0).ceil(),
            title,
            travel,
            path,
            side,
            front,
            travel_frames,
            strip_frames,
            inner_width,
            bars,
            bar_height: BAR_HEIGHT,
            plots,
            plot_size,
        }
    }
}

/// The whole window when the user chose one or it is short, else two strides from its middle.
fn strip_frames(measured: &Measured, options: &SheetOptions) -> Vec<usize> {
    let last = measured.frames.len() - 1;
    if options.seconds.is_some() || measured.duration_secs() <= 1.5 * STRIP_SECS {
        return spread(0, last, options.poses);
    }
    let frames = (STRIP_SECS * measured.frame_rate_hz).round() as usize;
    let first = (last - frames.min(last)) / 2;
    spread(first, first + frames, options.poses)
}

/// `count` frames from `first` to `last`, both included, as even as whole frames allow, without repeats.
fn spread(first: usize, last: usize, count: usize) -> Vec<usize> {
    let intervals = count.max(2) - 1;
    let mut frames: Vec<usize> = (0..=intervals)
        .map(|index| first + ((last - first) * index + intervals / 2) / intervals)
        .collect();
    frames.dedup();
    frames
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_keeps_both_ends() {
        assert_eq!(spread(10, 20, 3), [10, 15, 20]);
        assert_eq!(spread(0, 2, 14), [0, 1, 2]);
        assert_eq!(spread(5, 5, 4), [5]);
        let many = spread(0, 343, 14);
        assert_eq!((many.len(), many[0], many[13]), (14, 0, 343));
    }
}
