//! Deviations of the sensors within each phase, by expectation maximisation over its segments (Mousas 2017, equations 8 and 9).

use crate::prepared::Prepared;
use crate::tracker::Measurement;
use footfall_model::ImuModel;
use footfall_model::imu_model::MAX_WIDTH;

/// Segments of a phase that each one is compared with.
const COMPARED: usize = 12;

/// Rounds of expectation and maximisation.
const ROUNDS: usize = 6;

/// Least deviation, in deviations of the model: simulated bodies stand stiller than people. With 0.1 a foot that rests in the middle of a step stands for good, and bodies are 0.8 cm worse.
const LEAST: f32 = 0.5;

/// Standard deviations of the sensors' numbers, phase by phase.
#[derive(Clone, Debug)]
pub(crate) struct PhaseDeviations {
    /// Rows of as many numbers as the sensors have.
    deviations: Vec<f32>,
    width: usize,
}

impl PhaseDeviations {
    /// Learns from the segments of a model: each is a left-to-right chain that explains the others of its phase.
    pub(crate) fn learn(prepared: &Prepared) -> Self {
        let model = &*prepared.model;
        let width = model.sensor_width();
        let mut deviations = Vec::with_capacity(prepared.of_phase.len() * width);
        for segments in &prepared.of_phase {
            let rows: Vec<&[f32]> = segments
                .iter()
                .map(|n| {
                    let frames = prepared.frames_of(*n as usize);
                    &model.sensor[frames.start * width..frames.end * width]
                })
                .collect();
            deviations.extend(learn_phase(&rows, &model.deviations));
        }
        Self { deviations, width }
    }

    /// Squares of the distances of all frames, in deviations of their phase. Added is what makes a Gaussian of a greater deviation flatter.
    pub(crate) fn distances(&self, prepared: &Prepared, sensor: &Measurement, out: &mut [f32]) {
        let model: &ImuModel = &prepared.model;
        out.fill(f32::INFINITY);
        for (n, segment) in model.segments.iter().enumerate() {
            let phase = usize::from(segment.phase) * self.width;
            let own = &self.deviations[phase..phase + self.width];
            let numbers = own.iter().zip(&model.deviations).zip(&sensor.weights);
            let flatter: f32 = numbers.map(|((a, b), w)| 2.0 * w * (a / b).ln()).sum();
            for frame in prepared.frames_of(n) {
                let row = &model.sensor[frame * self.width..][..self.width];
                out[frame] = flatter + square(&sensor.values, row, own, &sensor.weights);
            }
        }
        // Blocks count whole; nothing is predicted for what fills the last one up.
        out[prepared.frames..].fill(f32::MAX);
    }
}

fn square(values: &[f32], row: &[f32], deviations: &[f32], weights: &[f32]) -> f32 {
    let numbers = values.iter().zip(row).zip(deviations).zip(weights);
    numbers
        .map(|(((value, own), deviation), weight)| weight * ((value - own) / deviation).powi(2))
        .sum()
}

/// Deviations of one phase, from rows of its segments; those of the model where it has but one segment.
fn learn_phase(segments: &[&[f32]], model: &[f32]) -> Vec<f32> {
    let mut deviations = model.to_vec();
    let width = model.len();
    if segments.len() < 2 {
        return deviations;
    }
    let apart = segments.len().div_ceil(COMPARED);
    for _ in 0..ROUNDS {
        let (mut squares, mut count) = (vec![0.0_f64; width], 0.0_f64);
        for (n, observed) in segments.iter().enumerate() {
            for template in (n % apart..segments.len())
                .step_by(apart)
                .filter(|t| *t != n)
            {
                let template = segments[template];
                let shares = alignment(observed, template, &deviations);
                let frames = observed.chunks_exact(width).zip(&shares);
                for (values, shares) in frames {
                    for (row, share) in template.chunks_exact(width).zip(shares) {
                        count += share;
                        let apart = values.iter().zip(row).map(|(a, b)| f64::from(a - b));
                        for (square, apart) in squares.iter_mut().zip(apart) {
                            *square += share * apart * apart;
                        }
                    }
                }
            }
        }
        if count == 0.0 {
            break;
        }
        for ((deviation, square), model) in deviations.iter_mut().zip(&squares).zip(model) {
            *deviation = ((square / count).sqrt() as f32).max(LEAST * model);
        }
    }
    deviations
}

/// Probability of each frame of a template for each observed frame, by the forward and the backward algorithm: from the template's first frame on, each
/// is kept, followed or skipped with equal probabilities.
fn alignment(observed: &[f32], template: &[f32], deviations: &[f32]) -> Vec<Vec<f64>> {
    let width = deviations.len();
    let ones = [1.0; MAX_WIDTH];
    let rows: Vec<&[f32]> = template.chunks_exact(width).collect();
    let density = |values: &[f32]| -> Vec<f64> {
        let squares: Vec<f32> = rows
            .iter()
            .map(|row| square(values, row, deviations, &ones))
            .collect();
        let least = squares.iter().copied().fold(f32::INFINITY, f32::min);
        squares
            .iter()
            .map(|s| f64::from(-0.5 * (s - least)).exp())
            .collect()
    };
    let densities: Vec<Vec<f64>> = observed.chunks_exact(width).map(density).collect();
    let mut forward: Vec<Vec<f64>> = Vec::with_capacity(densities.len());
    for density in &densities {
        let mut row = match forward.last() {
            None => (0..rows.len())
                .map(|n| if n == 0 { 1.0 } else { 1e-6 })
                .collect(),
            Some(last) => (0..rows.len())
                .map(|n| last[n.saturating_sub(2)..=n].iter().sum::<f64>())
                .collect::<Vec<f64>>(),
        };
        for (value, density) in row.iter_mut().zip(density) {
            *value *= density;
        }
        normalise(&mut row);
        forward.push(row);
    }
    let mut later = vec![1.0; rows.len()];
    for frame in (0..densities.len()).rev() {
        let shares = &mut forward[frame];
        for (share, later) in shares.iter_mut().zip(&later) {
            *share *= later;
        }
        normalise(shares);
        for (later, density) in later.iter_mut().zip(&densities[frame]) {
            *later *= density;
        }
        later = (0..rows.len())
            .map(|n| later[n..(n + 3).min(rows.len())].iter().sum())
            .collect();
        normalise(&mut later);
    }
    forward
}

fn normalise(values: &mut [f64]) {
    let sum: f64 = values.iter().sum();
    for value in values {
        *value /= sum.max(f64::MIN_POSITIVE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    /// Segments that differ from one course by uniform noise of known deviations.
    fn noisy(count: usize, deviations: &[f32]) -> Vec<Vec<f32>> {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut segment = |frames: usize| -> Vec<f32> {
            (0..frames * deviations.len())
                .map(|n| {
                    let (frame, number) = (n / deviations.len(), n % deviations.len());
                    let noise: f32 = random.random_range(-1.0..1.0) * 3.0_f32.sqrt();
                    30.0 * frame as f32 + deviations[number] * noise
                })
                .collect()
        };
        (0..count).map(|_| segment(6)).collect()
    }

    #[test]
    fn deviations_are_those_between_two_segments() {
        let known = [0.5, 2.0, 1.0];
        let segments = noisy(60, &known);
        let rows: Vec<&[f32]> = segments.iter().map(Vec::as_slice).collect();
        let learned = learn_phase(&rows, &[1.0; 3]);
        for (learned, known) in learned.iter().zip(known) {
            let between = known * 2.0_f32.sqrt();
            assert!(
                (learned / between - 1.0).abs() < 0.1,
                "{learned} is not {between}"
            );
        }
    }

    #[test]
    fn a_slower_segment_is_aligned_frame_by_frame() {
        let template = [0.0, 10.0, 20.0];
        let observed = [0.1, 0.2, 9.8, 10.1, 20.2];
        let shares = alignment(&observed, &template, &[1.0]);
        for (shares, frame) in shares.iter().zip([0, 0, 1, 1, 2]) {
            assert!(shares[frame] > 0.99, "{shares:?} is not at {frame}");
        }
    }

    #[test]
    fn one_segment_keeps_the_deviations_of_the_model() {
        assert_eq!(learn_phase(&[&[1.0, 2.0]], &[0.3, 0.4]), [0.3, 0.4]);
    }
}
