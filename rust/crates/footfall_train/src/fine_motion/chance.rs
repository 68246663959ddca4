//! Noise with the covariance and the spectrum of what steps do not have in common.
//!
//! It is fitted to how parts of the body point, not to angles of joints: eyes see where a forearm points, whose joint angle has to make up for what the
//! shoulder and the trunk do. So rows of features become rotations of the parts in the walker's space, and directions of them become features again.

use super::MissingStep;
use super::liveliness::strengths;
use super::orientation::Orientations;
use footfall_core::Joint;
use footfall_model::{FEATURE_COUNT, FINE_REACH, FINE_TAPS, FineChance, MAX_FINE_DIRECTIONS};
use nalgebra::{DMatrix, SymmetricEigen};

/// By how much what the trunk and the head do counts for more than what arms do, in the choice of directions: arms move farther, but the eye
/// rests on the trunk and the head.
const TRUNK_WEIGHT: f64 = 3.0;

/// Lags of the correlation that the spectrum is taken from, points.
const LAGS: usize = 2 * FINE_REACH;

/// Frequencies at which the spectrum is taken.
const FREQUENCIES: usize = 128;

/// Axes with less of the energy are left out.
const LEAST_SHARE: f64 = 1e-6;

/// Steps that a walker's strength must outweigh.
const PRIOR_STEPS: f64 = 6.0;

/// Rows of consecutive points of one walk, of one walker.
pub(super) struct Run {
    pub(super) walker: usize,
    rows: Vec<f64>,
    /// All in which steps differ.
    pub(super) captured: Vec<f64>,
}

/// Fits the noise to what is left of steps without the mean of their walker. `planned` is the liveliness that steps have without it.
pub(super) fn estimate(
    steps: &[MissingStep],
    walkers: usize,
    walker_weights: &[Vec<f64>],
    components: usize,
    orientations: &Orientations,
    planned: &[f64],
) -> FineChance {
    let mut runs: Vec<Run> = Vec::new();
    let mut freed = 0.0;
    let mut counts = vec![0.0; walkers];
    for step in steps {
        if !step.follows || runs.is_empty() {
            runs.push(Run {
                walker: step.walker,
                rows: Vec::new(),
                captured: Vec::new(),
            });
        }
        if let Some(run) = runs.last_mut() {
            run.rows.extend(orientations.of_upper_body(&step.rows));
            run.captured
                .extend(orientations.of_upper_body(&step.captured));
        }
        counts[step.walker] += 1.0;
    }
    // The two means of each walker took their share of what chance did.
    for count in &counts {
        freed += if *count > 2.0 { 2.0 } else { *count };
    }
    let correction = (steps.len() as f64 / (steps.len() as f64 - freed).max(1.0)).sqrt();
    let mut kernels = Vec::new();
    let axes = principal_axes(&runs);
    for axis in &axes {
        kernels.push(kernel(&correlation(&runs, axis)));
    }
    let strengths = strengths(&runs, &axes, &kernels, planned);
    let directions = axes.iter().map(|axis| {
        let pairs = axis.iter().zip(&strengths);
        let strong: Vec<f64> = pairs
            .map(|(a, strength)| correction * strength * a)
            .collect();
        orientations.features(&strong)
    });
    let directions = directions.collect();
    FineChance {
        kernels,
        directions,
        walker_strength: walker_strength(&runs, &counts, walker_weights, components),
    }
}

/// Weight of a number of a row in the choice of directions.
fn weight(number: usize) -> f64 {
    if number < 3 * Joint::LeftShoulder.index() {
        TRUNK_WEIGHT
    } else {
        1.0
    }
}

/// The strongest axes, each as long as the deviation along it.
fn principal_axes(runs: &[Run]) -> Vec<Vec<f64>> {
    let mut covariance = DMatrix::<f64>::zeros(FEATURE_COUNT, FEATURE_COUNT);
    let mut count = 0.0;
    for row in runs
        .iter()
        .flat_map(|run| run.rows.chunks_exact(FEATURE_COUNT))
    {
        count += 1.0;
        for a in 0..FEATURE_COUNT {
            for b in 0..FEATURE_COUNT {
                covariance[(a, b)] += weight(a) * row[a] * weight(b) * row[b];
            }
        }
    }
    covariance /= f64::max(count, 1.0);
    let whole = covariance.trace();
    let eigen = SymmetricEigen::new(covariance);
    let mut order: Vec<usize> = (0..FEATURE_COUNT).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    order.truncate(MAX_FINE_DIRECTIONS);
    order.retain(|index| eigen.eigenvalues[*index] > LEAST_SHARE * whole);
    order
        .into_iter()
        .map(|index| {
            let length = eigen.eigenvalues[index].sqrt();
            let axis = eigen.eigenvectors.column(index);
            axis.iter()
                .enumerate()
                .map(|(feature, value)| length * value / weight(feature))
                .collect()
        })
        .collect()
}

/// Correlation along an axis between points that are 0, 1, 2 … apart.
fn correlation(runs: &[Run], axis: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; LAGS + 1];
    for run in runs {
        let along: Vec<f64> = run
            .rows
            .chunks_exact(FEATURE_COUNT)
            .map(|row| {
                let pairs = row.iter().zip(axis).enumerate();
                pairs.map(|(n, (a, b))| weight(n).powi(2) * a * b).sum()
            })
            .collect();
        for (lag, sum) in sums.iter_mut().enumerate() {
            let pairs = along.iter().zip(along.iter().skip(lag));
            *sum += pairs.map(|(a, b)| a * b).sum::<f64>();
        }
    }
    let whole = sums[0].max(f64::MIN_POSITIVE);
    sums.into_iter().map(|sum| sum / whole).collect()
}

/// Weights that give independent numbers this correlation: the root of its spectrum, as far as it reaches.
pub(super) fn kernel(correlation: &[f64]) -> Vec<f64> {
    let lags = correlation.len() as f64;
    let amplitudes: Vec<f64> = (0..FREQUENCIES)
        .map(|n| {
            let angle = frequency(n);
            let terms = correlation.iter().enumerate().skip(1).map(|(lag, value)| {
                // Distant lags fade out, as the window that makes the spectrum smooth.
                let fade = 0.5 + 0.5 * (core::f64::consts::PI * lag as f64 / lags).cos();
                2.0 * fade * value * (angle * lag as f64).cos()
            });
            (correlation[0] + terms.sum::<f64>()).max(0.0).sqrt()
        })
        .collect();
    let mut weights: Vec<f64> = (0..FINE_TAPS)
        .map(|tap| {
            let lag = tap as f64 - FINE_REACH as f64;
            let waves = amplitudes.iter().enumerate();
            waves
                .map(|(n, amplitude)| amplitude * (frequency(n) * lag).cos())
                .sum()
        })
        .collect();
    let length = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
    for weight in &mut weights {
        *weight /= length.max(f64::MIN_POSITIVE);
    }
    weights
}

fn frequency(index: usize) -> f64 {
    core::f64::consts::PI * (index as f64 + 0.5) / FREQUENCIES as f64
}

/// Regression of the logarithm of a walker's noise on its weights.
fn walker_strength(
    runs: &[Run],
    counts: &[f64],
    walker_weights: &[Vec<f64>],
    components: usize,
) -> Vec<f64> {
    let mut energies = vec![(0.0, 0.0); counts.len()];
    for run in runs {
        let energy = &mut energies[run.walker];
        energy.0 += run.rows.iter().map(|value| value * value).sum::<f64>();
        energy.1 += run.rows.len() as f64;
    }
    let logs: Vec<(usize, f64)> = energies
        .iter()
        .enumerate()
        .filter(|(_, (energy, points))| *energy > 0.0 && *points > 0.0)
        .map(|(walker, (energy, points))| {
            let share = counts[walker] / (counts[walker] + PRIOR_STEPS);
            (walker, share * 0.5 * (energy / points).ln())
        })
        .collect();
    let mean = logs.iter().map(|(_, log)| log).sum::<f64>() / logs.len().max(1) as f64;
    let slope = |component: usize| {
        let (mut together, mut power) = (0.0, 1e-9);
        for (walker, log) in &logs {
            let weight = walker_weights[*walker][component];
            together += weight * (log - mean);
            power += weight * weight;
        }
        together / power
    };
    (0..components).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::super::liveliness::{HIPS_FACTOR, liveliness};
    use super::*;

    /// Numbers of a second-order process that swings with a period of five points.
    fn captured(lag: usize) -> f64 {
        0.8_f64.powf(lag as f64) * (core::f64::consts::TAU * lag as f64 / 5.0).cos()
    }

    #[test]
    fn the_kernel_has_the_correlation_that_it_was_made_of() {
        let correlation: Vec<f64> = (0..=LAGS).map(captured).collect();
        let weights = kernel(&correlation);
        for lag in 0..4 {
            let pairs = weights.iter().zip(&weights[lag..]);
            let found: f64 = pairs.map(|(a, b)| a * b).sum();
            let apart = (found - captured(lag)).abs();
            assert!(apart < 0.12, "{found} at lag {lag} of {}", captured(lag));
        }
    }

    #[test]
    fn legs_point_where_they_did_and_every_joint_has_its_energy() {
        let rows: Vec<f64> = (0..600)
            .map(|index| 0.02 * (f64::from((index * 7919 + 13) % 101) / 101.0 - 0.5))
            .cycle()
            .take(60 * FEATURE_COUNT)
            .collect();
        let steps: Vec<MissingStep> = rows
            .chunks_exact(12 * FEATURE_COUNT)
            .map(|rows| MissingStep {
                walker: 0,
                side: 0,
                follows: true,
                rows: rows.to_vec(),
                captured: rows.to_vec(),
            })
            .collect();
        let mean: Vec<f64> = (0..FEATURE_COUNT)
            .map(|number| 0.4 * f64::from(number as u32).sin())
            .collect();
        let orientations = Orientations::about(&mean);
        let planned = vec![0.0; FEATURE_COUNT];
        let chance = estimate(&steps, 1, &[vec![1.0]], 1, &orientations, &planned);
        assert!(!chance.directions.is_empty());
        let second = |row: &[f64], joint: Joint| -> f64 {
            let turns = orientations.of(row);
            turns[3 * joint.index()..][..3].iter().map(|v| v * v).sum()
        };
        let generated = |joint: Joint| -> f64 {
            let pairs = chance.directions.iter().zip(&chance.kernels);
            let energies =
                pairs.map(|(direction, kernel)| second(direction, joint) * liveliness(kernel));
            energies.sum()
        };
        let rows: Vec<&[f64]> = rows.chunks_exact(FEATURE_COUNT).collect();
        let captured = |joint: Joint| -> f64 {
            let seconds = rows.windows(3).map(|three| {
                let row: Vec<f64> = (0..FEATURE_COUNT)
                    .map(|n| three[0][n] - 2.0 * three[1][n] + three[2][n])
                    .collect();
                second(&row, joint)
            });
            seconds.sum::<f64>() / (rows.len() - 2) as f64
        };
        for joint in Joint::ALL {
            // Left and right have their energy as one.
            let [generated, captured] = [
                generated(joint) + generated(joint.mirrored()),
                captured(joint) + captured(joint.mirrored()),
            ];
            if joint.is_of_leg() {
                assert!(generated < 1e-12, "{generated} of {joint:?}");
                continue;
            }
            let factor = if joint == Joint::Hips {
                HIPS_FACTOR.powi(2)
            } else {
                1.0
            };
            // Two means of the one walker took their share of five steps.
            let ratio = generated / (factor * captured * 5.0 / 3.0);
            assert!((ratio - 1.0).abs() < 0.02, "{ratio} of {joint:?}");
        }
    }
}
