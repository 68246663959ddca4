//! Smoothing of the hips' height: no jolts when a foot rolls off its heel, a leg's reach ends, or another foot takes over.

use super::frame::PlantedFrame;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use crate::plan::StepTiming;
use core::ops::RangeInclusive;

/// Duration below which changes of the hips' height are smoothed out, seconds.
const SMOOTHED_SECS: f32 = 0.035;
/// Approximate time from a landing to the lowest point of the hips, seconds.
const TURN_SECS: f32 = 0.05;
/// Time beyond that point for which heights are considered, seconds.
const SEEN_SECS: f32 = 0.1;
/// Weights of a height at the limit of a leg's reach, relative to a generated one, raised until no height exceeds its limit by more than the distance, metres.
const REACH_WEIGHTS: [f64; 3] = [16.0, 256.0, 4096.0];
const REACHED_M: f64 = 2e-4;
/// Maximum number of frames, including those to come; longer steps are not smoothed. Models at 60 frames a second have none.
const MOST_FRAMES: usize = 256;
/// Coefficients of a third difference: jerk.
const JERK: [f64; 4] = [-1.0, 3.0, -3.0, 1.0];
/// Frames on either side that the jerks of a frame reach to.
const BAND: usize = JERK.len() - 1;

impl Planter {
    /// Smooths the hips' height over a step, which continues from the height and the speed at the end of the previous one.
    pub(super) fn even_height(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        out: &mut [PlantedFrame],
    ) {
        let frames = &mut out[..=timing.frames];
        let Some(mut asked) = Asked::new(timing.frames, self.frame_secs) else {
            return;
        };
        for (index, frame) in frames.iter().enumerate() {
            asked.set(index, f64::from(frame.pose.root_position.y), 1.0);
        }
        let begin = f64::from(self.state.hips.y);
        let rise = self.state.hips_velocity;
        // A replanned leg may be at the end of its reach already.
        let most = self.bearing_limit(&generated[1], timing, 1, &frames[1]) - begin;
        let rise = rise.map(|velocity| f64::from(velocity.y * self.frame_secs).min(most.max(0.0)));
        asked.smooth(begin, rise);
        for weight in REACH_WEIGHTS {
            let mut beyond = false;
            for (index, frame) in frames.iter().enumerate() {
                let limit = self.bearing_limit(&generated[index], timing, index, frame);
                if asked.smoothed[index] > limit + REACHED_M {
                    beyond = true;
                    asked.set(index, asked.heights[index].min(limit), weight);
                }
            }
            if !beyond {
                break;
            }
            asked.smooth(begin, rise);
        }
        for (height, frame) in asked.smoothed.iter().zip(frames) {
            frame.pose.root_position.y = *height as f32;
        }
    }

    /// Greatest height of the hips that the bearing legs allow.
    fn bearing_limit(
        &self,
        generated: &GeneratedFrame,
        timing: &StepTiming,
        index: usize,
        frame: &PlantedFrame,
    ) -> f64 {
        let leading = timing.leading;
        let bearing = [
            (leading, true),
            (leading.other(), timing.trailing_bears(index)),
        ];
        let limits = bearing.into_iter().filter_map(|(side, bears)| {
            let hips = frame.pose.root_position;
            bears.then(|| self.reach_limit(side, hips, generated, frame))?
        });
        // The remainder of a replanned step is too short to come down by itself.
        let landing = if index == timing.frames && timing.airborne {
            self.landing_limit(generated, leading.other())
        } else {
            f32::MAX
        };
        f64::from(limits.fold(landing, f32::min))
    }
}

/// Wanted heights, with their weights. The next step is not known yet: the hips turn round at its beginning and rise
/// about as they fell, so the heights of this step are repeated backwards beyond its end.
struct Asked {
    heights: [f64; MOST_FRAMES],
    weights: [f64; MOST_FRAMES],
    /// Those heights, smooth.
    smoothed: [f64; MOST_FRAMES],
    factors: [Factors; MOST_FRAMES],
    /// The last frame of the step, the one about which it is mirrored, and how many there are in all.
    last: usize,
    turn: usize,
    count: usize,
    /// Weight of a squared jerk against a squared distance.
    stiffness: f64,
}

impl Asked {
    /// Makes room for a step that ends with this frame; `None` for steps of too few or too many frames.
    fn new(last: usize, frame_secs: f32) -> Option<Self> {
        let frames = |secs: f32| secs / frame_secs;
        let turn = last + frames(TURN_SECS).round() as usize;
        let seen = (frames(SEEN_SECS).ceil() as usize).clamp(BAND, last.max(BAND));
        let count = 2 * turn - last + seen;
        (last >= BAND && count <= MOST_FRAMES).then(|| Self {
            heights: [0.0; MOST_FRAMES],
            weights: [0.0; MOST_FRAMES],
            smoothed: [0.0; MOST_FRAMES],
            factors: [Factors::default(); MOST_FRAMES],
            last,
            turn,
            count,
            stiffness: f64::from(frames(SMOOTHED_SECS)).powi(6),
        })
    }

    /// Sets the wanted height of a frame of the step, and of its mirror image.
    fn set(&mut self, index: usize, height: f64, weight: f64) {
        self.heights[index] = height;
        self.weights[index] = weight;
        let image = 2 * self.turn - index;
        if (self.last + 1..self.count).contains(&image) {
            self.heights[image] = height;
            self.weights[image] = weight;
        }
    }

    /// Smooths the heights, the first of them given and, if that is known, how much higher the second is.
    fn smooth(&mut self, begin: f64, rise: Option<f64>) {
        let heights = &mut self.smoothed[..self.count];
        heights.copy_from_slice(&self.heights[..self.count]);
        heights[0] = begin;
        if let Some(rise) = rise {
            heights[1] = begin + rise;
        }
        let fixed = if rise.is_some() { 2 } else { 1 };
        let system = System::new(&self.weights[..self.count], self.stiffness);
        smooth(heights, &system, fixed, &mut self.factors);
    }
}

/// A row of the decomposition.
#[derive(Clone, Copy, Default)]
struct Factors {
    diagonal: f64,
    /// Coefficients of the preceding rows, nearest first.
    below: [f64; BAND],
}

/// Smooths all values but the first `fixed`: minimises the weighted squared distances to them plus the squared jerks, weighted by the
/// system's stiffness. There are more values than [`BAND`], and at most as many as `factors`.
///
/// Whittaker's smoother (On a new method of graduation, 1923): a symmetric system with [`BAND`] bands on either side of its diagonal,
/// solved by a square-root-free Cholesky decomposition.
fn smooth(values: &mut [f64], system: &System<'_>, fixed: usize, factors: &mut [Factors]) {
    let count = values.len();
    let factors = &mut factors[..count];
    for (value, weight) in values.iter_mut().zip(system.weights).skip(fixed) {
        *value *= weight;
    }
    for row in fixed..count.min(fixed + BAND) {
        for aside in row - fixed + 1..=BAND.min(row) {
            values[row] -= system.entry(row - aside, aside) * values[row - aside];
        }
    }
    let whole = (fixed + BAND).min(count);
    for row in fixed..whole {
        eliminate(values, system, factors, row, row - fixed);
    }
    // The compiler unrolls loops of known length.
    for row in whole..count {
        eliminate(values, system, factors, row, BAND);
    }
    for row in (fixed..count).rev() {
        let mut value = values[row] / factors[row].diagonal;
        let after = values[row + 1..].iter().zip(&factors[row + 1..]);
        for (aside, (next, factors)) in after.take(BAND).enumerate() {
            value -= factors.below[aside] * next;
        }
        values[row] = value;
    }
}

/// Eliminates the unknowns of the preceding rows from a row.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "only where it is inlined is the number of rows known"
)]
fn eliminate(
    values: &mut [f64],
    system: &System<'_>,
    factors: &mut [Factors],
    row: usize,
    before: usize,
) {
    let mut below = [0.0; BAND];
    let mut pivot = system.entry(row, 0);
    let mut value = values[row];
    for aside in (1..=before).rev() {
        let column = row - aside;
        let mut scaled = system.entry(column, aside);
        for far in aside + 1..=before {
            let further = &factors[row - far];
            scaled -= below[far - 1] * further.diagonal * factors[column].below[far - aside - 1];
        }
        let factor = scaled / factors[column].diagonal;
        below[aside - 1] = factor;
        pivot -= factor * scaled;
        value -= factor * values[column];
    }
    values[row] = value;
    factors[row] = Factors {
        diagonal: pivot,
        below,
    };
}

/// The smoother's system of equations.
struct System<'a> {
    weights: &'a [f64],
    stiffness: f64,
    /// Entries right of the diagonal, by distance, in rows with all jerks, without the rows' own weights.
    inner: [f64; BAND + 1],
}

impl<'a> System<'a> {
    fn new(weights: &'a [f64], stiffness: f64) -> Self {
        let inner = core::array::from_fn(|aside| stiffness * overlap(aside, aside..=BAND));
        Self {
            weights,
            stiffness,
            inner,
        }
    }

    /// Returns the entry at a distance to the right of the diagonal.
    #[inline]
    fn entry(&self, row: usize, aside: usize) -> f64 {
        let own = if aside == 0 { self.weights[row] } else { 0.0 };
        let last = self.weights.len() - 1 - BAND;
        if row + aside >= BAND && row <= last {
            return own + self.inner[aside];
        }
        let first = (row + aside).saturating_sub(BAND);
        own + self.stiffness * overlap(aside, row + aside - row.min(last)..=row + aside - first)
    }
}

/// Returns the sum of the products of two jerks' coefficients at a distance in frames, over this range of the first.
fn overlap(aside: usize, within: RangeInclusive<usize>) -> f64 {
    within.map(|index| JERK[index] * JERK[index - aside]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wavy(count: usize) -> Vec<f64> {
        let value = |index: usize| (0.7 * index as f64).sin() + 0.1 * (index % 3) as f64;
        (0..count).map(value).collect()
    }

    fn smoothed_by(values: &mut [f64], fixed: usize, stiffness: f64) {
        let weights = vec![1.0; values.len()];
        let mut factors = [Factors::default(); MOST_FRAMES];
        smooth(
            values,
            &System::new(&weights, stiffness),
            fixed,
            &mut factors,
        );
    }

    /// The slope of a sum of squares is zero at its minimum.
    #[test]
    fn nothing_else_is_nearer_and_smoother() {
        for (count, fixed, weight) in [(4, 1, 2.0), (5, 2, 3e3), (9, 0, 0.5), (40, 2, 729.0)] {
            let given = wavy(count);
            let mut smoothed = given.clone();
            smoothed_by(&mut smoothed, fixed, weight);
            assert_eq!(smoothed[..fixed], given[..fixed]);
            let mut slopes: Vec<f64> = smoothed.iter().zip(&given).map(|(s, g)| s - g).collect();
            for (first, at) in smoothed.windows(JERK.len()).enumerate() {
                let jerk: f64 = JERK
                    .iter()
                    .zip(at)
                    .map(|(share, value)| share * value)
                    .sum();
                for (aside, share) in JERK.iter().enumerate() {
                    slopes[first + aside] += weight * share * jerk;
                }
            }
            for slope in &slopes[fixed..] {
                assert!(slope.abs() < 1e-8, "{slope} of {count}");
            }
        }
    }

    #[test]
    fn what_has_no_jerk_stays_and_a_corner_is_rounded() {
        let parabola: Vec<f64> = (0..30).map(|at| 0.01 * f64::from(at * at)).collect();
        let mut smoothed = parabola.clone();
        smoothed_by(&mut smoothed, 2, 1e4);
        for (smoothed, given) in smoothed.iter().zip(&parabola) {
            assert!((smoothed - given).abs() < 1e-8);
        }
        let corner: Vec<f64> = (0..31).map(|at| f64::from((at - 15_i32).abs())).collect();
        let mut smoothed = corner.clone();
        smoothed_by(&mut smoothed, 2, 729.0);
        let bend = |values: &[f64]| {
            let bends = values.windows(3).map(|at| at[0] - 2.0 * at[1] + at[2]);
            bends.fold(0.0, |most: f64, bend| most.max(bend.abs()))
        };
        assert!(
            bend(&smoothed) < 0.25 * bend(&corner),
            "{}",
            bend(&smoothed)
        );
    }
}
