//! One linear system in f32, laid out for its inner loop.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into the dispatched functions is compiled for their instruction sets"
)]

use footfall_model::{DynamicsModel, FEATURE_COUNT, Regime};
use multiversion::multiversion;
use multiversion::target::match_target;

/// Number of lanes.
const LANES: usize = 8;
type Lanes = [f32; LANES];

/// A system, ready to run from any of its starts.
#[derive(Debug)]
pub(super) struct RunningSystem {
    order: usize,
    channels: usize,
    /// Contribution of every number of the state to the next state and, after it, to the outputs; lanes of the sum one after the other.
    columns: Vec<Lanes>,
    /// Drift, then output offset.
    offsets: Vec<Lanes>,
    /// The states in which segments begin, one after the other.
    starts: Vec<f32>,
    /// The first two frames of outputs from each start.
    begins: Vec<f32>,
    /// The same, number by number of starts that are compared side by side.
    begins_by_number: Vec<Lanes>,
    /// Room for a state, and for what follows from it: the next state, then outputs.
    state: Vec<Lanes>,
    next: Vec<Lanes>,
    /// Room for the jump of the outputs at the switch, and its change per frame.
    jump: Vec<[f32; 2]>,
}

/// The nearest few, nearest first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest<const N: usize> {
    found: [(f32, usize); N],
    len: usize,
}

impl<const N: usize> Nearest<N> {
    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn get(&self, rank: usize) -> usize {
        self.found[rank].1
    }

    fn offer(&mut self, distance: f32, start: usize) {
        let rank = self.found[..self.len].partition_point(|(nearer, _)| *nearer <= distance);
        if rank == N {
            return;
        }
        self.len = (self.len + 1).min(N);
        self.found[rank..self.len].rotate_right(1);
        self.found[rank] = (distance, start);
    }
}

/// Pads to whole lanes with zeros.
fn lanes(values: impl Iterator<Item = f64>) -> Vec<Lanes> {
    let values: Vec<f32> = values.map(|value| value as f32).collect();
    let blocks = values.chunks(LANES).map(|chunk| {
        let mut block = [0.0; LANES];
        block[..chunk.len()].copy_from_slice(chunk);
        block
    });
    blocks.collect()
}

impl RunningSystem {
    pub(super) fn new(regime: &Regime) -> Self {
        let system = &regime.system;
        let (order, channels) = (system.order(), system.channels());
        let column = |column: usize| {
            let (transition, output) = (&system.transition, &system.output);
            let values = transition.column(column);
            lanes(values.iter().chain(output.column(column).iter()).copied())
        };
        let columns: Vec<Vec<Lanes>> = (0..order).map(column).collect();
        let offsets = lanes(system.drift.iter().chain(system.offset.iter()).copied());
        let room = offsets.clone();
        let starts = regime.starts.iter().flatten();
        let mut running = Self {
            order,
            channels,
            columns: (0..offsets.len())
                .flat_map(|block| columns.iter().map(move |column| column[block]))
                .collect(),
            next: offsets.clone(),
            offsets,
            starts: starts.map(|value| *value as f32).collect(),
            begins: Vec::new(),
            begins_by_number: Vec::new(),
            state: room,
            jump: vec![[0.0; 2]; channels],
        };
        let mut begins = Vec::new();
        let mut outputs = Vec::with_capacity(2 * channels);
        for start in 0..regime.starts.len() {
            running.run(start, 2, &[], 1.0, &mut outputs);
            begins.extend_from_slice(&outputs);
        }
        let starts = begins.chunks_exact(2 * channels).collect::<Vec<_>>();
        for starts in starts.chunks(LANES) {
            for number in 0..2 * channels {
                // The padding of the last block is never near.
                let mut block = [f32::INFINITY; LANES];
                for (lane, start) in block.iter_mut().zip(starts) {
                    *lane = start[number];
                }
                running.begins_by_number.push(block);
            }
        }
        running.begins = begins;
        running
    }

    /// Returns the starts whose first outputs and their change are nearest to two expected frames; the first starts without expected frames.
    pub(super) fn nearest<const N: usize>(&self, expected: &[f32]) -> Nearest<N> {
        let mut nearest = Nearest {
            found: [(f32::INFINITY, 0); N],
            len: 0,
        };
        let numbers = 2 * self.channels;
        let starts = self.begins.len() / numbers;
        for (group, begins) in self.begins_by_number.chunks_exact(numbers).enumerate() {
            let distances = distances(begins, expected);
            let first = group * LANES;
            for (start, distance) in (first..starts).zip(distances) {
                nearest.offer(distance, start);
            }
        }
        nearest
    }

    /// The squared distance of the nearest start; infinite when none is.
    pub(super) fn least_distance(&self, expected: &[f32]) -> f32 {
        let mut least = [f32::INFINITY; LANES];
        for begins in self.begins_by_number.chunks_exact(2 * self.channels) {
            for (least, distance) in least.iter_mut().zip(distances(begins, expected)) {
                *least = least.min(distance);
            }
        }
        least.into_iter().fold(f32::INFINITY, f32::min)
    }

    /// Writes `frames` frames of output from a start into `weights`. They continue from two `expected` frames: the difference fades,
    /// critically damped with a time constant of `settle` frames.
    pub(super) fn run(
        &mut self,
        start: usize,
        frames: usize,
        expected: &[f32],
        settle: f32,
        weights: &mut Vec<f32>,
    ) {
        let (order, channels) = (self.order, self.channels);
        let state = &mut self.state.as_flattened_mut()[..order];
        state.copy_from_slice(&self.starts[start * order..][..order]);
        self.jump.fill([0.0; 2]);
        if let (Some(begins), [_, ..]) = (self.begins.get(start * 2 * channels..), expected) {
            for (channel, jump) in self.jump.iter_mut().enumerate() {
                let gap = |frame: usize| {
                    expected[frame * channels + channel] - begins[frame * channels + channel]
                };
                *jump = [gap(0), gap(1) - gap(0) + gap(0) / settle];
            }
        }
        weights.clear();
        weights.resize(frames * channels, 0.0);
        run_lanes(self, settle, weights);
    }
}

/// Returns the squared distances of a group of starts from the expected frames.
#[multiversion(targets("x86_64+avx2+fma", "aarch64+neon"))]
fn distances(begins: &[Lanes], expected: &[f32]) -> Lanes {
    let mut sums = [0.0; LANES];
    for (begin, expected) in begins.iter().zip(expected) {
        for lane in 0..LANES {
            let apart = begin[lane] - expected;
            sums[lane] += apart * apart;
        }
    }
    sums
}

/// Adds a product lane by lane, in one rounding where the machine can.
#[inline(always)]
fn add_product<const FUSED: bool>(sums: &mut Lanes, factor: f32, values: &Lanes) {
    for lane in 0..LANES {
        sums[lane] = if FUSED {
            factor.mul_add(values[lane], sums[lane])
        } else {
            sums[lane] + factor * values[lane]
        };
    }
}

/// Runs a system from its state, with its jump, for as many frames as `weights` has room for.
#[multiversion(targets("x86_64+avx2+fma", "aarch64+neon"))]
fn run_lanes(system: &mut RunningSystem, settle: f32, weights: &mut [f32]) {
    match_target! {
        "x86_64+fma" => run::<true>(system, settle, weights),
        "aarch64+neon" => run::<true>(system, settle, weights),
        _ => run::<false>(system, settle, weights),
    }
}

#[inline(always)]
fn run<const FUSED: bool>(system: &mut RunningSystem, settle: f32, weights: &mut [f32]) {
    let (order, channels) = (system.order, system.channels);
    let decay = (-1.0 / settle).exp();
    let mut remains = 1.0;
    for (frame, weights) in weights.chunks_exact_mut(channels).enumerate() {
        let state = &system.state.as_flattened()[..order];
        let columns = system.columns.chunks_exact(order);
        for ((next, offset), columns) in system.next.iter_mut().zip(&system.offsets).zip(columns) {
            // Two sums, so that one need not wait for the other.
            let (mut sums, mut others) = (*offset, [0.0; LANES]);
            let (pairs, rest) = state.as_chunks::<2>();
            let (pair_columns, last) = columns.split_at(2 * pairs.len());
            for ([one, two], column) in pairs.iter().zip(pair_columns.as_chunks::<2>().0) {
                add_product::<FUSED>(&mut sums, *one, &column[0]);
                add_product::<FUSED>(&mut others, *two, &column[1]);
            }
            for (value, column) in rest.iter().zip(last) {
                add_product::<FUSED>(&mut sums, *value, column);
            }
            for (sum, other) in sums.iter_mut().zip(others) {
                *sum += other;
            }
            *next = sums;
        }
        core::mem::swap(&mut system.state, &mut system.next);
        let outputs = &system.state.as_flattened()[order..];
        let frame = frame as f32;
        for ((weight, output), [gap, slope]) in weights.iter_mut().zip(outputs).zip(&system.jump) {
            *weight = output + remains * (gap + slope * frame);
        }
        remains *= decay;
    }
}

/// Static features of a frame, filled up to whole lanes.
pub(super) type FeatureLanes = [Lanes; FEATURE_COUNT.div_ceil(LANES)];

/// From component weights to features.
#[derive(Debug)]
pub(super) struct Pose {
    mean: FeatureLanes,
    components: Vec<FeatureLanes>,
}

impl Pose {
    /// Of a checked model.
    pub(super) fn new(model: &DynamicsModel) -> Self {
        let row = |values: &[f64]| {
            let mut row = FeatureLanes::default();
            for (narrow, value) in row.as_flattened_mut().iter_mut().zip(values) {
                *narrow = *value as f32;
            }
            row
        };
        Self {
            mean: row(&model.mean),
            components: model.components.iter().map(|values| row(values)).collect(),
        }
    }

    /// Writes the features of frames between neighbouring ones of `weights` (T × channels), from the first on.
    pub(super) fn write(&self, weights: &[f32], frames_per_row: f32, rows: &mut [FeatureLanes]) {
        write_lanes(self, weights, frames_per_row, rows);
    }
}

#[multiversion(targets("x86_64+avx2+fma", "aarch64+neon"))]
fn write_lanes(pose: &Pose, weights: &[f32], frames_per_row: f32, rows: &mut [FeatureLanes]) {
    match_target! {
        "x86_64+fma" => write::<true>(pose, weights, frames_per_row, rows),
        "aarch64+neon" => write::<true>(pose, weights, frames_per_row, rows),
        _ => write::<false>(pose, weights, frames_per_row, rows),
    }
}

#[inline(always)]
fn write<const FUSED: bool>(
    pose: &Pose,
    weights: &[f32],
    frames_per_row: f32,
    rows: &mut [FeatureLanes],
) {
    let channels = pose.components.len();
    let last = weights.len() / channels - 2;
    for (index, row) in rows.iter_mut().enumerate() {
        let time = index as f32 * frames_per_row;
        let first = (time as usize).min(last);
        let share = time - first as f32;
        let (here, next) = weights[first * channels..][..2 * channels].split_at(channels);
        let mut sums = pose.mean;
        for ((here, next), component) in here.iter().zip(next).zip(&pose.components) {
            let weight = here + share * (next - here);
            for (sums, component) in sums.iter_mut().zip(component) {
                add_product::<FUSED>(sums, weight, component);
            }
        }
        *row = sums;
    }
}
