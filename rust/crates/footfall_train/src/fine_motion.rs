//! Detail of captured steps beyond the trajectories of their states.
//!
//! Every captured walk is generated again from what a model can hold of it: the means that its own steps have in their states, durations
//! as a generated step has them, and the walk's own variance. What is missing is sorted by the step's phase: a mean over all walkers, what
//! goes with the components in which walkers differ, and noise.

mod chance;
mod edges;
mod liveliness;
mod orientation;

use crate::error::TrainError;
use crate::sequence::Sequence;
use footfall_core::ease::{catmull_rom, smooth_step};
use footfall_imu::filter::low_pass;
use footfall_model::{
    FEATURE_COUNT, FINE_POINTS, FineMotion, FineTable, GaitModel, OBSERVATION_COUNT,
    STATES_PER_STEP, StepModel, StepOffset,
};
use footfall_prob::global_variance::{GlobalVarianceTarget, global_variance, hts_weight};
use footfall_prob::mlpg::MlpgProblem;
use glam::Vec3;
use liveliness::planned_liveliness;
use orientation::Orientations;
use rayon::prelude::*;

pub(crate) use edges::restore as restore_edges;

/// Upper limit of fine motion, hertz: above it is marker noise. A filter's edge is soft, and the band that counts ends at 6 Hz.
const CUT_OFF_HZ: f64 = 10.0;

/// Steps that a walker's mean must outweigh: with few steps it is drawn towards the mean of all.
const WALKER_PRIOR_STEPS: f64 = 3.0;

/// Points of a step as rows of [`FEATURE_COUNT`].
type StepRows = Vec<f64>;

/// One step's missing motion.
pub(crate) struct MissingStep {
    walker: usize,
    /// 0 left, 1 right.
    side: usize,
    /// True when the step before it is the one before in the list.
    follows: bool,
    rows: StepRows,
    /// The step itself at the same points.
    captured: StepRows,
}

/// Estimates the fine motion of a corpus; `None` when no walk has a step that others surround.
///
/// # Errors
/// [`TrainError::Inference`] when a walk cannot be generated.
pub(crate) fn estimate(
    model: &GaitModel,
    corpus: &[Sequence],
    boundaries: &[Vec<usize>],
    walker_weights: &[Vec<f64>],
) -> Result<Option<FineMotion>, TrainError> {
    let found: Vec<Vec<MissingStep>> = corpus
        .par_iter()
        .zip(boundaries)
        .map(|(sequence, boundaries)| missing(model, sequence, boundaries))
        .collect::<Result<_, _>>()?;
    let mut steps: Vec<MissingStep> = found.into_iter().flatten().collect();
    if steps.is_empty() {
        return Ok(None);
    }
    let walkers = steps.iter().map(|step| step.walker + 1).max().unwrap_or(0);
    let mut means: Vec<Option<FineTable>> = (0..walkers)
        .map(|walker| walker_mean(&steps, walker, |step| &step.rows))
        .collect();
    let shared = mean_of(means.iter().flatten());
    for step in &mut steps {
        if let Some(mean) = &means[step.walker] {
            subtract(&mut step.rows, &mean[step.side]);
        }
    }
    let own: Vec<Option<FineTable>> = (0..walkers)
        .map(|walker| walker_mean(&steps, walker, |step| &step.captured))
        .collect();
    for step in &mut steps {
        if let Some(mean) = &own[step.walker] {
            subtract(&mut step.captured, &mean[step.side]);
        }
    }
    for (walker, mean) in means.iter_mut().enumerate() {
        let Some(mean) = mean else { continue };
        for (side, table) in mean.iter_mut().enumerate() {
            subtract(table, &shared[side]);
            let of = |step: &&MissingStep| step.walker == walker && step.side == side;
            let count = steps.iter().filter(of).count() as f64;
            for value in table {
                *value *= count / (count + WALKER_PRIOR_STEPS);
            }
        }
    }
    let components = model.variation.walker.len();
    let orientations = Orientations::about(&model.mean_features());
    let planned = planned_liveliness(model, &orientations);
    let chance = chance::estimate(
        &steps,
        walkers,
        walker_weights,
        components,
        &orientations,
        &planned,
    );
    Ok(Some(FineMotion {
        shared,
        walker: along_components(&means, walker_weights, components),
        chance,
        scale: vec![1.0; FEATURE_COUNT],
    }))
}

/// Detail of a walk beyond the trajectory generated from the means of its states; without its first and last step, at which filters end.
fn missing(
    model: &GaitModel,
    sequence: &Sequence,
    boundaries: &[usize],
) -> Result<Vec<MissingStep>, TrainError> {
    let generated = regenerate(model, sequence, boundaries)?;
    let captured: Vec<f64> = sequence
        .observations
        .chunks_exact(OBSERVATION_COUNT)
        .flat_map(|observation| &observation[..FEATURE_COUNT])
        .copied()
        .collect();
    let [captured, made] = [captured, generated].map(|rows| low_passed(&rows, model.frame_rate_hz));
    let inner = 1..sequence.steps.len().saturating_sub(1).max(1);
    let steps = sequence.steps[inner].iter().enumerate();
    Ok(steps
        .map(|(index, step)| {
            let [captured, made] =
                [&captured, &made].map(|rows| at_points(rows, step.first, step.end));
            MissingStep {
                walker: sequence.walker,
                side: step.side.index(),
                follows: index > 0,
                rows: captured.iter().zip(&made).map(|(a, b)| a - b).collect(),
                captured,
            }
        })
        .collect())
}

/// Features of frames in a row without what is faster than [`CUT_OFF_HZ`].
fn low_passed(rows: &[f64], frame_rate_hz: f64) -> Vec<f64> {
    let mut slow = vec![0.0; rows.len()];
    for joint in (0..FEATURE_COUNT).step_by(3) {
        let of = |row: &[f64]| Vec3::from([0, 1, 2].map(|axis| row[joint + axis] as f32));
        let values: Vec<Vec3> = rows.chunks_exact(FEATURE_COUNT).map(of).collect();
        let values = low_pass(&values, frame_rate_hz, CUT_OFF_HZ);
        for (row, value) in slow.chunks_exact_mut(FEATURE_COUNT).zip(values) {
            row[joint..joint + 3].copy_from_slice(&value.as_dvec3().to_array());
        }
    }
    slow
}

/// The walk as a generator makes it of the means in its states, with its own variance.
fn regenerate(
    model: &GaitModel,
    sequence: &Sequence,
    boundaries: &[usize],
) -> Result<Vec<f64>, TrainError> {
    let segments = sequence.steps.len() * STATES_PER_STEP;
    let mut means = vec![0.0; segments * OBSERVATION_COUNT];
    let mut precisions = Vec::with_capacity(segments * OBSERVATION_COUNT);
    let mut state_of_frame = Vec::with_capacity(sequence.frames());
    for (number, labels) in sequence.steps.iter().enumerate() {
        let step = model.step(labels.side);
        let lengths = durations(step, labels.end - labels.first);
        for (state, frames) in lengths.into_iter().enumerate() {
            let segment = number * STATES_PER_STEP + state;
            let (first, end) = (boundaries[segment], boundaries[segment + 1]);
            let mean = &mut means[segment * OBSERVATION_COUNT..][..OBSERVATION_COUNT];
            let seen = &sequence.observations[first * OBSERVATION_COUNT..end * OBSERVATION_COUNT];
            for row in seen.chunks_exact(OBSERVATION_COUNT) {
                for (mean, value) in mean.iter_mut().zip(row) {
                    *mean += value / (end - first) as f64;
                }
            }
            let variances = step.states[state].variance.iter();
            precisions.extend(variances.map(|variance| variance.recip()));
            state_of_frame.extend(core::iter::repeat_n(segment as u32, frames));
        }
    }
    let frames = state_of_frame.len();
    let mut trajectory = vec![0.0; frames * FEATURE_COUNT];
    let problem = MlpgProblem {
        windows: model.windows,
        dim: FEATURE_COUNT,
        means: &means,
        precisions: &precisions,
        state_of_frame: &state_of_frame,
        n_fixed: 0,
        pull: None,
    };
    let variance = sequence.variance();
    let target = GlobalVarianceTarget {
        mean: &variance.iter().map(|v| v.max(1e-9)).collect::<Vec<f64>>(),
        variance: &model.global_variance.variance,
        trajectory_weight: hts_weight(frames),
    };
    global_variance(&problem, &target, &mut trajectory)?;
    Ok(trajectory)
}

/// Durations of the states of a generated step of this length: they share its tempo.
fn durations(step: &StepModel, frames: usize) -> [usize; STATES_PER_STEP] {
    let tempo = frames as f64 / step.mean_frames();
    let mut lengths = [0; STATES_PER_STEP];
    let (mut elapsed, mut passed) = (0.0, 0);
    for (state, length) in lengths.iter_mut().enumerate() {
        elapsed += tempo * step.states[state].duration_mean;
        let left = STATES_PER_STEP - 1 - state;
        let end = (elapsed.round() as usize).clamp(passed + 1, (frames - left).max(passed + 1));
        *length = end - passed;
        passed = end;
    }
    lengths
}

/// Rows at the points of a stride, a left step and a right one, of what a component of variation adds to it.
fn component_at_points(model: &GaitModel, component: &[StepOffset; 2]) -> StepRows {
    let mut rows = Vec::with_capacity(2 * FINE_POINTS * FEATURE_COUNT);
    // Times of the middles of states over the stride, in steps, and what they add.
    let mut knots: Vec<(f64, &[f64])> = Vec::with_capacity(2 * STATES_PER_STEP);
    for (side, offset) in component.iter().enumerate() {
        let step = &model.steps[side];
        let mut elapsed = 0.0;
        for (state, parameters) in step.states.iter().enumerate() {
            let middle = (elapsed + 0.5 * parameters.duration_mean) / step.mean_frames();
            elapsed += parameters.duration_mean;
            let means = &offset.means[state * OBSERVATION_COUNT..][..FEATURE_COUNT];
            knots.push((side as f64 + middle, means));
        }
    }
    for point in 0..2 * FINE_POINTS {
        let at = point as f64 / FINE_POINTS as f64;
        let next = knots.iter().position(|(time, _)| *time > at).unwrap_or(0);
        let before = (next + knots.len() - 1) % knots.len();
        let apart = (knots[next].0 - knots[before].0).rem_euclid(2.0);
        let share = (at - knots[before].0).rem_euclid(2.0) / apart;
        let smooth = f64::from(smooth_step(share as f32));
        let pairs = knots[before].1.iter().zip(knots[next].1);
        rows.extend(pairs.map(|(from, to)| from + smooth * (to - from)));
    }
    rows
}

/// Rows at the points of a step between two frames.
fn at_points(rows: &[f64], first: usize, end: usize) -> StepRows {
    let last = rows.len() / FEATURE_COUNT - 1;
    let mut points = vec![0.0; FINE_POINTS * FEATURE_COUNT];
    for (point, row) in points.chunks_exact_mut(FEATURE_COUNT).enumerate() {
        let at = first as f64 + (end - first) as f64 * point as f64 / FINE_POINTS as f64;
        let frame = at.floor() as usize;
        for (offset, weight) in catmull_rom(at.fract() as f32).into_iter().enumerate() {
            let from = (frame + offset).saturating_sub(1).min(last) * FEATURE_COUNT;
            for (value, neighbour) in row.iter_mut().zip(&rows[from..]) {
                *value += f64::from(weight) * neighbour;
            }
        }
    }
    points
}

/// The mean of a walker's steps on each side; `None` unless both were seen.
fn walker_mean(
    steps: &[MissingStep],
    walker: usize,
    rows: impl Fn(&MissingStep) -> &StepRows,
) -> Option<FineTable> {
    let mut table = [(); 2].map(|()| vec![0.0; FINE_POINTS * FEATURE_COUNT]);
    let mut counts = [0.0; 2];
    for step in steps.iter().filter(|step| step.walker == walker) {
        counts[step.side] += 1.0;
        for (sum, value) in table[step.side].iter_mut().zip(rows(step)) {
            *sum += value;
        }
    }
    for (side, count) in table.iter_mut().zip(counts) {
        for sum in side {
            *sum /= count;
        }
    }
    counts.iter().all(|count| *count > 0.0).then_some(table)
}

fn mean_of<'a>(tables: impl Iterator<Item = &'a FineTable> + Clone) -> FineTable {
    let count = tables.clone().count().max(1) as f64;
    let mut mean = [(); 2].map(|()| vec![0.0; FINE_POINTS * FEATURE_COUNT]);
    for table in tables {
        for (mean, side) in mean.iter_mut().zip(table) {
            for (mean, value) in mean.iter_mut().zip(side) {
                *mean += value / count;
            }
        }
    }
    mean
}

/// Regression of walkers' tables on their weights. Components stand for all that walkers differ by: they get all of its energy.
fn along_components(
    means: &[Option<FineTable>],
    weights: &[Vec<f64>],
    components: usize,
) -> Vec<FineTable> {
    let known: Vec<(&FineTable, &Vec<f64>)> = means
        .iter()
        .zip(weights)
        .filter_map(|(mean, weights)| mean.as_ref().map(|mean| (mean, weights)))
        .collect();
    let mut tables: Vec<FineTable> = (0..components)
        .map(|component| {
            let mut table = [(); 2].map(|()| vec![0.0; FINE_POINTS * FEATURE_COUNT]);
            let power: f64 = known.iter().map(|(_, w)| w[component].powi(2)).sum();
            for (mean, weights) in &known {
                let share = weights[component] / power.max(1e-9);
                for (table, side) in table.iter_mut().zip(*mean) {
                    for (sum, value) in table.iter_mut().zip(side) {
                        *sum += share * value;
                    }
                }
            }
            table
        })
        .collect();
    let energy = |table: &FineTable| table.iter().flatten().map(|v| v * v).sum::<f64>();
    let count = known.len().max(1) as f64;
    let all = known.iter().map(|(mean, _)| energy(mean)).sum::<f64>() / count;
    let kept: f64 = tables.iter().map(energy).sum();
    let scale = if kept > 0.0 { (all / kept).sqrt() } else { 1.0 };
    for value in tables.iter_mut().flatten().flatten() {
        *value *= scale;
    }
    tables
}

fn subtract(values: &mut [f64], others: &[f64]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value -= other;
    }
}
