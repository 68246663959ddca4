//! Differences of steps from the mean step: with speed, between walkers, and from step to step.

use crate::arm_swing;
use crate::averages::upper_median;
use crate::sequence::Sequence;
use footfall_core::Side;
use footfall_model::{
    OBSERVATION_COUNT, STATES_PER_STEP, SpeedResponse, StepModel, StepOffset, Variation,
};
use nalgebra::{DMatrix, SymmetricEigen};

/// Components of a walker and of a step that a model holds at most. With six of a walker, generated people are recognised by lying in
/// the plane of the few (by shape 0.85 of the time, with twelve 0.81); sixteen change nothing more.
const WALKER_COMPONENTS: usize = 12;
const STEP_COMPONENTS: usize = 6;

/// Steps that a walker's mean must outweigh: with few steps it is drawn towards the corpus mean.
const WALKER_PRIOR_STEPS: f64 = 3.0;

/// Least spread of speeds (variance in (m/s)² times steps) below which speed explains nothing.
const SPEED_PRIOR: f64 = 0.05;

/// Logarithm of the ratio of durations beyond which a step among others of its walk is no whole step.
const MAX_TEMPO: f64 = 0.35;

/// Difference of one step of the corpus from the mean step.
struct Difference {
    walker: usize,
    sequence: usize,
    side: Side,
    speed_mps: f64,
    row: Vec<f64>,
}

impl Difference {
    /// Logarithm of the step's duration over the mean step's.
    fn tempo(&self) -> f64 {
        let [_, durations, _] = StepOffset::parts();
        self.row[durations.start]
    }
}

/// Differences between steps.
pub struct Differences {
    /// With speed.
    pub speed: SpeedResponse,
    /// Between walkers and from step to step.
    pub variation: Variation,
    /// The weight of every walker in each component of the variation between walkers.
    pub walker_weights: Vec<Vec<f64>>,
}

/// Estimates the response to speed and the variation that remains; the boundaries between each sequence's states are those of
/// [`AverageWalk::align`](crate::average::AverageWalk::align).
pub fn estimate(
    steps: &[StepModel; 2],
    corpus: &[Sequence],
    boundaries: &[Vec<usize>],
    frame_rate_hz: f64,
) -> Differences {
    let mut differences = Vec::new();
    for (index, (sequence, boundaries)) in corpus.iter().zip(boundaries).enumerate() {
        let mut own = sequence_differences(boundaries, steps, sequence, index);
        keep_whole_steps(&mut own);
        differences.append(&mut own);
    }
    let mut speed = speed_response(&mut differences, corpus, frame_rate_hz);
    arm_swing::keep_shape(&mut speed.slopes, steps);
    let (walker, walker_weights) = walker_components(&mut differences);
    let (step, step_correlation) = step_components(&differences);
    let variation = Variation {
        walker,
        step,
        step_correlation,
    };
    Differences {
        speed,
        variation,
        walker_weights,
    }
}

fn sequence_differences(
    boundaries: &[usize],
    steps: &[StepModel; 2],
    sequence: &Sequence,
    index: usize,
) -> Vec<Difference> {
    let differences = sequence.steps.iter().enumerate().map(|(number, labels)| {
        let model = &steps[labels.side.index()];
        let mut offset = StepOffset::zero();
        for (state, parameters) in model.states.iter().enumerate() {
            let segment = number * STATES_PER_STEP + state;
            let (first, end) = (boundaries[segment], boundaries[segment + 1]);
            let frames = (end - first) as f64;
            let block = state * OBSERVATION_COUNT..(state + 1) * OBSERVATION_COUNT;
            let means = &mut offset.means[block];
            for frame in first..end {
                let row = &sequence.observations[frame * OBSERVATION_COUNT..];
                for ((mean, value), centre) in means.iter_mut().zip(row).zip(&parameters.mean) {
                    *mean += (value - centre) / frames;
                }
            }
        }
        // Where within a step one state ends and the next begins is uncertain by more than it differs; how long the
        // whole step lasts is not. So the states share the step's tempo.
        let mean_frames: f64 = model.states.iter().map(|state| state.duration_mean).sum();
        let tempo = ((labels.end - labels.first) as f64 / mean_frames).ln();
        offset.log_durations.fill(tempo);
        offset.other_terminal = labels
            .other_terminal
            .map_or(0.0, |fraction| fraction - model.other_terminal);
        Difference {
            walker: sequence.walker,
            sequence: index,
            side: labels.side,
            speed_mps: labels.speed_mps,
            row: offset.to_row(),
        }
    });
    differences.collect()
}

/// Leaves out steps of another length than the walk's others: half a step, or two, that the contacts were taken for. One of them would teach
/// more variation than a hundred good ones.
fn keep_whole_steps(walk: &mut Vec<Difference>) {
    if let Some(median) = upper_median(walk.iter().map(Difference::tempo)) {
        walk.retain(|step| (step.tempo() - median).abs() < MAX_TEMPO);
    }
}

/// Regresses the differences on speed and leaves the residuals behind.
fn speed_response(
    differences: &mut [Difference],
    corpus: &[Sequence],
    frame_rate_hz: f64,
) -> SpeedResponse {
    let count = differences.len().max(1) as f64;
    let reference_mps = differences.iter().map(|d| d.speed_mps).sum::<f64>() / count;
    let slopes = Side::BOTH.map(|side| {
        let mut slope = vec![0.0; StepOffset::LEN];
        let mut spread = SPEED_PRIOR;
        for difference in differences.iter().filter(|d| d.side == side) {
            let deviation = difference.speed_mps - reference_mps;
            spread += deviation * deviation;
            for (slope, value) in slope.iter_mut().zip(&difference.row) {
                *slope += deviation * value;
            }
        }
        for slope in &mut slope {
            *slope /= spread;
        }
        slope
    });
    for difference in differences.iter_mut() {
        let deviation = difference.speed_mps - reference_mps;
        let slope = &slopes[difference.side.index()];
        for (value, slope) in difference.row.iter_mut().zip(slope) {
            *value -= deviation * slope;
        }
    }
    let speeds = range(corpus.iter().map(Sequence::speed_mps));
    let cadences =
        range(corpus.iter().map(|sequence| {
            sequence.steps.len() as f64 * frame_rate_hz / sequence.frames() as f64
        }));
    SpeedResponse {
        reference_mps,
        min_mps: speeds[0],
        max_mps: speeds[1],
        cadence_range_hz: cadences,
        slopes: slopes.map(|slope| offset_from(&slope)),
    }
}

/// Principal components of the walkers' mean steps, and every walker's weights in them; subtracts each walker's mean from its steps.
fn walker_components(differences: &mut [Difference]) -> (Vec<[StepOffset; 2]>, Vec<Vec<f64>>) {
    let walkers = differences.iter().map(|d| d.walker + 1).max().unwrap_or(0);
    let mut rows = vec![vec![0.0; 2 * StepOffset::LEN]; walkers];
    let mut counts = vec![[WALKER_PRIOR_STEPS; 2]; walkers];
    for difference in differences.iter() {
        let block = difference.side.index() * StepOffset::LEN;
        counts[difference.walker][difference.side.index()] += 1.0;
        let row = &mut rows[difference.walker][block..block + StepOffset::LEN];
        for (sum, value) in row.iter_mut().zip(&difference.row) {
            *sum += value;
        }
    }
    for (row, counts) in rows.iter_mut().zip(&counts) {
        for (half, count) in row.chunks_exact_mut(StepOffset::LEN).zip(counts) {
            for sum in half {
                *sum /= count;
            }
        }
    }
    for difference in differences.iter_mut() {
        let block = difference.side.index() * StepOffset::LEN;
        for (value, mean) in difference
            .row
            .iter_mut()
            .zip(&rows[difference.walker][block..])
        {
            *value -= mean;
        }
    }
    let components = principal_components(&rows, WALKER_COMPONENTS);
    let weights = |row: &Vec<f64>| -> Vec<f64> {
        let each = components.iter();
        each.map(|component| dot(row, component) / dot(component, component))
            .collect()
    };
    let weights = rows.iter().map(weights).collect();
    let offsets = components.iter().map(|component| {
        let (left, right) = component.split_at(StepOffset::LEN);
        [offset_from(left), offset_from(right)]
    });
    (offsets.collect(), weights)
}

/// Principal components of what is left of each stride, a left step and the right one after it, and their correlation between consecutive
/// strides.
fn step_components(differences: &[Difference]) -> (Vec<[StepOffset; 2]>, f64) {
    let strides: Vec<(usize, Vec<f64>)> = differences
        .windows(2)
        .filter(|pair| {
            [pair[0].side, pair[1].side] == Side::BOTH && pair[0].sequence == pair[1].sequence
        })
        .map(|pair| (pair[0].sequence, [&pair[0].row[..], &pair[1].row].concat()))
        .collect();
    let rows = within_walks(&strides);
    let mut components = principal_components(&rows, STEP_COMPONENTS);
    let correlation = consecutive_correlation(&strides, &components);
    for begin in [0, StepOffset::LEN] {
        for part in StepOffset::parts() {
            let part = begin + part.start..begin + part.end;
            let energy = |row: &[f64]| dot(&row[part.clone()], &row[part.clone()]);
            let scale = lost_spread(&rows, &components, energy);
            for component in &mut components {
                component[part.clone()]
                    .iter_mut()
                    .for_each(|value| *value *= scale);
            }
        }
    }
    let components = components
        .into_iter()
        .map(|component| {
            let (left, right) = component.split_at(StepOffset::LEN);
            [offset_from(left), offset_from(right)]
        })
        .collect();
    (components, correlation)
}

/// Strides without the mean of their walk, and scaled for what the mean took from their spread. One clip's mean differs from its walker's,
/// but stays the same from step to step.
fn within_walks(strides: &[(usize, Vec<f64>)]) -> Vec<Vec<f64>> {
    let mut rows = Vec::with_capacity(strides.len());
    for walk in strides.chunk_by(|one, next| one.0 == next.0) {
        let count = walk.len() as f64;
        if walk.len() < 2 {
            continue;
        }
        let mut mean = vec![0.0; 2 * StepOffset::LEN];
        for (_, row) in walk {
            for (mean, value) in mean.iter_mut().zip(row) {
                *mean += value / count;
            }
        }
        let scale = (count / (count - 1.0)).sqrt();
        rows.extend(walk.iter().map(|(_, row)| -> Vec<f64> {
            let pairs = row.iter().zip(&mean);
            pairs.map(|(value, mean)| scale * (value - mean)).collect()
        }));
    }
    rows
}

/// The factor on components that gives them the spread of all that the rows vary by: the few that are kept stand for the many
/// that are not, or generated steps would be more alike than people's. `energy` is that of the part that is scaled.
fn lost_spread(rows: &[Vec<f64>], components: &[Vec<f64>], energy: impl Fn(&[f64]) -> f64) -> f64 {
    let total = rows.iter().map(|row| energy(row)).sum::<f64>() / rows.len().max(1) as f64;
    let kept: f64 = components.iter().map(|row| energy(row)).sum();
    if kept > 0.0 {
        (total / kept).sqrt()
    } else {
        1.0
    }
}

/// Correlation of consecutive strides along the components, in [0, 0.95].
fn consecutive_correlation(strides: &[(usize, Vec<f64>)], components: &[Vec<f64>]) -> f64 {
    let (mut together, mut apart) = (0.0, 1e-12);
    for pair in strides.windows(2) {
        let [(sequence, first), (next_sequence, next)] = [&pair[0], &pair[1]];
        if sequence != next_sequence {
            continue;
        }
        for component in components {
            let weight = |row: &[f64]| dot(row, component) / dot(component, component).max(1e-12);
            let (a, b) = (weight(first), weight(next));
            together += a * b;
            apart += 0.5 * (a * a + b * b);
        }
    }
    (together / apart).clamp(0.0, 0.95)
}

/// The strongest principal components of rows, each scaled to its standard deviation; the mean counts as zero.
fn principal_components(rows: &[Vec<f64>], most: usize) -> Vec<Vec<f64>> {
    let count = rows.len();
    if count < 2 {
        return Vec::new();
    }
    // There are fewer rows than columns: the small Gram matrix has the same spectrum as the covariance.
    let gram = DMatrix::from_fn(count, count, |a, b| dot(&rows[a], &rows[b]) / count as f64);
    let eigen = SymmetricEigen::new(gram);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let largest = eigen.eigenvalues[order[0]];
    order
        .into_iter()
        .take(most)
        .filter(|index| eigen.eigenvalues[*index] > 1e-6 * largest.max(1e-12))
        .map(|index| {
            let weights = eigen.eigenvectors.column(index);
            let mut component = vec![0.0; rows[0].len()];
            for (row, weight) in rows.iter().zip(weights.iter()) {
                for (value, addend) in component.iter_mut().zip(row) {
                    *value += weight * addend / (count as f64).sqrt();
                }
            }
            component
        })
        .collect()
}

fn offset_from(row: &[f64]) -> StepOffset {
    StepOffset::from_row(row).unwrap_or_else(StepOffset::zero)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_have_the_spread_of_the_data() {
        // Rows along one direction with standard deviation 3, and a little along another.
        let rows: Vec<Vec<f64>> = (0..40)
            .map(|i| {
                let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                let other = if i % 4 < 2 { 0.1 } else { -0.1 };
                vec![3.0 * sign, 0.0, other, 0.0]
            })
            .collect();
        let components = principal_components(&rows, 3);
        assert_eq!(components.len(), 2);
        assert!((components[0][0].abs() - 3.0).abs() < 1e-9);
        assert!((components[1][2].abs() - 0.1).abs() < 1e-9);
        let energy = |row: &[f64]| dot(row, row);
        assert!((lost_spread(&rows, &components, energy) - 1.0).abs() < 1e-9);
        let alone = lost_spread(&rows, &components[..1], energy);
        assert!((alone - (9.01_f64 / 9.0).sqrt()).abs() < 1e-9);
    }
}
