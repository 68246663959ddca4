//! Fine motion: the detail that trajectories of states lack, a common part and noise, added to a solved step.
//!
//! Both are given at points of the step's phase and interpolated smoothly. Points before and after the step are those of its neighbours,
//! so that steps join without a jump. Noise needs no memory: the number of a step seeds independent values at its points,
//! and the noise at a point is a weighted sum of the values around it.

use crate::hash::mixed;
use crate::plan::{FineDraw, StepPlan};
use crate::rows::Sum as _;
use footfall_core::Side;
use footfall_core::ease::{catmull_rom, smooth_step};
use footfall_model::{
    FEATURE_COUNT, FINE_POINTS, FINE_REACH, FINE_TAPS, FineMotion, GaitModel, MAX_FINE_DIRECTIONS,
};
use multiversion::multiversion;

/// Points that a step's curves go through: its own, one before and two after.
const KNOTS: usize = FINE_POINTS + 3;

/// Points whose independent values influence them.
const SOURCES: usize = KNOTS + 2 * FINE_REACH;

/// Independent values that one call of the generator gives.
const AT_ONCE: usize = 4;

/// One factor per feature.
pub(crate) type Scale = [f32; FEATURE_COUNT];

/// The fine motion of a model, ready to be added.
#[derive(Debug)]
pub(crate) struct FineTables {
    /// Per side, rows of the [`KNOTS`] of a step: the common part, then each walker component.
    tables: [Vec<Vec<f32>>; 2],
    /// For each tap the weights of all directions.
    kernels: [[f32; MAX_FINE_DIRECTIONS]; FINE_TAPS],
    /// Four at a time, the last filled up with zeros.
    directions: Vec<[[f32; FEATURE_COUNT]; 4]>,
}

/// Previous, shown and next step. A missing one has no noise.
pub(crate) type Neighbours = [FineDraw; 3];

/// Working memory for a step's fine motion.
#[derive(Debug)]
pub(crate) struct FineBuffers {
    sources: Vec<[f32; MAX_FINE_DIRECTIONS]>,
    knots: Vec<f32>,
}

impl FineTables {
    /// Prepares the tables of a model; `None` if it has no fine motion.
    pub(crate) fn of(model: &GaitModel) -> Option<Self> {
        let fine = model.fine.as_ref()?;
        let all = core::iter::once(&fine.shared).chain(&fine.walker);
        let tables = Side::BOTH.map(|side| {
            let knots = |table: &[Vec<f64>; 2]| -> Vec<f32> {
                (0..KNOTS)
                    .flat_map(|knot| {
                        let point = knot + FINE_POINTS - 1;
                        let of = (side.index() + point / FINE_POINTS + 1) % 2;
                        let row = point % FINE_POINTS * FEATURE_COUNT;
                        table[of][row..row + FEATURE_COUNT].iter()
                    })
                    .map(|value| *value as f32)
                    .collect()
            };
            all.clone().map(knots).collect()
        });
        Some(Self {
            tables,
            kernels: by_tap(&fine.chance.kernels),
            directions: in_fours(&fine.chance.directions),
        })
    }

    /// Factors on the features in a mixture of styles.
    pub(crate) fn scale(fine: &FineMotion) -> Scale {
        core::array::from_fn(|feature| fine.scale[feature] as f32)
    }
}

impl FineBuffers {
    /// Makes buffers for any step.
    pub(crate) fn new() -> Self {
        Self {
            sources: vec![[0.0; MAX_FINE_DIRECTIONS]; SOURCES],
            knots: vec![0.0; KNOTS * FEATURE_COUNT],
        }
    }

    /// Writes the knots of the step in the middle, which `side` begins.
    pub(crate) fn prepare(&mut self, tables: &FineTables, side: Side, steps: &Neighbours) {
        let [_, step, _] = steps;
        let rows = &tables.tables[side.index()];
        self.knots.copy_from_slice(&rows[0]);
        let pairs = rows[1..].iter().zip(step.walker);
        add_all(
            &mut self.knots,
            pairs.map(|(row, weight)| (row.as_slice(), weight)),
        );
        if steps.iter().all(|step| step.strength <= 0.0) {
            return;
        }
        for (index, source) in self.sources.iter_mut().enumerate() {
            // Counted from the first point of the step before.
            let point = index + FINE_POINTS - 1 - FINE_REACH;
            let own = &steps[point / FINE_POINTS];
            fill(source, own, point % FINE_POINTS);
        }
        add_noise(&mut self.knots, &self.sources, tables);
    }

    /// Adds this share of the prepared motion to the features of the frame at part `s` of the step. `scales` are those before and after the step.
    pub(crate) fn add(&self, s: f32, share: f32, scales: [&Scale; 2], features: &mut [f32]) {
        let at = s * FINE_POINTS as f32;
        // A cast rounds towards zero, and a part is not below it.
        let cell = (at as usize).min(FINE_POINTS - 1);
        let weights = catmull_rom(at - cell as f32).map(|weight| share * weight);
        let knots = &self.knots[cell * FEATURE_COUNT..][..4 * FEATURE_COUNT];
        add_between(features, knots, weights, scales, smooth_step(s));
    }
}

#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn add_between(
    features: &mut [f32],
    knots: &[f32],
    weights: [f32; 4],
    scales: [&Scale; 2],
    change: f32,
) {
    let (first, rest) = knots.split_at(FEATURE_COUNT);
    let (second, rest) = rest.split_at(FEATURE_COUNT);
    let (third, fourth) = rest.split_at(FEATURE_COUNT);
    let knots = first.iter().zip(second).zip(third.iter().zip(fourth));
    let scales = scales[0].iter().zip(scales[1]);
    for ((feature, ((a, b), (c, d))), (before, after)) in features.iter_mut().zip(knots).zip(scales)
    {
        let value = (weights[0] * a + weights[1] * b) + (weights[2] * c + weights[3] * d);
        *feature += (before + change * (after - before)) * value;
    }
}

/// Kernels with all directions' weights at a tap side by side.
fn by_tap(kernels: &[Vec<f64>]) -> [[f32; MAX_FINE_DIRECTIONS]; FINE_TAPS] {
    core::array::from_fn(|tap| {
        core::array::from_fn(|direction| kernels.get(direction).map_or(0.0, |k| k[tap] as f32))
    })
}

/// Directions four at a time, the last filled up with zeros.
fn in_fours(directions: &[Vec<f64>]) -> Vec<[[f32; FEATURE_COUNT]; 4]> {
    let row = |row: Option<&Vec<f64>>| {
        core::array::from_fn(|feature| row.map_or(0.0, |row| row[feature] as f32))
    };
    let fours = directions.chunks(4);
    fours
        .map(|four| core::array::from_fn(|index| row(four.get(index))))
        .collect()
}

/// Adds to each knot the directions by the weighted sums of the sources around it.
#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn add_noise(knots: &mut [f32], sources: &[[f32; MAX_FINE_DIRECTIONS]], tables: &FineTables) {
    for (knot, row) in knots.chunks_exact_mut(FEATURE_COUNT).enumerate() {
        let mut along = [0.0; MAX_FINE_DIRECTIONS];
        for (source, weights) in sources[knot..].iter().zip(&tables.kernels) {
            for ((sum, value), weight) in along.iter_mut().zip(source).zip(weights) {
                *sum += weight * value;
            }
        }
        for ([a, b, c, d], weights) in tables.directions.iter().zip(along.as_chunks().0) {
            let [wa, wb, wc, wd] = *weights;
            f32::add_rows_inline(row, [(a, wa), (b, wb), (c, wc), (d, wd)]);
        }
    }
}

/// Independent numbers of variance 1 at a point of a step.
fn fill(source: &mut [f32; MAX_FINE_DIRECTIONS], step: &FineDraw, point: usize) {
    // Uniform values suffice: sums of many are nearly normal.
    let width = step.strength * 12.0_f32.sqrt();
    let mut sixteens = [0_u16; MAX_FINE_DIRECTIONS];
    for (values, key) in sixteens.as_chunks_mut().0.iter_mut().zip(KEYS[point]) {
        let bits = mixed(step.number ^ key);
        *values = [bits, bits >> 16, bits >> 32, bits >> 48].map(|bits| bits as u16);
    }
    for (value, sixteen) in source.iter_mut().zip(sixteens) {
        *value = width * ((f32::from(sixteen) + 0.5) / 65536.0 - 0.5);
    }
}

/// Keys of the generator for each point.
const KEYS: [[u64; MAX_FINE_DIRECTIONS / AT_ONCE]; FINE_POINTS] = {
    let mut keys = [[0; MAX_FINE_DIRECTIONS / AT_ONCE]; FINE_POINTS];
    let mut point = 0;
    while point < FINE_POINTS {
        let mut index = 0;
        while index < MAX_FINE_DIRECTIONS / AT_ONCE {
            keys[point][index] = mixed((point * MAX_FINE_DIRECTIONS + index) as u64);
            index += 1;
        }
        point += 1;
    }
    keys
};

/// Adds weighted rows, four at a time.
fn add_all<'a>(sums: &mut [f32], rows: impl Iterator<Item = (&'a [f32], f32)>) {
    let mut rows = rows.peekable();
    while let Some(first) = rows.peek().map(|(row, _)| *row) {
        let four: [(&[f32], f32); 4] =
            core::array::from_fn(|_| rows.next().unwrap_or((first, 0.0)));
        f32::add_rows(sums, four);
    }
}

/// The fine motion of a plan and of its neighbours, of which the first and the last may be missing.
pub(crate) fn neighbours<R>(plans: &[StepPlan<R>], index: usize) -> Neighbours {
    let draw = |index: Option<usize>| {
        let plan = index.and_then(|index| plans.get(index));
        plan.map_or_else(FineDraw::default, |plan| plan.fine)
    };
    [
        draw(index.checked_sub(1)),
        draw(Some(index)),
        draw(Some(index + 1)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = [1.0; FEATURE_COUNT];

    /// Two directions, a kernel of two taps, and a wave that all steps share.
    fn tables() -> FineTables {
        let wave = |side: f32| -> Vec<f32> {
            (0..KNOTS * FEATURE_COUNT)
                .map(|index| {
                    let point = side * FINE_POINTS as f32 + (index / FEATURE_COUNT) as f32 - 1.0;
                    (core::f32::consts::PI * point / FINE_POINTS as f32).sin()
                })
                .collect()
        };
        let mut kernel = vec![0.0; FINE_TAPS];
        kernel[FINE_REACH - 1] = 0.6;
        kernel[FINE_REACH] = 0.8;
        let direction = |first: usize, value: f64| {
            let mut row = vec![0.0; FEATURE_COUNT];
            row[first] = value;
            row[first + 1] = -value;
            row
        };
        FineTables {
            tables: [0.0, 1.0].map(|side| vec![wave(side)]),
            kernels: by_tap(&[kernel.clone(), kernel]),
            directions: in_fours(&[direction(0, 0.5), direction(10, 0.25)]),
        }
    }

    fn draw(number: u64) -> FineDraw {
        FineDraw {
            strength: 1.0,
            number,
            ..FineDraw::default()
        }
    }

    fn at(buffers: &FineBuffers, s: f32) -> [f32; FEATURE_COUNT] {
        let mut features = [0.0; FEATURE_COUNT];
        buffers.add(s, 1.0, [&SCALE; 2], &mut features);
        features
    }

    #[test]
    fn a_step_begins_where_and_as_fast_as_the_one_before_ends() {
        let (tables, mut buffers) = (tables(), FineBuffers::new());
        let steps = [3, 8, 2, 11].map(draw);
        buffers.prepare(&tables, Side::Left, &[steps[0], steps[1], steps[2]]);
        let (last, end) = (at(&buffers, 0.999), at(&buffers, 1.0));
        buffers.prepare(&tables, Side::Right, &[steps[1], steps[2], steps[3]]);
        let (start, second) = (at(&buffers, 0.0), at(&buffers, 0.001));
        for feature in 0..FEATURE_COUNT {
            assert!((start[feature] - end[feature]).abs() < 1e-6);
            let speeds = [
                end[feature] - last[feature],
                second[feature] - start[feature],
            ];
            assert!((speeds[1] - speeds[0]).abs() < 2e-3, "{speeds:?}");
        }
        // With another neighbour there is a jump, so the join is no accident.
        buffers.prepare(&tables, Side::Right, &[steps[0], steps[2], steps[3]]);
        assert!((at(&buffers, 0.0)[0] - end[0]).abs() > 1e-3);
    }

    #[test]
    fn noise_has_the_covariance_and_the_correlation_it_was_given() {
        let (tables, mut buffers) = (tables(), FineBuffers::new());
        let mut noise: Vec<[f32; FEATURE_COUNT]> = Vec::new();
        for step in 1..4000_u64 {
            let side = if step % 2 == 0 {
                Side::Left
            } else {
                Side::Right
            };
            buffers.prepare(&tables, side, &[draw(step - 1), draw(step), draw(step + 1)]);
            for point in 0..FINE_POINTS {
                let mut features = at(&buffers, point as f32 / FINE_POINTS as f32);
                let shared = tables.tables[side.index()][0][(point + 1) * FEATURE_COUNT];
                for value in &mut features {
                    *value -= shared;
                }
                noise.push(features);
            }
        }
        let mean = |of: &dyn Fn(usize) -> f32| {
            let pairs = (0..noise.len() - 1).map(of);
            pairs.sum::<f32>() / (noise.len() - 1) as f32
        };
        let variance = mean(&|n| noise[n][0] * noise[n][0]);
        assert!((variance - 0.25).abs() < 0.01, "{variance}");
        let across = mean(&|n| noise[n][0] * noise[n][1]);
        assert!((across + 0.25).abs() < 0.01, "{across}");
        let apart = mean(&|n| noise[n][0] * noise[n][10]);
        assert!(apart.abs() < 0.005, "{apart}");
        let along = mean(&|n| noise[n][0] * noise[n + 1][0]);
        assert!((along - 0.48 * 0.25).abs() < 0.01, "{along}");
        assert!(noise.iter().all(|row| row[30].abs() < 1e-6));
    }

    #[test]
    fn a_step_without_chance_has_what_all_share() {
        let (tables, mut buffers) = (tables(), FineBuffers::new());
        buffers.prepare(&tables, Side::Left, &[FineDraw::default(); 3]);
        let middle = at(&buffers, 0.5);
        assert!(middle.iter().all(|value| (value - 1.0).abs() < 1e-3));
    }
}
