//! Liveliness of joints: the energy of second differences between points, in which what is quick counts.

use super::chance::Run;
use super::component_at_points;
use super::orientation::Orientations;
use footfall_core::Joint;
use footfall_model::{FEATURE_COUNT, GaitModel};

/// Factor on what the hips lack. Without it the energy of the third differences of generated pelvises is a quarter below that of CMU's neutral walkers, and 0.74 of
/// their detail repeats from stride to stride, where it is 0.67 in people: the mean of walkers whose edges differ is duller than each.
pub(super) const HIPS_FACTOR: f64 = 1.35;

/// Factors by which the axes together make each joint as lively as captured ones are, beyond what its trajectories do: by the energy of second differences between
/// points, for the slow motion of a joint is in its steps' means, and an axis has one spectrum for all joints that it moves.
pub(super) fn strengths(
    runs: &[Run],
    axes: &[Vec<f64>],
    kernels: &[Vec<f64>],
    planned: &[f64],
) -> Vec<f64> {
    let lively: Vec<f64> = kernels.iter().map(|kernel| liveliness(kernel)).collect();
    let missing = |number: usize| typical_liveliness(runs, number) - planned[number];
    (0..FEATURE_COUNT)
        .map(|number| {
            // Left and right as one: which arm is more lively is chance.
            let mirrored = 3 * Joint::ALL[number / 3].mirrored().index() + number % 3;
            let missing = 0.5 * (missing(number) + missing(mirrored)).max(0.0);
            let pairs = axes.iter().zip(&lively);
            let energy = |number: usize| -> f64 {
                pairs
                    .clone()
                    .map(|(axis, lively)| lively * axis[number].powi(2))
                    .sum()
            };
            let kept = 0.5 * (energy(number) + energy(mirrored));
            let factor = if number / 3 == Joint::Hips.index() {
                HIPS_FACTOR
            } else {
                1.0
            };
            if kept > 0.0 {
                factor * (missing / kept).sqrt()
            } else {
                0.0
            }
        })
        .collect()
}

/// Energy of a joint's second differences in a typical walker's steps: the geometric mean, for a few are far more restless than the others.
fn typical_liveliness(runs: &[Run], number: usize) -> f64 {
    let walkers = runs.iter().map(|run| run.walker + 1).max().unwrap_or(0);
    let mut energies = vec![(0.0, 0.0); walkers];
    for run in runs {
        let rows: Vec<&[f64]> = run.captured.chunks_exact(FEATURE_COUNT).collect();
        for three in rows.windows(3) {
            let second = |n: usize| three[0][n] - 2.0 * three[1][n] + three[2][n];
            let (energy, count) = &mut energies[run.walker];
            *energy += second(number).powi(2);
            *count += 1.0;
        }
    }
    let (mut logs, mut weights) = (0.0, 0.0);
    for (energy, count) in energies.into_iter().filter(|(energy, _)| *energy > 0.0) {
        let weight = f64::sqrt(count);
        logs += weight * f64::ln(energy / count);
        weights += weight;
    }
    if weights > 0.0 {
        f64::exp(logs / weights)
    } else {
        0.0
    }
}

/// Energy of the second differences of what steps are planned to differ by.
pub(super) fn planned_liveliness(model: &GaitModel, orientations: &Orientations) -> Vec<f64> {
    let mut energies = vec![0.0; FEATURE_COUNT];
    for component in &model.variation.step {
        let rows = orientations.of_upper_body(&component_at_points(model, component));
        let rows: Vec<&[f64]> = rows.chunks_exact(FEATURE_COUNT).collect();
        for (number, energy) in energies.iter_mut().enumerate() {
            let seconds = rows
                .windows(3)
                .map(|three| three[0][number] - 2.0 * three[1][number] + three[2][number]);
            *energy += seconds.map(|second| second * second).sum::<f64>() / (rows.len() - 2) as f64;
        }
    }
    energies
}

/// Energy of the second differences of noise with these weights, for noise of energy 1.
pub(super) fn liveliness(kernel: &[f64]) -> f64 {
    let padded: Vec<f64> = [0.0; 2]
        .into_iter()
        .chain(kernel.iter().copied())
        .chain([0.0; 2])
        .collect();
    padded
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2))
        .sum()
}
